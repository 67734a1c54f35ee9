#include "perf/stability/case.h"

#include <algorithm>

namespace slabcast::stability {

std::string named(std::initializer_list<std::string_view> parts) {
    std::string name;
    for (const std::string_view part : parts) {
        name += name.empty() || part.empty() ? "" : ", ";
        name += part;
    }
    return name;
}

Result<void> verdict(std::span<const Case> cases) {
    const auto exceeds = [](const Case& c) { return !c.pass(); };
    const auto first = std::find_if(cases.begin(), cases.end(), exceeds);
    if (first == cases.end()) {
        return {};
    }
    const auto failed = std::count_if(first, cases.end(), exceeds);
    return fail(ErrorCode::Internal, std::to_string(failed) + " of " +
                                         std::to_string(cases.size()) +
                                         " cases exceed their bounds, the first is '" +
                                         first->name + "': see report.html");
}

} // namespace slabcast::stability
