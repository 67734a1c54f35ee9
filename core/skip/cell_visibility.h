#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

/// Which interpolation cells a TF makes visible, decided from the minimum and maximum of a cell's
/// corner codes. A cell with codes [a, b] is visible iff firstVisible[a] <= reach[b]. Borrows the
/// codes: they must outlive it.
struct CellVisibility {
    const TexelCodes* texels = nullptr;
    std::vector<std::uint16_t>
        firstVisible;                 // per code: first visible table texel at or above its low end
    std::vector<std::uint16_t> reach; // per code: last table texel that its high end can reach
    std::vector<std::uint16_t> nextWithAlpha; // what firstVisible was found with, by table texel

    bool visible(std::uint16_t minCode, std::uint16_t maxCode) const {
        return firstVisible[minCode] <= reach[maxCode];
    }
};

/// For post-classification: the table is non-zero anywhere between the cell's minimum and maximum,
/// widened by one table texel and by `filterErrorSampled` (what the texture unit's filter may add,
/// in sampled units). At most 65,535 table texels. Tested by: cell_visibility_test.cpp
CellVisibility cellVisibility(const TexelCodes& codes, const Texels& texels,
                              const TransferTable& table, double filterErrorSampled);
/// The same in place of another: nothing is allocated where that was of these codes and a table of
/// this capacity.
void findVisibility(const TexelCodes& codes, const Texels& texels, const TransferTable& table,
                    double filterErrorSampled, CellVisibility& into);

/// For pre-classified texels, whose codes are their alpha bytes: any corner with alpha.
CellVisibility cellVisibilityOfAlpha(const TexelCodes& alphaCodes);

} // namespace slabcast
