#pragma once

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

/// An option of a command: what its help shows, and what takes its words.
struct Option {
    std::string flag; // "--size", "-o,--output"; without hyphens what stands alone: "VOLUME"
    std::string help;
    std::string word;    // what the help shows for its value, as "WxH"; empty: it takes none
    std::string usually; // its default, as the help shows it
    std::string group;
    bool required = false;
    bool several = false;           // words, each of which is taken
    std::vector<std::string> needs; // options without which it does nothing, by flag
    std::vector<std::string> hides; // options that do nothing beside it
    /// Takes a word, or what is empty for an option without. Fails: InvalidArgument, as
    /// "'32' is not WIDTHxHEIGHT".
    std::function<Result<void>(const std::string& word)> take;
};

/// Whether an option was given, by its flag.
using Given = std::function<bool(std::string_view flag)>;

/// A command of the program. Its options' addresses are stable.
struct Command {
    std::string name;
    std::string help;
    std::string footer;
    std::deque<Option> options;
    /// In order, once all words are taken: what no single option can tell. Fail as bad usage, as
    /// "--verify: knows ...".
    std::vector<std::function<Result<void>(const Given&)>> checks;
    std::function<Result<void>()> run;
};

/// The option of this flag; null where the command has none.
const Option* findOption(const Command& command, std::string_view flag);

} // namespace slabcast
