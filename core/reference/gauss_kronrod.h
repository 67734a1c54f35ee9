#pragma once

#include <array>
#include <cstddef>

namespace slabcast {

/// The nested rules G7 and K15 over [0, 1], nodes ascending, with what a second integral inside the
/// first one needs. K15 integrates polynomials up to degree 22 exactly, G7 up to 13.
struct GaussKronrod {
    static constexpr std::size_t kNodes = 15;
    using Values = std::array<double, kNodes>; // of a function at the nodes

    Values nodes{};
    Values weights{};
    Values coarseWeights{};                  // G7: zero at the nodes that Kronrod added
    std::array<Values, 4> bernstein{};       // [k]: Bernstein polynomial k of degree 3
    std::array<Values, kNodes> integralTo{}; // [j][i]: weight of value j in the integral to node i
};

namespace detail {

/// Kronrod's nodes in [-1, 1], the positive half from the outside in, and both rules' weights.
/// Source: Piessens et al. 1983, QUADPACK, qk15.
inline constexpr std::array<std::array<double, 3>, 8> kQk15{{
    {0.99145537112081263921, 0.02293532201052922496, 0.0},
    {0.94910791234275852453, 0.06309209262997855329, 0.12948496616886969327},
    {0.86486442335976907279, 0.10479001032225018384, 0.0},
    {0.74153118559939443986, 0.14065325971552591875, 0.27970539148927666790},
    {0.58608723546769113029, 0.16900472663926790283, 0.0},
    {0.40584515137739716691, 0.19035057806478540991, 0.38183005050511894495},
    {0.20778495500789846760, 0.20443294007529889241, 0.0},
    {0.0, 0.20948214108472782801, 0.41795918367346938776},
}};

/// The integral to x of the polynomial of degree 11 that is closest in the rule's own inner
/// product: its Legendre coefficients are sums over the nodes (exact, since 2 * 11 <= 22), and the
/// integral of P_k is (P_k+1 - P_k-1) / (2k + 1).
constexpr std::array<double, 13> legendreAt(double x) {
    std::array<double, 13> p{1.0, x};
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
        const auto degree = static_cast<double>(k);
        p[k + 1] = ((2.0 * degree + 1.0) * x * p[k] - degree * p[k - 1]) / (degree + 1.0);
    }
    return p;
}

constexpr GaussKronrod makeGaussKronrod() {
    GaussKronrod rule;
    for (std::size_t i = 0; i < GaussKronrod::kNodes; ++i) {
        const auto& row = kQk15[i < 8 ? i : 14 - i];
        const double s = 0.5 * (1.0 + (i < 8 ? -row[0] : row[0]));
        const double r = 1.0 - s;
        rule.nodes[i] = s;
        rule.weights[i] = 0.5 * row[1];
        rule.coarseWeights[i] = 0.5 * row[2];
        rule.bernstein[0][i] = r * r * r;
        rule.bernstein[1][i] = 3.0 * r * r * s;
        rule.bernstein[2][i] = 3.0 * r * s * s;
        rule.bernstein[3][i] = s * s * s;
    }
    for (std::size_t j = 0; j < GaussKronrod::kNodes; ++j) {
        const auto from = legendreAt(2.0 * rule.nodes[j] - 1.0);
        for (std::size_t i = 0; i < GaussKronrod::kNodes; ++i) {
            const auto to = legendreAt(2.0 * rule.nodes[i] - 1.0);
            double integral = 1.0 + to[1];
            for (std::size_t k = 1; k < 12; ++k) {
                integral += from[k] * (to[k + 1] - to[k - 1]);
            }
            rule.integralTo[j][i] = 0.5 * rule.weights[j] * integral;
        }
    }
    return rule;
}

} // namespace detail

inline constexpr GaussKronrod kGaussKronrod = detail::makeGaussKronrod();

} // namespace slabcast
