#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

// What the benchmarks of skip structures share.

namespace slabcast::perf {

inline constexpr int kSize = 256;

/// A head-like shell of bone in soft tissue in air, with noise: values 0 to 4095, codes of 16 bits.
inline TexelCodes headCodes() {
    TexelCodes codes;
    codes.dims = glm::ivec3(kSize);
    std::uint32_t random = 1;
    for (int z = 0; z < kSize; ++z) {
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const glm::dvec3 p = (glm::dvec3(x, y, z) + 0.5) / (kSize / 2.0) - 1.0;
                const double r = glm::length(p / glm::dvec3(0.7, 0.85, 0.9));
                const double tissue = r > 1.0    ? 24.0
                                      : r > 0.92 ? 1070.0
                                      : r > 0.84 ? 2000.0
                                                 : 1060.0;
                random = random * 1664525U + 1013904223U;
                codes.codes.push_back(std::uint16_t(tissue + double(random >> 27)));
            }
        }
    }
    for (int c = 0; c < 65536; ++c) {
        codes.lowSampled.push_back(float(c));
        codes.highSampled.push_back(float(c));
    }
    return codes;
}

inline TransferTable bandTable(int first, int last) {
    TransferTable table{0.0, 4095.0, std::vector<glm::vec4>(4096, glm::vec4(0.0F))};
    for (int k = first; k <= last; ++k) {
        table.texels[k].a = 0.5F;
    }
    return table;
}

template <class Step>
double medianMs(Step step) {
    std::vector<double> times;
    for (int i = 0; i < 9; ++i) {
        const auto start = std::chrono::steady_clock::now();
        step();
        const std::chrono::duration<double, std::milli> spent =
            std::chrono::steady_clock::now() - start;
        times.push_back(spent.count());
    }
    std::nth_element(times.begin(), times.begin() + 4, times.end());
    return times[4];
}

} // namespace slabcast::perf
