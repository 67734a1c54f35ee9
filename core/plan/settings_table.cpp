#include "core/plan/settings_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "core/base/number_text.h"

namespace slabcast {

namespace {

// Words of choices, in the order of their enumerations.
constexpr const char* kOffOn[] = {"off", "on"};
constexpr const char* kClassifications[] = {"post", "preclassified", "preintegrated"};
constexpr const char* kTargets[] = {"rgba8", "rgba16f"};
constexpr const char* kSpaces[] = {"display", "linear"};
constexpr const char* kShades[] = {"off", "phong"};
constexpr const char* kNormals[] = {"computed", "baked"};
constexpr const char* kLattices[] = {"planar", "shells"};
constexpr const char* kForms[] = {"auto", "unrolled", "loop"};
constexpr const char* kOrders[] = {"back-to-front", "front-to-back"};
constexpr const char* kBuilders[] = {"auto", "cpu", "gpu"};
constexpr const char* kTraversals[] = {"bidirectional", "top-down"};
constexpr const char* kStructures[] = {"none",          "blocks",         "proximity",
                                       "chebyshev",     "partitioned",    "boolean-octree",
                                       "minmax-octree", "bitfield-octree"};

constexpr int kEdges[] = {1, 2, 4, 8, 16, 32, 64};
constexpr int kBits[] = {8, 16, 32, 64, 128};
constexpr int kPartitions[] = {16, 32, 64, 128, 256};

constexpr const char* kLook = "Look";
constexpr const char* kLayers = "Layers and planes";
constexpr const char* kSkipping = "Skipping empty space";

constexpr double kMib = 1048576.0;

bool isBuilt(SkipStructure structure) {
    return structure != SkipStructure::None;
}
bool isPartitioned(SkipStructure structure) {
    return structure == SkipStructure::Partitioned;
}
bool isBitfield(SkipStructure structure) {
    return structure == SkipStructure::BitfieldOctree;
}
bool hasBins(SkipStructure structure) {
    return isPartitioned(structure) || isBitfield(structure);
}

template <class T>
struct Packing {
    static SettingValue pack(const T& value) { return {1, {static_cast<double>(value), 0.0}}; }
    static void unpack(T& value, const SettingValue& from) {
        value = static_cast<T>(from.numbers[0]);
    }
};
template <>
struct Packing<bool> {
    static SettingValue pack(bool value) { return {1, {value ? 1.0 : 0.0, 0.0}}; }
    static void unpack(bool& value, const SettingValue& from) { value = from.numbers[0] != 0.0; }
};
template <>
struct Packing<std::array<double, 2>> {
    static SettingValue pack(const std::array<double, 2>& value) { return {2, value}; }
    static void unpack(std::array<double, 2>& value, const SettingValue& from) {
        value = from.numbers;
    }
};
template <class T>
struct Packing<std::optional<T>> {
    static SettingValue pack(const std::optional<T>& value) {
        return value ? Packing<T>::pack(*value) : SettingValue{};
    }
    static void unpack(std::optional<T>& value, const SettingValue& from) {
        value.reset();
        if (from.count > 0) {
            Packing<T>::unpack(value.emplace(), from);
        }
    }
};

/// Completes an entry with how its member is read and written. `Member` names it.
template <class Member>
constexpr Setting of(Setting entry, Member) {
    entry.read = [](const Settings& settings) {
        const auto& member = Member{}(settings);
        return Packing<std::remove_cvref_t<decltype(member)>>::pack(member);
    };
    entry.write = [](Settings& settings, const SettingValue& value) {
        auto& member = Member{}(settings);
        Packing<std::remove_cvref_t<decltype(member)>>::unpack(member, value);
    };
    return entry;
}

// One macro, since a member can be named by no other means that serves const and not const alike.
#define SLABCAST_MEMBER(path)                                                                      \
    [](auto& settings) -> auto& {                                                                  \
        return settings.path;                                                                      \
    }

constexpr Setting kTable[] = {
    of({.name = "classify",
        .group = kLook,
        .kind = SettingKind::Choice,
        .words = kClassifications,
        .help = "colours looked up after filtering voxels, filtered themselves, or integrated over "
                "each layer beforehand"},
       SLABCAST_MEMBER(classification)),
    of({.name = "target",
        .group = kLook,
        .kind = SettingKind::Choice,
        .words = kTargets,
        .help = "what planes are blended into"},
       SLABCAST_MEMBER(target)),
    of({.name = "space",
        .group = kLook,
        .kind = SettingKind::Choice,
        .words = kSpaces,
        .help = "blend encoded values as most viewers do, or light"},
       SLABCAST_MEMBER(space)),
    of({.name = "shade",
        .group = kLook,
        .kind = SettingKind::Choice,
        .words = kShades,
        .help = "Blinn-Phong with a head light"},
       SLABCAST_MEMBER(shaded)),
    of({.name = "normals",
        .group = kLook,
        .kind = SettingKind::Choice,
        .words = kNormals,
        .help = "of shaded samples: from six samples around each, or from one of a texture that is "
                "baked beforehand, 4 bytes a voxel"},
       SLABCAST_MEMBER(normals)),
    of({.name = "layer-spacing",
        .group = kLayers,
        .kind = SettingKind::Real,
        .low = 0.001,
        .high = 1e6,
        .unit = "voxels",
        .help = "distance of layers in units of the smallest voxel edge"},
       SLABCAST_MEMBER(layerSpacingVoxels)),
    of({.name = "layers",
        .group = kLayers,
        .kind = SettingKind::Whole,
        .low = 1,
        .high = kMaxTotalLayers,
        .unset = "auto",
        .excludes = "layer-spacing",
        .help = "layers in all, instead of their distance; auto goes by that"},
       SLABCAST_MEMBER(totalLayers)),
    of({.name = "planes",
        .group = kLayers,
        .kind = SettingKind::Whole,
        .low = 1,
        .high = kMaxTotalLayers,
        .unset = "auto",
        .excludes = "layers-per-plane",
        .help =
            "proxy planes: 1 is ray casting, as many as layers is slicing; auto goes by device, "
            "or by what was measured there"},
       SLABCAST_MEMBER(planes)),
    of({.name = "layers-per-plane",
        .group = kLayers,
        .kind = SettingKind::Whole,
        .low = 1,
        .high = kMaxTotalLayers,
        .unset = "auto",
        .excludes = "planes",
        .help = "1 is slicing, more than there are is ray casting; auto goes by device, or by what "
                "was measured there"},
       SLABCAST_MEMBER(layersPerPlane)),
    of({.name = "lattice",
        .group = kLayers,
        .kind = SettingKind::Choice,
        .words = kLattices,
        .unset = "auto",
        .help = "layers at equal depth, or at equal distance from the eye; auto goes by device"},
       SLABCAST_MEMBER(lattice)),
    of({.name = "jitter",
        .group = kLayers,
        .kind = SettingKind::Choice,
        .words = kOffOn,
        .help = "move every ray's layers by up to half a layer: grain where few layers would band"},
       SLABCAST_MEMBER(jitter)),
    of({.name = "form",
        .group = kLayers,
        .kind = SettingKind::Choice,
        .words = kForms,
        .help = "segments written out layer by layer, or as a loop; auto goes by device and "
                "length"},
       SLABCAST_MEMBER(form)),
    of({.name = "order",
        .group = kLayers,
        .kind = SettingKind::Choice,
        .words = kOrders,
        .unset = "auto",
        .help = "planes over each other, or nearest first, which leaves out what is behind opaque "
                "material; auto goes by how soon a ray can be opaque"},
       SLABCAST_MEMBER(order)),
    of({.name = "tighten",
        .group = kLayers,
        .kind = SettingKind::Choice,
        .words = kOffOn,
        .help = "planes as rectangles around what is visible in their slab, or the sphere's "
                "10-gons"},
       SLABCAST_MEMBER(tighten)),
    of({.name = "termination",
        .group = kLayers,
        .kind = SettingKind::Real,
        .low = 1e-6,
        .high = 1.0,
        .unset = "off",
        .help = "opacity at which a segment is left and, front to back, a ray: the picture lacks "
                "at most what it lacks of 1"},
       SLABCAST_MEMBER(termination)),
    of({.name = "skip",
        .group = kSkipping,
        .kind = SettingKind::Choice,
        .words = kStructures,
        .unset = "auto",
        .help = "how empty space is skipped; never changes the picture; auto goes by what is "
                "visible"},
       SLABCAST_MEMBER(skip)),
    of({.name = "skip-builder",
        .group = kSkipping,
        .kind = SettingKind::Choice,
        .words = kBuilders,
        .usedBy = isBuilt,
        .help = "where the structure is built, with the same result; auto: on the GPU unless that "
                "is software"},
       SLABCAST_MEMBER(skipBuilder)),
    of({.name = "skip-block",
        .group = kSkipping,
        .kind = SettingKind::Whole,
        .offered = kEdges,
        .unit = "voxels",
        .usedBy = isBuilt,
        .help = "edge of the structure's blocks, or of an octree's leaves"},
       SLABCAST_MEMBER(skipOptions.blockEdgeVoxels)),
    of({.name = "skip-bits",
        .group = kSkipping,
        .kind = SettingKind::Whole,
        .offered = kBits,
        .usedBy = isBitfield,
        .help = "bits per node of a bitfield octree"},
       SLABCAST_MEMBER(skipOptions.bits)),
    of({.name = "partitions",
        .group = kSkipping,
        .kind = SettingKind::Whole,
        .offered = kPartitions,
        .usedBy = isPartitioned,
        .help = "ranges of values that partitioned maps tell apart"},
       SLABCAST_MEMBER(skipOptions.partitions)),
    of({.name = "separate-minimum",
        .group = kSkipping,
        .kind = SettingKind::Choice,
        .words = kOffOn,
        .usedBy = hasBins,
        .help = "whether the least value has a bin or partition of its own"},
       SLABCAST_MEMBER(skipOptions.separateMinimum)),
    of({.name = "value-range",
        .group = kSkipping,
        .kind = SettingKind::Range,
        .low = -3e38,
        .high = 3e38,
        .unset = "auto",
        .usedBy = hasBins,
        .help = "data values between which bins and partitions are laid; auto: all of the data's"},
       SLABCAST_MEMBER(skipOptions.valueRange)),
    of({.name = "initial-level",
        .group = kSkipping,
        .kind = SettingKind::Whole,
        .low = 0,
        .high = 12,
        .usedBy = isOctree,
        .help = "levels from an octree's root that are left out"},
       SLABCAST_MEMBER(skipOptions.initialLevel)),
    of({.name = "traversal",
        .group = kSkipping,
        .kind = SettingKind::Choice,
        .words = kTraversals,
        .usedBy = isOctree,
        .help = "whether an octree's tests go on at the level of the last, or begin at the initial "
                "one"},
       SLABCAST_MEMBER(skipOptions.traversal)),
    {.name = "partition-budget",
     .group = kSkipping,
     .kind = SettingKind::Real,
     .low = 0.001,
     .high = 1e6,
     .unit = "MiB",
     .usedBy = isPartitioned,
     .help = "partitioned maps that take more memory are refused, and named",
     .read = [](const Settings& s) -> SettingValue {
         // To a millionth: about a byte.
         const double mib = static_cast<double>(s.skipOptions.memoryBudgetBytes) / kMib;
         return {1, {std::round(mib * 1e6) / 1e6, 0.0}};
     },
     .write =
         [](Settings& s, const SettingValue& value) {
             s.skipOptions.memoryBudgetBytes =
                 static_cast<std::int64_t>(std::llround(value.numbers[0] * kMib));
         }},
};

#undef SLABCAST_MEMBER

std::string listed(std::string all, std::span<const char* const> words) {
    for (const char* word : words) {
        all += (word == words.front() ? " " : ", ") + std::string(word);
    }
    return all;
}

std::optional<SettingValue> rangeOf(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) {
        return std::nullopt;
    }
    const auto low = numberFrom(text.substr(0, comma));
    const auto high = numberFrom(text.substr(comma + 1));
    return low && high ? std::optional(SettingValue{2, {*low, *high}}) : std::nullopt;
}

/// What the text says, in range or not.
std::optional<SettingValue> valueOf(const Setting& setting, std::string_view text) {
    if (setting.unset != nullptr && text == setting.unset) {
        return SettingValue{};
    }
    if (setting.kind == SettingKind::Range) {
        return rangeOf(text);
    }
    if (setting.kind == SettingKind::Choice) {
        const auto& words = setting.words;
        const auto word = std::find(words.begin(), words.end(), text);
        const auto index = static_cast<double>(word - words.begin());
        return word == words.end() ? std::nullopt : std::optional(SettingValue{1, {index, 0.0}});
    }
    const std::optional<double> number = numberFrom(text);
    return number ? std::optional(SettingValue{1, {*number, 0.0}}) : std::nullopt;
}

} // namespace

