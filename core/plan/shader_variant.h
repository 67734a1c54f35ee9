#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/skip/skip_structure.h"
#include "core/view/lattice.h"

namespace slabcast {

enum class Classification : std::uint8_t { Post, Pre, Preintegrated };
/// What gives a value its colour and extinction.
enum class Material : std::uint8_t { Transfer };
/// How a transfer function's table is read between two texels: both, in float32, or the device's
/// filter.
enum class TableRead : std::uint8_t { Exact, Filtered };
/// Where a layer's opacity is made from its length: along every ray, or once, where layers are all
/// of one length, in the table or the pre-classified texels.
enum class Lengths : std::uint8_t { PerRay, Baked };
/// Where a shaded sample's gradient comes from: six samples around it, or a texture of normals that
/// was baked beforehand.
enum class Normals : std::uint8_t { Computed, Baked };
/// What a ray's stay is cut to. None: what is visible keeps clear of all that would cut it.
enum class Interval : std::uint8_t { Box, None };
/// What is made of a ray's layers.
enum class Accumulate : std::uint8_t { Composite };
/// What puts a plane's polygon where it lies: 10-gons around the sphere, or rectangles.
enum class Cover : std::uint8_t { Planes };

const char* name(Classification classification);

/// Lengths of segments that are written out layer by layer.
inline constexpr std::array<int, 10> kUnrollLengths = {1, 2, 4, 8, 12, 16, 24, 32, 48, 64};

/// Layers in a row without a branch between them, in a loop: shorter segments are written out.
inline constexpr int kLoopGroup = 8;

/// Shortest unrolled length that holds `layersPerPlane`, or 0 where none does: then only the loop
/// form serves.
int unrollLengthFor(int layersPerPlane);

/// Which segment shader: a value of each axis in shader_axes.h, where each axis is explained. A
/// field exists only where it changes loop structure, resources, stages or outputs; all else is a
/// uniform, and what a field switches off is absent from the text.
struct ShaderVariant {
    Classification classification = Classification::Post;
    SkipForm skip = SkipForm::None;
    bool shaded = false;
    bool exactField = false;
    bool terminates = false;
    bool fetchesTarget = false;
    int unroll = 0; // 0: a loop; else one of kUnrollLengths
    bool counts = false;
    LatticeKind lattice = LatticeKind::Planar;
    bool jittered = false;
    Normals normals = Normals::Computed;
    Material material = Material::Transfer;
    TableRead table = TableRead::Exact;
    Lengths lengths = Lengths::PerRay;
    Interval interval = Interval::Box;
    Accumulate accumulate = Accumulate::Composite;
    Cover cover = Cover::Planes;

    bool operator==(const ShaderVariant&) const = default;
    auto operator<=>(const ShaderVariant&) const = default;

    /// Whether a shader of these values exists. Tested by: shader_variant_test.cpp
    bool valid() const;
};

/// As logs and statistics show it: "post+balls+shaded+terminate/unroll16". Lattice and jitter are
/// stated beside it.
std::string name(const ShaderVariant& variant);

/// Groups of operations that a device may do in 16 bits: a layer's opacity from its depth; the sum
/// of layers; colours between the table's, and premultiplied; what mixes colour and light;
/// extinction between the table's.
inline constexpr int kHalfOpacity = 1, kHalfSum = 2, kHalfColor = 4, kHalfLight = 8;
inline constexpr int kHalfExtinction = 16;
inline constexpr int kHalfAll = 31;
/// Those that the shaders declare mediump. Tested by: shader_variant_test.cpp
inline constexpr int kHalfDeclared = kHalfLight;
/// Beside groups: rounded toward zero, as a device may, instead of to nearest.
inline constexpr int kHalfCutOff = 32;
/// No group: what is mediump is highp, as in all texts that round.
inline constexpr int kHalfNowhere = 64;

/// What measuring changes in a variant's text, and nothing that is drawn for a user.
struct MeasuringText {
    int halfGroups = 0; // sum of kHalf...: these results are rounded to fp16, as mediump may be
};

/// Planes whose outlines fit the uniform block that every GLES 3.2 device has (16 KiB).
inline constexpr int kMaxOutlines = 1024;

struct ShaderPair {
    std::string vertex;
    std::string fragment;
};

/// Both stages, whole. Contract: the variant is valid. Fails: ShaderCompile (a file is missing).
/// Tested by: shader_variant_test.cpp, shader_validator_test.cpp
Result<ShaderPair> shaderText(const ShaderVariant& variant, const MeasuringText& measuring = {});

/// Layers in a row without a branch between them.
int groupOf(const ShaderVariant& variant);

/// The textures that a variant's program reads, by name, in alphabetical order.
/// Tested by: renderer_work_gl_test.cpp
std::vector<std::string> samplersOf(const ShaderVariant& variant);

} // namespace slabcast
