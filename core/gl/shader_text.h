#pragma once

#include <map>
#include <string>

#include "core/base/error.h"

namespace slabcast {

/// Every file of gles_shaders/, by name; built into the library.
const std::map<std::string, std::string>& shaderTexts();

/// One whole shader: version line, the defines, then `file` with its `#include "name"` lines
/// replaced by those files' texts (each at most once) and `#line` directives that keep the driver's
/// messages readable: the source string number is the file's index in shaderTexts(). Fails:
/// ShaderCompile (an include that does not exist). Tested by: shader_validator_test.cpp
Result<std::string> expandShader(const std::string& file,
                                 const std::map<std::string, std::string>& defines);

} // namespace slabcast
