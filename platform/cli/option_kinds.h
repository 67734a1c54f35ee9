#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "platform/io/parse_text.h"

namespace slabcast {

template <class T>
using Parser = std::function<std::optional<T>(const std::string& word)>;

/// An option of one word. `parse` gives nothing for what it cannot take, `needed` says what it can.
template <class T>
CLI::Option* addParsed(CLI::App& command, const std::string& flag, T& value, Parser<T> parse,
                       const std::string& needed, const std::string& help) {
    const auto take = [=, &value](const std::string& word) {
        std::optional<T> parsed = parse(word);
        if (!parsed) {
            throw CLI::ValidationError(flag, fmt::format("'{}' is not {}", word, needed));
        }
        value = *std::move(parsed);
    };
    return command.add_option_function<std::string>(flag, take, help);
}

template <class T>
struct NumberOf {
    using Type = T;
};
template <class T>
struct NumberOf<std::optional<T>> {
    using Type = T;
};

/// A number from `low` to `high`, so never NaN or infinite. `value` may be an optional.
template <class T, class Number = typename NumberOf<T>::Type>
CLI::Option* addNumber(CLI::App& command, const std::string& flag, T& value,
                       std::type_identity_t<Number> low, std::type_identity_t<Number> high,
                       const std::string& help) {
    constexpr bool isWhole = std::is_integral_v<Number>;
    const auto parse = [=](const std::string& word) -> std::optional<T> {
        const auto number = [&]() {
            if constexpr (isWhole) {
                return parseInteger(word);
            } else {
                return parseReal(word);
            }
        }();
        const bool inRange = number && *number >= low && *number <= high;
        return inRange ? std::optional<T>(static_cast<Number>(*number)) : std::nullopt;
    };
    const auto needed =
        fmt::format("a {} from {} to {}", isWhole ? "whole number" : "number", low, high);
    return addParsed<T>(command, flag, value, parse, needed, help);
}

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// An option whose words stand for values. What `value` is now is the default.
template <class T>
CLI::Option* addChoice(CLI::App& command, const std::string& flag, T& value,
                       const Choices<std::type_identity_t<T>>& choices, const std::string& help) {
    std::vector<std::string> choiceWords;
    std::string initial;
    for (const auto& [word, meaning] : choices) {
        choiceWords.push_back(word);
        initial = meaning == value ? word : initial;
    }
    const auto parse = [choices](const std::string& word) -> std::optional<T> {
        for (const auto& [known, meaning] : choices) {
            if (known == word) {
                return std::optional<T>(std::in_place, meaning);
            }
        }
        return std::nullopt;
    };
    const auto needed = fmt::format("one of {}", fmt::join(choiceWords, ", "));
    return addParsed<T>(command, flag, value, parse, needed, help)
        ->type_name(fmt::format("{}", fmt::join(choiceWords, "|")))
        ->default_str(initial);
}

} // namespace slabcast
