#include "platform/cli/help_formatter.h"

#include <fmt/core.h>

#include "platform/io/parse_text.h"

namespace slabcast {

namespace {

constexpr std::size_t kNameColumns = 32;
constexpr std::size_t kTextColumns = 68;

std::string wrapped(std::string_view text, std::size_t columns) {
    std::string lines;
    std::size_t used = 0;
    for (const std::string_view word : words(text)) {
        const bool fits = used + 1 + word.size() <= columns;
        lines += lines.empty() ? "" : fits ? " " : "\n";
        lines += word;
        used = word.size() + (fits ? used + 1 : 0);
    }
    return lines;
}

} // namespace

HelpFormatter::HelpFormatter() {
    column_width(kNameColumns);
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    const bool isFlag = option->get_type_size() == 0;
    return isFlag || option->get_positional() ? "" : " " + option->get_type_name();
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    const std::string initial = option->get_default_str();
    return wrapped(option->get_description() + (option->get_required() ? " (required)"
                                                : initial.empty()
                                                    ? ""
                                                    : fmt::format(" (default: {})", initial)),
                   kTextColumns);
}

std::string usageMessage(const CLI::App* app, const CLI::Error& error) {
    const auto commands = app->get_subcommands();
    const std::string command = commands.empty() ? "" : " " + commands.front()->get_name();
    return fmt::format("slabcast{}: {}; 'slabcast{} --help' lists what there is\n", command,
                       oneLine(error.what()), command);
}

} // namespace slabcast
