#pragma once

#include <map>
#include <string>

namespace slabcast {

/// Every file of assets/transfer_functions/, by preset name; built into the library.
const std::map<std::string, std::string>& presetTexts();

} // namespace slabcast
