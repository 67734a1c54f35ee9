#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/gl/shader_text.h"
#include "core/skip/skip_structure.h"

namespace slabcast {

enum class Classification : std::uint8_t { Post, Pre, Preintegrated };

const char* name(Classification classification);

/// Groups of operations that a device may do in 16 bits: a layer's opacity from its depth; the sum
/// of layers; colours between the table's, and premultiplied; light; extinction between the
/// table's.
inline constexpr int kHalfOpacity = 1, kHalfSum = 2, kHalfColor = 4, kHalfLight = 8;
inline constexpr int kHalfExtinction = 16;
inline constexpr int kHalfAll = 31;

/// Lengths of segments that are written out layer by layer.
inline constexpr std::array<int, 10> kUnrollLengths = {1, 2, 4, 8, 12, 16, 24, 32, 48, 64};

/// Shortest unrolled length that holds `layersPerPlane`, or 0 where none does: then only the loop
/// form serves.
int unrollLengthFor(int layersPerPlane);

// clang-format off
/// Which segment shader. A field exists only where it changes loop structure, resources or outputs;
/// all else is a uniform, and what a field switches off is absent from the text.
///
/// | field          | off                            | on                                             |
/// |----------------|--------------------------------|------------------------------------------------|
/// | classification | Post: field + table            | Pre: one RGBA8 texture, colours baked;         |
/// |                |                                | Preintegrated: field + table of both ends      |
/// | skip           | None                           | one more texture, tests per segment and        |
/// |                |                                | stretch: Balls, Boxes, or an octree's nodes    |
/// | shaded         | colour as classified           | 6 more fields per visible sample (Post only)   |
/// | exactField     | texture unit's filter          | 8 fetches, float32 (not Pre)                   |
/// | terminates     | every layer                    | leaves when nearly opaque                      |
/// | fetchesTarget  | sees its own segment           | sees what is drawn before it and leaves when   |
/// |                |                                | both together are (front to back; terminates)  |
/// | unroll         | 0: loop                        | layers written out, from kUnrollLengths        |
/// | counts         | draws                          | writes work counters instead of colour         |
/// | halfGroups     | 0: float32                     | these rounded to fp16: what mediump may do     |
// clang-format on
struct ShaderVariant {
    Classification classification = Classification::Post;
    SkipForm skip = SkipForm::None;
    bool shaded = false;
    bool exactField = false;
    bool terminates = false;
    bool fetchesTarget = false;
    int unroll = 0;
    bool counts = false;
    int halfGroups = 0; // sum of kHalf...; for measuring

    bool operator==(const ShaderVariant&) const = default;
    auto operator<=>(const ShaderVariant&) const = default;

    constexpr bool valid() const {
        const bool listed = [this] {
            for (const int length : kUnrollLengths) {
                if (length == unroll) {
                    return true;
                }
            }
            return unroll == 0;
        }();
        const bool shadable = classification == Classification::Post;
        const bool hasField = classification != Classification::Pre;
        const bool measured =
            halfGroups == 0 || (halfGroups > 0 && halfGroups <= kHalfAll && unroll == 0 && !counts);
        return listed && measured && (shadable || !shaded) && (hasField || !exactField) &&
               (terminates || !fetchesTarget);
    }
};

/// As logs and statistics show it: "post+balls+shaded+terminate/unroll16".
std::string name(const ShaderVariant& variant);

/// All valid variants; of those that round to fp16, all groups at once in the loop form. For the
/// test that walks them.
std::vector<ShaderVariant> allVariants();

/// Planes whose outlines fit the uniform block that every GLES 3.2 device has (16 KiB).
inline constexpr int kMaxOutlines = 1024;

struct ShaderPair {
    std::string vertex;
    std::string fragment;
};

Result<ShaderPair> shaderText(const ShaderVariant& variant);

} // namespace slabcast
