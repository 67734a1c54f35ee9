#pragma once

#include <cstdint>
#include <optional>

#include "core/plan/shader_variant.h"
#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"

namespace slabcast {

inline constexpr int kMaxTotalLayers = 1 << 20;

/// What planes are blended into.
enum class TargetFormat : std::uint8_t { Rgba8, Rgba16f };
enum class SegmentForm : std::uint8_t { Auto, Unrolled, Loop };
/// Where skip structures are built. Auto: on the GPU, unless its compute shaders run on the host.
enum class SkipBuilder : std::uint8_t { Auto, Cpu, Gpu };
/// BackToFront: the farthest plane first, each blended over what the target holds. FrontToBack: the
/// nearest first, each blended under those before it, in an off-screen layer that is then blended
/// over the target once.
enum class BlendOrder : std::uint8_t { BackToFront, FrontToBack };

const char* name(TargetFormat format);
const char* name(BlendOrder order);

/// What a user may ask for; what is unset the plan decides. Tested by: frame_plan_test.cpp
struct Settings {
    Classification classification = Classification::Post;
    std::optional<SkipStructure> skip;
    SkipOptions skipOptions; // of the structure; its kind is what is built where `skip` is unset
    SkipBuilder skipBuilder = SkipBuilder::Auto;
    std::optional<LatticeKind> lattice;
    bool jitter = false;             // moves every ray's layers by up to half a layer
    double layerSpacingVoxels = 1.0; // of the smallest voxel edge
    std::optional<int> totalLayers;  // instead of the spacing
    std::optional<int> planes;       // at most one of planes and layersPerPlane
    std::optional<int> layersPerPlane;
    SegmentForm form = SegmentForm::Auto;
    bool tighten = true;
    TargetFormat target = TargetFormat::Rgba8;
    CompositingSpace space = CompositingSpace::Display;
    bool shaded = false;
    Normals normals = Normals::Computed; // of what is shaded sample by sample
    std::optional<BlendOrder> order;
    /// Opacity at which a segment is left and, front to back, a pixel: what is lost behind is at
    /// most one 8-bit step.
    std::optional<double> termination = 1.0 - 1.0 / 256.0;
};

} // namespace slabcast
