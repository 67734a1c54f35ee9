#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

// Properties: tests of random cases, of which one that fails is shrunk. Rapidcheck does it, and
// only property.cpp includes it: its templates, made anew in each of fifteen sources, took about
// 90 of the 140 s that these took to compile.

/// A test of as many random cases as RC_PARAMS says, a hundred by default.
#define PROPERTY(suite, name) PROPERTY_TIMES(1, suite, name)

/// The same with `times` as many cases.
#define PROPERTY_TIMES(times, suite, name)                                                         \
    static void propertyOf##suite##name();                                                         \
    TEST(suite, name) {                                                                            \
        ::slabcast::test::checkProperty(propertyOf##suite##name, times);                           \
    }                                                                                              \
    static void propertyOf##suite##name()

/// A case of which this does not hold fails the property.
#define PROPERTY_ASSERT(condition)                                                                 \
    PROPERTY_DECIDE(condition, failCase, "PROPERTY_ASSERT(" #condition ")")

/// A case of which this does not hold is not meant: another is drawn.
#define PROPERTY_ASSUME(condition)                                                                 \
    PROPERTY_DECIDE(condition, dropCase, "PROPERTY_ASSUME(" #condition ")")

#define PROPERTY_DECIDE(condition, otherwise, text)                                                \
    do {                                                                                           \
        if (const ::slabcast::test::Judged judged(::slabcast::test::Judge{}->*condition);          \
            !judged.holds) {                                                                       \
            ::slabcast::test::otherwise(__FILE__, __LINE__, text, judged.sides);                   \
        }                                                                                          \
    } while (false)

namespace slabcast::test {

/// Checks a property within a test. Fails it with rapidcheck's words: the seed, the shrunk case.
void checkProperty(void (*body)(), int times = 1);

// Within a property. What is drawn shrinks towards the first that is named, vectors also towards
// empty ones. Early cases are small: of a range its first part, of vectors short ones.

/// first <= x < end.
int anyInt(int first, int end);
bool anyBool();
/// Few bits in early cases.
std::uint32_t anyBits();
/// Each as likely as another, in early cases too: 0 <= i < count.
int anyIndex(int count);

/// One of these, each as likely as another.
template <class T, class... More>
T anyElement(T first, More... more) {
    const T elements[] = {first, more...};
    return elements[anyIndex(1 + int(sizeof...(more)))];
}

/// Where the ints of a vector come from: rapidcheck's generator.
struct IntSource;
using Ints = std::shared_ptr<const IntSource>;
/// As anyInt draws them.
Ints intsInRange(int first, int end);
/// As anyElement does.
Ints intsOf(std::vector<int> elements);
/// From both, as often.
Ints intsOfEither(const Ints& one, const Ints& other);
/// As if the case were of this size: 0 for the first, 100 for the last.
Ints ofSize(int size, const Ints& ints);

std::vector<int> anyInts(const Ints& ints);
std::vector<int> anyIntsNotEmpty(const Ints& ints);
std::vector<std::pair<int, int>> anyPairs(const Ints& first, const Ints& second);
/// As if the case were of this size, which is that of the longest vector.
std::vector<std::pair<int, int>> anyPairs(int size, const Ints& first, const Ints& second);
std::vector<std::int16_t> anyInt16sNotEmpty();

/// Counts the case under a word; how many there were of each is told in the end.
void tagCase(const char* word);

[[noreturn]] void failCase(const char* file, int line, const char* text, const std::string& sides);
[[noreturn]] void dropCase(const char* file, int line, const char* text, const std::string& sides);

std::string numberText(double number);
std::string numberText(long long number);
std::string numberText(unsigned long long number);

/// A side of a comparison: numbers only.
template <class T>
std::string sideText(const T& side) {
    if constexpr (std::is_floating_point_v<T>) {
        return numberText(double(side));
    } else if constexpr (std::is_unsigned_v<T>) {
        return numberText(static_cast<unsigned long long>(side));
    } else if constexpr (std::is_integral_v<T>) {
        return numberText(static_cast<long long>(side));
    } else {
        return "...";
    }
}

/// Whether a condition holds; if not, what it compared.
struct Judged {
    bool holds;
    std::string sides;

    Judged(bool value) : holds(value) {}
    template <class L, class R>
    Judged(bool value, const L& left, const char* sign, const R& right) : holds(value) {
        if (!holds) {
            sides = sideText(left) + sign + sideText(right);
        }
    }
    operator bool() const { return holds; } // where && or || follow
};

/// The left side of a condition: all of it where it compares nothing.
template <class L>
struct LeftSide {
    const L& left;

    operator const L&() const { return left; }
    template <class R>
    Judged operator==(const R& right) const {
        return {left == right, left, " == ", right};
    }
    template <class R>
    Judged operator!=(const R& right) const {
        return {left != right, left, " != ", right};
    }
    template <class R>
    Judged operator<(const R& right) const {
        return {left < right, left, " < ", right};
    }
    template <class R>
    Judged operator<=(const R& right) const {
        return {left <= right, left, " <= ", right};
    }
    template <class R>
    Judged operator>(const R& right) const {
        return {left > right, left, " > ", right};
    }
    template <class R>
    Judged operator>=(const R& right) const {
        return {left >= right, left, " >= ", right};
    }
};

/// Takes what follows up to a comparison: nothing binds as closely as ->*.
struct Judge {
    template <class L>
    LeftSide<L> operator->*(const L& left) const {
        return {left};
    }
};

} // namespace slabcast::test