bool Setting::takes(const SettingValue& value) const {
    const auto inRange = [this](double number) { return number >= low && number <= high; };
    const double first = value.numbers[0];
    if (value.count == 0) {
        return unset != nullptr;
    }
    switch (kind) {
    case SettingKind::Choice:
        return first >= 0.0 && first < static_cast<double>(words.size());
    case SettingKind::Range:
        return first < value.numbers[1] && inRange(first) && inRange(value.numbers[1]);
    case SettingKind::Whole:
        return offered.empty() ? first == std::floor(first) && inRange(first)
                               : std::find(offered.begin(), offered.end(), first) != offered.end();
    case SettingKind::Real:
        break;
    }
    return inRange(first);
}

std::string Setting::allowed() const {
    const std::string orUnset = unset == nullptr ? "" : std::string(", or ") + unset;
    if (kind == SettingKind::Choice) {
        return listed(unset == nullptr ? "one of" : std::string("one of ") + unset + ",", words);
    }
    if (kind == SettingKind::Range) {
        return "two numbers with a comma between, the lower one first" + orUnset;
    }
    if (!offered.empty()) {
        std::string all = "one of ";
        for (const int value : offered) {
            all += (value == offered.front() ? "" : ", ") + std::to_string(value);
        }
        return all + orUnset;
    }
    return (kind == SettingKind::Whole ? "a whole number from " : "a number from ") +
           numberText(low) + " to " + numberText(high) + orUnset;
}

