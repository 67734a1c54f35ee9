#include "platform/cli/command_parser.h"

#include <map>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "platform/io/base/parse_text.h"

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

/// CLI11's help, with defaults in words and lines that fit a terminal.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter() { column_width(kNameColumns); }

    std::string make_option_opts(const CLI::Option* option) const override {
        const bool isFlag = option->get_type_size() == 0;
        return isFlag || option->get_positional() ? "" : " " + option->get_type_name();
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        const std::string usually = option->get_default_str();
        return wrapped(option->get_description() + (option->get_required() ? " (required)"
                                                    : usually.empty()
                                                        ? ""
                                                        : fmt::format(" (default: {})", usually)),
                       kTextColumns);
    }
};

/// What bad usage answers with: the cause on one line, then where to read on.
std::string usageMessage(const CLI::App* app, const CLI::Error& error) {
    const auto commands = app->get_subcommands();
    const std::string command = commands.empty() ? "" : " " + commands.front()->get_name();
    return fmt::format("slabcast{}: {}; 'slabcast{} --help' lists what there is\n", command,
                       oneLine(error.what()), command);
}

[[noreturn]] void refuse(const std::string& flag, const std::string& why) {
    throw CLI::ValidationError(flag, why);
}

CLI::Option* addTo(CLI::App& app, const Option& option) {
    if (option.word.empty() && option.flag.starts_with('-')) {
        return app.add_flag_callback(
            option.flag, [&option] { (void)option.take(""); }, option.help);
    }
    const auto take = [&option](const std::vector<std::string>& words) {
        for (const std::string& word : words) {
            if (const Result<void> taken = option.take(word); !taken) {
                refuse(option.flag.substr(option.flag.find_last_of(',') + 1), taken.error().detail);
            }
        }
        return true;
    };
    CLI::Option* added = app.add_option(option.flag, take, option.help);
    added->type_size(1)->expected(1);
    if (option.several) {
        added->expected(1, CLI::detail::expected_max_vector_size)
            ->allow_extra_args()
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
    if (!option.word.empty()) {
        added->type_name(option.word);
    }
    return added;
}

/// One of the program's commands, beside what CLI11 makes of it.
class Binding {
public:
    Binding(CLI::App& app, Command& command) : command_(&command) {
        app_ = app.add_subcommand(command.name, command.help);
        app_->footer(command.footer);
        for (const Option& option : command.options) {
            CLI::Option* added = addTo(*app_, option);
            added->required(option.required)->default_str(option.usually);
            if (!option.group.empty()) {
                added->group(option.group);
            }
            added_.emplace(option.flag, added);
        }
        app_->final_callback([this] { check(); });
    }
    Binding(const Binding&) = delete;
    Binding& operator=(const Binding&) = delete;

    Command* command() const { return command_; }
    bool parsed() const { return app_->parsed(); }

private:
    bool given(std::string_view flag) const {
        const auto found = added_.find(std::string(flag));
        return found != added_.end() && found->second->count() > 0;
    }

    void check() const {
        for (const Option& option : command_->options) {
            if (!given(option.flag)) {
                continue;
            }
            for (const std::string& hidden : option.hides) {
                if (given(hidden)) {
                    refuse(option.flag,
                           fmt::format("excludes {}, which does nothing beside it: leave one out",
                                       hidden));
                }
            }
            for (const std::string& needed : option.needs) {
                if (!given(needed)) {
                    refuse(option.flag,
                           fmt::format("does nothing without {}: give that too", needed));
                }
            }
        }
        for (const auto& sound : command_->checks) {
            const Result<void> checked =
                sound([this](std::string_view flag) { return given(flag); });
            if (!checked) {
                throw CLI::ValidationError(checked.error().detail);
            }
        }
    }

    Command* command_;
    CLI::App* app_ = nullptr;
    std::map<std::string, CLI::Option*> added_;
};

} // namespace

ParsedCommand parseCommandLine(std::span<Command> commands, int argc, char** argv) {
    CLI::App app("Slabcast draws volumes (CT, MR, simulation) on GLES 3.2 class GPUs.", "slabcast");
    app.formatter(std::make_shared<HelpFormatter>());
    app.failure_message(usageMessage);
    app.require_subcommand(0, 1); // none is answered below, with the help
    app.set_help_all_flag("--help-all", "help of all commands");
    app.footer(
        "Start with: slabcast render phantom:marschner-lobb -o picture.png\n"
        "Exit status: 0 done; 1 failed, with one line that says why and what to do; 2 bad usage; "
        "130 interrupted by Ctrl-C");
    std::vector<std::unique_ptr<Binding>> bindings;
    for (Command& command : commands) {
        bindings.push_back(std::make_unique<Binding>(app, command));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& misuse) {
        return {.status = app.exit(misuse) == 0 ? kDone : kBadUsage};
    }
    for (const auto& binding : bindings) {
        if (binding->parsed()) {
            return {.command = binding->command()};
        }
    }
    fmt::print(stderr, "{}\n", app.help());
    return {.status = kBadUsage};
}

} // namespace slabcast
