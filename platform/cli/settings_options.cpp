#include "platform/cli/settings_options.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/base/number_text.h"
#include "perf/settings_json.h"
#include "platform/json/read_text.h"

namespace slabcast {

namespace {

/// What the help shows for a setting's value.
std::string wordShown(const Setting& setting) {
    std::string shown;
    if (setting.kind == SettingKind::Range) {
        return "LOW,HIGH";
    }
    if (setting.kind == SettingKind::Choice) {
        const bool many = setting.words.size() > 5;
        shown = setting.unset != nullptr && !many ? setting.unset : "";
        for (const char* word : setting.words) {
            shown += (shown.empty() ? "" : "|") + std::string(word);
        }
        return many ? "NAME" : shown;
    }
    for (const int value : setting.offered) {
        shown += (shown.empty() ? "" : "|") + std::to_string(value);
    }
    if (!shown.empty()) {
        return shown;
    }
    shown = setting.kind == SettingKind::Whole ? "N" : setting.unit == nullptr ? "X" : setting.unit;
    std::transform(shown.begin(), shown.end(), shown.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return shown + (setting.unset == nullptr ? "" : std::string("|") + setting.unset);
}

/// What the shown word does not say of the values that are taken.
std::string valuesSaid(const Setting& setting) {
    if (setting.kind == SettingKind::Choice) {
        return setting.words.size() > 5 ? "; " + setting.allowed() : "";
    }
    const bool ranged = setting.offered.empty() && setting.kind != SettingKind::Range;
    return ranged ? "; from " + numberText(setting.low) + " to " + numberText(setting.high) : "";
}

/// What does nothing beside a setting, and was in a file.
void forgetRivals(Settings& settings, const Setting& given) {
    for (const Setting& other : settingsTable()) {
        const bool rivals =
            (other.excludes != nullptr && other.excludes == std::string_view(given.name)) ||
            (given.excludes != nullptr && given.excludes == std::string_view(other.name));
        if (rivals && other.unset != nullptr) {
            other.write(settings, {});
        }
    }
}

} // namespace

std::string flagOf(const Setting& setting) {
    return std::string("--") + setting.name;
}

Option& bindSetting(Command& command, Settings& settings, std::string_view name) {
    const Setting& setting = *findSetting(name);
    Option option{.flag = flagOf(setting),
                  .help = setting.help + valuesSaid(setting),
                  .word = wordShown(setting),
                  .usually = get(settings, name),
                  .group = setting.group};
    if (setting.excludes != nullptr) {
        option.hides = {flagOf(*findSetting(setting.excludes))};
    }
    option.take = [&settings, &setting](const std::string& word) -> Result<void> {
        const Result<SettingValue> value = setting.parse(word);
        if (!value) {
            // The option's name comes before, as with every other.
            const std::string& detail = value.error().detail;
            return fail(value.error().code, detail.substr(detail.find(": ") + 2));
        }
        forgetRivals(settings, setting);
        setting.write(settings, *value);
        return {};
    };
    return command.options.emplace_back(std::move(option));
}

namespace {

/// Before the options of single settings, whose words are taken in the order of the table.
void bindSettingsFile(Command& command, Settings& settings, std::vector<std::string_view> left) {
    command.options.push_back(
        {.flag = "--settings",
         .help =
             "settings of an earlier picture: its --stats file, or a JSON object with names and "
             "values; options beside it go over them",
         .word = "FILE",
         .group = "Look",
         .take = [&settings, left](const std::string& file) -> Result<void> {
             const auto named = [&](Error error) {
                 return Error{error.code, file + ": " + error.detail};
             };
             return readText(file, "file of settings").and_then([&](const std::string& text) {
                 const std::optional<Json> all = Json::parse(text);
                 return all ? takeSettings(settings, *all, left).map_error(named)
                            : fail(ErrorCode::InvalidArgument, file + ": is no JSON");
             });
         }});
}

} // namespace

void bindSettingsBut(Command& command, Settings& settings,
                     std::initializer_list<std::string_view> left) {
    bindSettingsFile(command, settings, left);
    for (const Setting& setting : settingsTable()) {
        if (std::find(left.begin(), left.end(), setting.name) == left.end()) {
            bindSetting(command, settings, setting.name);
        }
    }
}

} // namespace slabcast
