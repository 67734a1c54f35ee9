#pragma once

#include <vector>

#include "core/reference/discrete.h"
#include "core/reference/picture_difference.h"
#include "perf/json.h"
#include "perf/stage.h"

namespace slabcast {

// Pictures here are premultiplied, in the compositing space, rows from the bottom; of the volume's
// own values (StageDesc::keepValues), so that what the texel format loses is the GPU's part.

inline constexpr double kReferenceTolerance = 1e-10; // relative, of every smooth piece of a ray

/// What the stage would draw at turn 0, all its eyes, were there no error at all. Tells
/// the stage's watcher how far it is.
std::vector<glm::dvec4> continuousPicture(const Stage& stage);

/// The samples of `lattice` as the stage's look classifies them, exactly: with the transfer
/// function as it is meant, or as the table holds it.
enum class TransferKind : std::uint8_t { Continuous, Table };
std::vector<glm::dvec4> discretePicture(const Stage& stage, const Lattice& lattice,
                                        TransferKind kind);

/// For a file: over black, sRGB-encoded, top row first.
std::vector<glm::vec4> shown(const std::vector<glm::dvec4>& picture, glm::ivec2 size,
                             CompositingSpace space);

struct AmplifiedDifference {
    std::vector<glm::vec4> pixels; // top row first
    double factor = 1.0;
};

/// |picture - reference|, times the largest power of two that leaves 99.9 % of the pixels in range.
AmplifiedDifference amplified(const std::vector<glm::dvec4>& picture,
                              const std::vector<glm::dvec4>& reference, glm::ivec2 size);

/// Keys are those of PictureDifference's members, with the channel's name before its own.
Json toJson(const PictureDifference& difference);

} // namespace slabcast
