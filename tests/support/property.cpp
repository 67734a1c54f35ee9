#include "tests/support/property.h"

#include <iostream>
#include <limits>
#include <sstream>

#include <rapidcheck.h>

namespace slabcast::test {

struct IntSource {
    rc::Gen<int> gen;
};

namespace {

/// The size at which rapidcheck draws from all of a range.
constexpr int kFullSize = 100;

rc::Gen<int> indexGen(int count) {
    return rc::gen::resize(kFullSize, rc::gen::inRange(0, count));
}

rc::Gen<std::vector<int>> vectorGen(const Ints& ints) {
    return rc::gen::container<std::vector<int>>(ints->gen);
}

rc::Gen<std::vector<std::pair<int, int>>> pairsGen(const Ints& first, const Ints& second) {
    return rc::gen::container<std::vector<std::pair<int, int>>>(
        rc::gen::pair(first->gen, second->gen));
}

Ints sourceOf(rc::Gen<int> gen) {
    return std::make_shared<const IntSource>(IntSource{std::move(gen)});
}

template <class Number>
std::string textOf(Number number) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << number;
    return text.str();
}

[[noreturn]] void endCase(rc::detail::CaseResult::Type type, const char* file, int line,
                          const char* text, const std::string& sides) {
    throw rc::detail::CaseResult(
        type, sides.empty() ? rc::detail::makeMessage(file, line, text)
                            : rc::detail::makeExpressionMessage(file, line, text, sides));
}

} // namespace

void checkProperty(void (*body)(), int times) {
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = test.name();
    rc::detail::TestParams params = rc::detail::configuration().testParams;
    params.maxSuccess *= times;
    const rc::detail::TestResult result = rc::detail::checkTestable(
        body, rc::detail::TestMetadata{std::string(test.test_suite_name()) + "/" + name, name},
        params);
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    if (!result.is<rc::detail::SuccessResult>()) {
        ADD_FAILURE() << text.str();
    } else if (!result.get<rc::detail::SuccessResult>().distribution.empty()) {
        std::cout << text.str() << "\n";
    }
}

int anyInt(int first, int end) {
    return *rc::gen::inRange(first, end);
}

bool anyBool() {
    return *rc::gen::arbitrary<bool>();
}

std::uint32_t anyBits() {
    return *rc::gen::arbitrary<std::uint32_t>();
}

int anyIndex(int count) {
    return *indexGen(count).as("index");
}

Ints intsInRange(int first, int end) {
    return sourceOf(rc::gen::inRange(first, end));
}

Ints intsOf(std::vector<int> elements) {
    rc::Gen<int> index = indexGen(int(elements.size()));
    return sourceOf(rc::gen::map(std::move(index), [elements = std::move(elements)](int i) {
        return elements[std::size_t(i)];
    }));
}

Ints intsOfEither(const Ints& one, const Ints& other) {
    return sourceOf(rc::gen::oneOf(one->gen, other->gen));
}

Ints ofSize(int size, const Ints& ints) {
    return sourceOf(rc::gen::resize(size, ints->gen));
}

std::vector<int> anyInts(const Ints& ints) {
    return *vectorGen(ints);
}

std::vector<int> anyIntsNotEmpty(const Ints& ints) {
    return *rc::gen::nonEmpty(vectorGen(ints));
}

std::vector<std::pair<int, int>> anyPairs(const Ints& first, const Ints& second) {
    return *pairsGen(first, second);
}

std::vector<std::pair<int, int>> anyPairs(int size, const Ints& first, const Ints& second) {
    return *rc::gen::resize(size, pairsGen(first, second));
}

std::vector<std::int16_t> anyInt16sNotEmpty() {
    return *rc::gen::nonEmpty<std::vector<std::int16_t>>();
}

void tagCase(const char* word) {
    rc::detail::tag({std::string(word)});
}

void failCase(const char* file, int line, const char* text, const std::string& sides) {
    endCase(rc::detail::CaseResult::Type::Failure, file, line, text, sides);
}

void dropCase(const char* file, int line, const char* text, const std::string& sides) {
    endCase(rc::detail::CaseResult::Type::Discard, file, line, text, sides);
}

std::string numberText(double number) {
    return textOf(number);
}

std::string numberText(long long number) {
    return textOf(number);
}

std::string numberText(unsigned long long number) {
    return textOf(number);
}

} // namespace slabcast::test
