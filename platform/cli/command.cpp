#include "platform/cli/command.h"

#include <algorithm>

#include "platform/cli/option_kinds.h"

namespace slabcast {

const Option* findOption(const Command& command, std::string_view flag) {
    const auto found = std::find_if(command.options.begin(), command.options.end(),
                                    [=](const Option& option) { return option.flag == flag; });
    return found == command.options.end() ? nullptr : &*found;
}

Option& addText(Command& command, Option option, std::string& value) {
    const auto parse = [](const std::string& word) {
        return word.empty() ? std::nullopt : std::optional(word);
    };
    return addParsed(command, std::move(option), value, parse, "a word: give one, or leave it out");
}

Option& addFlag(Command& command, Option option, bool& value) {
    option.take = [&value](const std::string&) -> Result<void> {
        value = true;
        return {};
    };
    return command.options.emplace_back(std::move(option));
}

} // namespace slabcast
