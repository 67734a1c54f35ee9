#include "perf/number.h"

#include <locale>
#include <sstream>

namespace slabcast {

namespace {

std::string printed(double value, int digits, std::ios_base& (*form)(std::ios_base&)) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    text << form << value;
    return text.str();
}

} // namespace

std::string number(double value, int digits) {
    return printed(value, digits, std::defaultfloat);
}

std::string fixed(double value, int digits) {
    return printed(value, digits, std::fixed);
}

} // namespace slabcast
