#include "core/base/number_text.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace slabcast {

std::string numberText(double value) {
    std::string text;
    for (const int digits : {15, std::numeric_limits<double>::max_digits10}) {
        std::ostringstream out;
        out.imbue(std::locale::classic());
        out.precision(digits);
        out << value;
        text = out.str();
        if (numberFrom(text) == value) {
            break;
        }
    }
    return text;
}

std::optional<double> numberFrom(std::string_view text) {
    std::istringstream in{std::string(text)};
    in.imbue(std::locale::classic());
    double value = 0.0;
    in >> std::noskipws >> value;
    if (in.fail() || in.peek() != std::istringstream::traits_type::eof() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

} // namespace slabcast