Result<SettingValue> Setting::parse(std::string_view text) const {
    const std::optional<SettingValue> value = valueOf(*this, text);
    if (!value || !takes(*value)) {
        return fail(ErrorCode::InvalidArgument,
                    std::string(name) + ": '" + std::string(text) + "' is not " + allowed());
    }
    return *value;
}

std::string Setting::text(const SettingValue& value) const {
    if (value.count == 0) {
        return unset == nullptr ? "" : unset;
    }
    if (kind == SettingKind::Choice && takes(value)) {
        return words[static_cast<std::size_t>(value.numbers[0])];
    }
    const std::string first = numberText(value.numbers[0]);
    return value.count == 1 ? first : first + "," + numberText(value.numbers[1]);
}

bool Setting::isNumber(const SettingValue& value) const {
    return value.count == 1 && (kind == SettingKind::Whole || kind == SettingKind::Real);
}

std::span<const Setting> settingsTable() {
    return kTable;
}

const Setting* findSetting(std::string_view name) {
    const auto found = std::find_if(std::begin(kTable), std::end(kTable),
                                    [&](const Setting& setting) { return setting.name == name; });
    return found == std::end(kTable) ? nullptr : found;
}

Result<void> set(Settings& settings, std::string_view name, std::string_view text) {
    const Setting* setting = findSetting(name);
    if (setting == nullptr) {
        return fail(ErrorCode::InvalidArgument,
                    "there is no setting '" + std::string(name) + "': see docs/settings.md");
    }
    return setting->parse(text).map(
        [&](const SettingValue& value) { setting->write(settings, value); });
}

std::string get(const Settings& settings, std::string_view name) {
    const Setting* setting = findSetting(name);
    SLABCAST_EXPECTS(setting != nullptr, name.size());
    return setting->text(setting->read(settings));
}

} // namespace slabcast
