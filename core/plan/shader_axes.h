#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <type_traits>

#include "core/base/short_list.h"
#include "core/plan/shader_resources.h"
#include "core/plan/shader_variant.h"

/// The axes of segment shaders as one table: what values there are, the file of each, what it reads
/// and what it needs of other axes. A variant's name, its validity and its text follow from it. How
/// files of one axis are written: gles_shaders/README.md.
namespace slabcast {

/// In the order of the table, which is that of a variant's name.
enum class Axis : std::uint8_t {
    Classification,
    Skip,
    Shading,
    Normals,
    Field,
    Material,
    Table,
    Lengths,
    Interval,
    Accumulate,
    Termination,
    Target,
    Counting,
    Lattice,
    Jitter,
    Cover,
    Form,
};

/// `#include SLOT` becomes the file; or another slot, which a value of another axis fills.
struct SlotFile {
    const char* slot = nullptr;
    const char* file = nullptr;
};

struct AxisValue {
    const char* name = "";   // for people
    const char* suffix = ""; // of the variant's name
    ShortList<SlotFile, 3> files{};
    ShortList<Sampler, 2> samplers{};
    ShortList<const char*, 5> fields{}; // of frame_fields.h, beside those that every segment reads
    const char* extension = nullptr;    // of programs that draw
    ShortList<Sampler, 1> samplersCounting{}; // of programs that count
    int layersWrittenOut = 0;
    int layersPerGroup = 0; // in a row, without a branch between them
};

/// One axis, and which field of a variant holds its value.
struct AxisInfo {
    const char* name;
    std::size_t (*valueOf)(const ShaderVariant& variant); // its place among the values
    void (*choose)(ShaderVariant& variant, std::size_t value);
    const AxisValue* values;
    std::size_t count;
};

/// A value of one axis that exists only beside some of another.
struct Requirement {
    Axis axis;
    std::size_t value;
    Axis other;
    ShortList<std::size_t, 3> among;
};

namespace axes {

inline constexpr AxisValue kClassification[] = {
    {.name = "post",
     .suffix = "post",
     .files = {{"CLASSIFICATION_FILE", "segment/classification/post.glsl"},
               {"OF_LENGTH_FILE", "segment/lengths/of_material.glsl"}},
     .samplers = {Sampler::Volume, Sampler::Table},
     .fields = {"tableMap"}},
    {.name = "preclassified",
     .suffix = "preclassified",
     .files = {{"CLASSIFICATION_FILE", "segment/classification/preclassified.glsl"},
               {"OF_LENGTH_FILE", "segment/lengths/of_opacity.glsl"}},
     .samplers = {Sampler::Volume}},
    {.name = "preintegrated",
     .suffix = "preintegrated",
     .files = {{"CLASSIFICATION_FILE", "segment/classification/preintegrated.glsl"},
               {"OF_LENGTH_FILE", "segment/lengths/of_mean.glsl"}},
     .samplers = {Sampler::Volume, Sampler::Table},
     .fields = {"tableMap", "tableEnds"}},
};

inline constexpr AxisValue kSkip[] = {
    {.name = "none", .files = {{"SKIP_FILE", "segment/skip/none.glsl"}}},
    {.name = "balls",
     .suffix = "+balls",
     .files = {{"SKIP_FILE", "segment/skip/balls.glsl"}},
     .samplers = {Sampler::Skip},
     .fields = {"skipMap"}},
    {.name = "boxes",
     .suffix = "+boxes",
     .files = {{"SKIP_FILE", "segment/skip/boxes.glsl"}},
     .samplers = {Sampler::Skip},
     .fields = {"skipMap"}},
    {.name = "octree",
     .suffix = "+octree",
     .files = {{"SKIP_FILE", "segment/skip/octree.glsl"},
               {"NODE_FILE", "segment/skip/node_bits.glsl"}},
     .samplers = {Sampler::Skip},
     .fields = {"skipMap", "skipBlocks", "octree", "octreeLevels", "nodeTest"}},
    {.name = "wide octree",
     .suffix = "+wide-octree",
     .files = {{"SKIP_FILE", "segment/skip/octree.glsl"},
               {"NODE_FILE", "segment/skip/node_wide.glsl"}},
     .samplers = {Sampler::Skip},
     .fields = {"skipMap", "skipBlocks", "octree", "octreeLevels", "nodeTest"}},
    {.name = "range octree",
     .suffix = "+range-octree",
     .files = {{"SKIP_FILE", "segment/skip/octree.glsl"},
               {"NODE_FILE", "segment/skip/node_range.glsl"}},
     .samplers = {Sampler::Skip},
     .fields = {"skipMap", "skipBlocks", "octree", "octreeLevels", "nodeTest"}},
};

inline constexpr AxisValue kShading[] = {
    {.name = "none", .files = {{"SHADING_FILE", "segment/shading/none.glsl"}}},
    {.name = "phong",
     .suffix = "+shaded",
     .files = {{"SHADING_FILE", "segment/shading/phong.glsl"}},
     .fields = {"gradientRow", "patientRow", "material"}},
};

inline constexpr AxisValue kNormals[] = {
    {.name = "computed", .files = {{"NORMALS_FILE", "segment/normals/computed.glsl"}}},
    {.name = "baked",
     .suffix = "+normals",
     .files = {{"NORMALS_FILE", "segment/normals/baked.glsl"}},
     .samplers = {Sampler::Normals}},
};

inline constexpr AxisValue kField[] = {
    {.name = "filtered", .files = {{"FIELD_FILE", "segment/field/filtered.glsl"}}},
    {.name = "exact",
     .suffix = "+exact",
     .files = {{"FIELD_FILE", "segment/field/exact.glsl"}},
     .fields = {"decode"}},
};

inline constexpr AxisValue kMaterial[] = {
    {.name = "transfer",
     .files = {{"MATERIAL_OF_VALUE_FILE", "segment/material/transfer.glsl"},
               {"MATERIAL_OF_INTERVAL_FILE", "segment/material/transfer_interval.glsl"}}},
};

inline constexpr AxisValue kTable[] = {
    {.name = "exact", .files = {{"TABLE_FILE", "segment/table/exact.glsl"}}},
    {.name = "filtered",
     .suffix = "+filtered",
     .files = {{"TABLE_FILE", "segment/table/filtered.glsl"}}},
};

inline constexpr AxisValue kLengths[] = {
    {.name = "per ray", .files = {{"LENGTHS_FILE", "segment/lengths/per_ray.glsl"}}},
    {.name = "baked", .suffix = "+baked", .files = {{"LENGTHS_FILE", "BAKED_FILE"}}},
};

inline constexpr AxisValue kInterval[] = {
    {.name = "box", .files = {{"INTERVAL_FILE", "segment/interval/box.glsl"}}},
    {.name = "none",
     .suffix = "+boundless",
     .files = {{"INTERVAL_FILE", "segment/interval/none.glsl"}}},
};

inline constexpr AxisValue kAccumulate[] = {
    {.name = "composite", .files = {{"ACCUMULATE_FILE", "segment/accumulate/composite.glsl"}}},
};

inline constexpr AxisValue kTermination[] = {
    {.name = "none", .files = {{"TERMINATION_FILE", "segment/termination/none.glsl"}}},
    {.name = "early", .suffix = "+terminate", .files = {{"TERMINATION_FILE", "EARLY_FILE"}}},
};

inline constexpr AxisValue kTarget[] = {
    {.name = "blended",
     .files = {{"EARLY_FILE", "segment/termination/early.glsl"},
               {"DRAWN_FILE", "segment/output/blended.glsl"},
               {"COUNTED_FILE", "segment/output/counted.glsl"}}},
    {.name = "fetched",
     .suffix = "+fetch",
     .files = {{"EARLY_FILE", "segment/termination/across.glsl"},
               {"DRAWN_FILE", "segment/output/fetched.glsl"},
               {"COUNTED_FILE", "segment/output/counted_behind.glsl"}},
     .extension = kFetchExtension,
     .samplersCounting = {Sampler::LayerBefore}},
};

inline constexpr AxisValue kCounting[] = {
    {.name = "none",
     .files = {{"COUNTING_FILE", "segment/counting/none.glsl"}, {"OUTPUT_FILE", "DRAWN_FILE"}}},
    {.name = "work",
     .suffix = "+counts",
     .files = {{"COUNTING_FILE", "segment/counting/work.glsl"}, {"OUTPUT_FILE", "COUNTED_FILE"}}},
};

inline constexpr AxisValue kLattice[] = {
    {.name = "planar", .files = {{"LATTICE_FILE", "segment/lattice/planar.glsl"}}},
    {.name = "shells",
     .files = {{"LATTICE_FILE", "segment/lattice/shells.glsl"}},
     .fields = {"sphere", "missed"}},
};

inline constexpr AxisValue kJitter[] = {
    {.name = "none", .files = {{"JITTER_FILE", "segment/jitter/none.glsl"}}},
    {.name = "per ray",
     .files = {{"JITTER_FILE", "segment/jitter/per_ray.glsl"}},
     .fields = {"jitter"}},
};

inline constexpr AxisValue kCover[] = {
    {.name = "planes", .files = {{"COVER_FILE", "cover/plane.vert"}}},
};

inline constexpr AxisValue kForm[] = {
    {.name = "loop",
     .suffix = "/loop",
     .files = {{"FORM_FILE", "segment/form/loop.glsl"},
               {"BAKED_FILE", "segment/lengths/baked.glsl"},
               {"OCTREE_WALK_FILE", "segment/skip/octree_walk.glsl"}},
     .layersPerGroup = kLoopGroup},
#define SLABCAST_UNROLLED(n, group, ends)                                                          \
    {                                                                                              \
        .name = #n " layers", .suffix = "/unroll" #n,                                              \
        .files = {{"FORM_FILE", "segment/form/unrolled.glsl"},                                     \
                  {"BAKED_FILE", ends},                                                            \
                  {"OCTREE_WALK_FILE", "segment/skip/octree_no_walk.glsl"}},                       \
        .layersWrittenOut = n, .layersPerGroup = group                                             \
    }
    SLABCAST_UNROLLED(1, 1, "segment/lengths/baked_each.glsl"),
    SLABCAST_UNROLLED(2, 2, "segment/lengths/baked_each.glsl"),
    SLABCAST_UNROLLED(4, 4, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(8, 8, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(12, 4, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(16, 8, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(24, 8, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(32, 8, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(48, 8, "segment/lengths/baked.glsl"),
    SLABCAST_UNROLLED(64, 8, "segment/lengths/baked.glsl"),
#undef SLABCAST_UNROLLED
};

template <auto field>
constexpr std::size_t valueOf(const ShaderVariant& variant) {
    return static_cast<std::size_t>(variant.*field);
}
template <auto field>
constexpr void choose(ShaderVariant& variant, std::size_t value) {
    auto& chosen = variant.*field;
    chosen = static_cast<std::remove_reference_t<decltype(chosen)>>(value);
}
template <auto field, std::size_t count>
constexpr AxisInfo axis(const char* name, const AxisValue (&values)[count]) {
    return {name, valueOf<field>, choose<field>, values, count};
}

/// The form's value is the length that is written out; one that is not listed has no place.
constexpr std::size_t formOf(const ShaderVariant& variant) {
    std::size_t place = 0;
    while (place < std::size(kForm) && kForm[place].layersWrittenOut != variant.unroll) {
        ++place;
    }
    return place;
}
constexpr void chooseForm(ShaderVariant& variant, std::size_t value) {
    variant.unroll = kForm[value].layersWrittenOut;
}

} // namespace axes

inline constexpr AxisInfo kAxes[] = {
    axes::axis<&ShaderVariant::classification>("classification", axes::kClassification),
    axes::axis<&ShaderVariant::skip>("skip", axes::kSkip),
    axes::axis<&ShaderVariant::shaded>("shading", axes::kShading),
    axes::axis<&ShaderVariant::normals>("normals", axes::kNormals),
    axes::axis<&ShaderVariant::exactField>("field", axes::kField),
    axes::axis<&ShaderVariant::material>("material", axes::kMaterial),
    axes::axis<&ShaderVariant::table>("table", axes::kTable),
    axes::axis<&ShaderVariant::lengths>("lengths", axes::kLengths),
    axes::axis<&ShaderVariant::interval>("interval", axes::kInterval),
    axes::axis<&ShaderVariant::accumulate>("accumulate", axes::kAccumulate),
    axes::axis<&ShaderVariant::terminates>("termination", axes::kTermination),
    axes::axis<&ShaderVariant::fetchesTarget>("target", axes::kTarget),
    axes::axis<&ShaderVariant::counts>("counting", axes::kCounting),
    axes::axis<&ShaderVariant::lattice>("lattice", axes::kLattice),
    axes::axis<&ShaderVariant::jittered>("jitter", axes::kJitter),
    axes::axis<&ShaderVariant::cover>("cover", axes::kCover),
    {"form", axes::formOf, axes::chooseForm, axes::kForm, std::size(axes::kForm)},
};

/// What exists only beside something else.
inline constexpr Requirement kRequirements[] = {
    // Gradients need the field; pre-classified texels hold their light, intervals have none.
    {Axis::Shading, 1, Axis::Classification, {0}},
    {Axis::Normals, 1, Axis::Shading, {1}},
    // Pre-classified texels are colours, not a field.
    {Axis::Field, 1, Axis::Classification, {0, 2}},
    // A table of single values is post-classification's; texels that are interpolated in float32
    // go with one that is, too.
    {Axis::Table, 1, Axis::Classification, {0}},
    {Axis::Table, 1, Axis::Field, {0}},
    // Means of intervals are extinctions, and layers of one length are those of shells.
    {Axis::Lengths, 1, Axis::Classification, {0, 1}},
    {Axis::Lengths, 1, Axis::Lattice, {1}},
    // What is before a segment is looked at to leave it.
    {Axis::Target, 1, Axis::Termination, {1}},
};

} // namespace slabcast
