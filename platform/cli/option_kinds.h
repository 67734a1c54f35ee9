#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "platform/cli/command.h"
#include "platform/io/base/parse_text.h"

namespace slabcast {

template <class T>
using Parser = std::function<std::optional<T>(const std::string& word)>;

/// An option that keeps its word as it is, if that is not empty.
Option& addText(Command& command, Option option, std::string& value);
/// An option without a word.
Option& addFlag(Command& command, Option option, bool& value);

/// An option of one word. `parse` gives nothing for what it cannot take, `needed` says what it can.
template <class T>
Option& addParsed(Command& command, Option option, T& value, Parser<std::type_identity_t<T>> parse,
                  const std::string& needed) {
    option.take = [=, &value](const std::string& word) -> Result<void> {
        std::optional<T> parsed = parse(word);
        if (!parsed) {
            return fail(ErrorCode::InvalidArgument, fmt::format("'{}' is not {}", word, needed));
        }
        value = *std::move(parsed);
        return {};
    };
    return command.options.emplace_back(std::move(option));
}

template <class T>
struct NumberOf {
    using Type = T;
};
template <class T>
struct NumberOf<std::optional<T>> {
    using Type = T;
};

/// Of a number from `low` to `high`, so never NaN or infinite.
template <class T, class Number = typename NumberOf<T>::Type>
Parser<T> numberParser(Number low, Number high) {
    return [=](const std::string& word) -> std::optional<T> {
        const auto number = [&]() {
            if constexpr (std::is_integral_v<Number>) {
                return parseInteger(word);
            } else {
                return parseReal(word);
            }
        }();
        const bool inRange = number && *number >= low && *number <= high;
        return inRange ? std::optional<T>(static_cast<Number>(*number)) : std::nullopt;
    };
}

/// A number from `low` to `high`. `value` may be an optional.
template <class T, class Number = typename NumberOf<T>::Type>
Option& addNumber(Command& command, Option option, T& value, std::type_identity_t<Number> low,
                  std::type_identity_t<Number> high) {
    const auto needed = fmt::format(
        "a {} from {} to {}", std::is_integral_v<Number> ? "whole number" : "number", low, high);
    return addParsed<T>(command, std::move(option), value, numberParser<T>(low, high), needed);
}

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

template <class T>
std::string wordsOf(const Choices<T>& choices, const char* separator) {
    std::string all;
    for (const auto& choice : choices) {
        all += (all.empty() ? "" : separator) + choice.first;
    }
    return all;
}

/// Empty where no word means `value`.
template <class T>
std::string wordFor(const Choices<T>& choices, const T& value) {
    for (const auto& [word, meaning] : choices) {
        if (meaning == value) {
            return word;
        }
    }
    return {};
}

template <class T>
Parser<T> choiceParser(const Choices<T>& choices) {
    return [choices](const std::string& word) -> std::optional<T> {
        for (const auto& [known, meaning] : choices) {
            if (known == word) {
                return std::optional<T>(std::in_place, meaning);
            }
        }
        return std::nullopt;
    };
}

/// An option whose words stand for values. What `value` is now is the default.
template <class T>
Option& addChoice(Command& command, Option option, T& value,
                  const Choices<std::type_identity_t<T>>& choices) {
    option.word = wordsOf(choices, "|");
    option.usually = wordFor(choices, value);
    return addParsed<T>(command, std::move(option), value, choiceParser(choices),
                        "one of " + wordsOf(choices, ", "));
}

/// An option of several values with commas between. `needed`: what each of them may be.
template <class T>
Option& addList(Command& command, Option option, std::vector<T>& values,
                Parser<std::type_identity_t<T>> parse, const std::string& needed) {
    const auto parseAll = [=](const std::string& word) -> std::optional<std::vector<T>> {
        std::vector<T> parsed;
        for (const std::string_view part : split(word, ',')) {
            std::optional<T> one = parse(std::string(part));
            if (!one) {
                return std::nullopt;
            }
            parsed.push_back(*std::move(one));
        }
        return parsed;
    };
    return addParsed<std::vector<T>>(command, std::move(option), values, parseAll,
                                     needed + " with commas between");
}

} // namespace slabcast
