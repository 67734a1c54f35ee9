#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "core/plan/settings_table.h"
#include "platform/cli/option_kinds.h"

namespace slabcast {

/// "--layers" for "layers".
std::string flagOf(const Setting& setting);

/// An option for the setting of this name, with the table's help, range and default.
Option& bindSetting(Command& command, Settings& settings, std::string_view name);
/// One for every setting of the table but these, and one for a file of them, over which the others
/// go.
void bindSettingsBut(Command& command, Settings& settings,
                     std::initializer_list<std::string_view> left);

/// The words of a setting as choices of the member that it stands for.
template <class Member>
auto choicesOf(std::string_view name, Member member) {
    Settings settings;
    Choices<std::remove_cvref_t<decltype(member(settings))>> choices;
    for (const char* word : findSetting(name)->words) {
        (void)set(settings, name, word);
        choices.emplace_back(word, member(settings));
    }
    return choices;
}

/// An option of several values of a setting with commas between; `usually` is its default.
template <class T, class Member>
Option& bindSettingList(Command& command, std::string_view name, Option option,
                        std::vector<T>& values, const std::vector<T>& usually, Member member) {
    const auto parse = [=](const std::string& word) -> std::optional<T> {
        Settings settings;
        return set(settings, name, word) ? std::optional<T>(std::in_place, member(settings))
                                         : std::nullopt;
    };
    for (const T& value : usually) {
        Settings settings;
        member(settings) = value;
        option.usually += (option.usually.empty() ? "" : ",") + get(settings, name);
    }
    const Setting& setting = *findSetting(name);
    option.flag = flagOf(setting);
    return addList<T>(command, std::move(option), values, parse,
                      "one or several, each " + setting.allowed() + ",");
}

} // namespace slabcast
