#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/plan/settings.h"

namespace slabcast {

/// What a setting takes: one of several words, a whole number, a number, or two of them.
enum class SettingKind : std::uint8_t { Choice, Whole, Real, Range };

/// A setting's value: the index of a choice's word, a number, both ends of a range; nothing where
/// it is left to the plan or switched off.
struct SettingValue {
    int count = 0;
    std::array<double, 2> numbers{};

    bool operator==(const SettingValue&) const = default;
};

/// One member of Settings, as people see it. The command line's options, the settings in reports
/// and docs/settings.md are made from this.
struct Setting {
    const char* name; // lower case with hyphens; as an option, with two more before it
    const char* group;
    SettingKind kind;
    std::span<const char* const> words; // of a choice
    std::span<const int> offered;       // of a whole number: no others; empty: all in between
    double low, high;                   // of a number, both allowed
    const char* unit;                   // of a number; empty where it has none
    const char* unset;                  // the word for no value; null: it always has one
    const char* excludes;               // the setting that may not be given beside it, or null
    bool (*usedBy)(SkipStructure);      // of a skip structure's parameter; null: of every picture's
    const char* help;                   // one line
    SettingValue (*read)(const Settings& settings);
    void (*write)(Settings& settings, const SettingValue& value); // unchecked

    /// Whether this is a value of it.
    bool takes(const SettingValue& value) const;
    /// What it takes, as "a number from 0.001 to 1000000, or auto".
    std::string allowed() const;
    /// The value that this text stands for. Fails: InvalidArgument, as
    /// "planes: '0' is not a whole number from 1 to 1048576, or auto".
    Result<SettingValue> parse(std::string_view text) const;
    /// Shortest text that parse() gives the same value for.
    std::string text(const SettingValue& value) const;
    /// Whether a text is a number in reports, not a word.
    bool isNumber(const SettingValue& value) const;
};

/// Every member of Settings that can be chosen, in the order in which they are shown.
/// Tested by: settings_table_test.cpp
std::span<const Setting> settingsTable();

/// Null where there is none of this name.
const Setting* findSetting(std::string_view name);

/// Fails: InvalidArgument (no such setting; as Setting::parse()). Then nothing has changed.
Result<void> set(Settings& settings, std::string_view name, std::string_view text);

/// Contract: there is a setting of this name.
std::string get(const Settings& settings, std::string_view name);

} // namespace slabcast
