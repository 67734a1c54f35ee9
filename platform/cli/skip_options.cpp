#include "platform/cli/skip_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "platform/cli/scene_options.h"

namespace slabcast {

namespace {

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
/// Edits can be skipped by it at once, or once it was rebuilt in pieces.
bool servesEdits(SkipStructure structure) {
    return isBuilt(structure) && !(isOctree(structure) && infoOf(structure).dependsOnTransfer);
}

constexpr SkipParameter kParameters[] = {
    {"--skip-block", isBuilt,
     [](const SkipOptions& o) { return std::to_string(o.blockEdgeVoxels); }},
    {"--skip-bits", isBitfield, [](const SkipOptions& o) { return std::to_string(o.bits); }},
    {"--partitions", isPartitioned,
     [](const SkipOptions& o) { return std::to_string(o.partitions); }},
    {"--separate-minimum", hasBins,
     [](const SkipOptions& o) { return wordFor(onOffWords(), o.separateMinimum); }},
    {"--value-range", hasBins,
     [](const SkipOptions& o) {
         return o.valueRange ? fmt::format("{},{}", (*o.valueRange)[0], (*o.valueRange)[1]) : "";
     }},
    {"--initial-level", isOctree,
     [](const SkipOptions& o) { return std::to_string(o.initialLevel); }},
    {"--traversal", isOctree, [](const SkipOptions& o) { return std::string(name(o.traversal)); }},
};

/// Nothing where it cannot be read.
std::optional<std::optional<std::array<double, 2>>> parseValueRange(const std::string& word) {
    const auto parts = split(word, ',');
    const auto low = parts.size() == 2 ? parseReal(parts[0]) : std::nullopt;
    const auto high = parts.size() == 2 ? parseReal(parts[1]) : std::nullopt;
    if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high) || !(*low < *high)) {
        return std::nullopt;
    }
    return std::optional<std::array<double, 2>>({*low, *high});
}

Choices<int> numbers(std::initializer_list<int> values) {
    Choices<int> words;
    for (const int value : values) {
        words.emplace_back(std::to_string(value), value);
    }
    return words;
}

/// auto, and every structure that is offered by its name.
Choices<std::optional<SkipStructure>> skipWords(bool (*isOffered)(SkipStructure)) {
    Choices<std::optional<SkipStructure>> words{{"auto", std::nullopt}};
    for (const SkipStructureInfo& info : skipStructures()) {
        if (isOffered(info.structure)) {
            words.emplace_back(info.name, info.structure);
        }
    }
    return words;
}

/// The structures that a command builds.
using Serving = std::vector<SkipStructure> (*)(const SceneOptions& options);

/// What --skip names, or what auto may take; for none the blocks that tighten planes.
std::vector<SkipStructure> servingDrawn(const SceneOptions& o) {
    const SkipStructure asked = o.settings.skip.value_or(SkipOptions{}.structure);
    return {isBuilt(asked) || !o.settings.tighten ? asked : SkipStructure::Blocks};
}

/// What serves during edits, and what follows once they have settled.
std::vector<SkipStructure> servingEdited(const SceneOptions& o) {
    const LiveOptions live = liveOptions(o);
    std::vector<SkipStructure> serving{live.always.structure};
    if (isBuilt(live.settled.structure)) {
        serving.push_back(live.settled.structure);
    }
    return serving;
}

/// As "blocks, proximity or chebyshev".
std::string namesOf(std::span<const SkipStructure> structures) {
    std::string names;
    for (std::size_t k = 0; k < structures.size(); ++k) {
        names += k == 0 ? "" : k + 1 == structures.size() ? " or " : ", ";
        names += name(structures[k]);
    }
    return names;
}

/// As "proximity", or "auto, which takes proximity".
std::string askedFor(const SceneOptions& o, std::span<const SkipStructure> serving) {
    const std::string asked = o.settings.skip ? name(*o.settings.skip) : "auto";
    const std::string taken = namesOf(serving);
    return asked == taken ? asked : fmt::format("{}, which takes {}", asked, taken);
}

/// Throws where the option was given, and nothing that serves has a use for it.
void refuseIdle(const CLI::App& command, const char* flag, bool (*isOf)(SkipStructure),
                const SceneOptions& o, std::span<const SkipStructure> serving) {
    const CLI::Option* option = command.get_option_no_throw(flag);
    if (option == nullptr || option->count() == 0 ||
        std::any_of(serving.begin(), serving.end(), isOf)) {
        return;
    }
    std::vector<SkipStructure> owners;
    for (const SkipStructureInfo& info : skipStructures()) {
        if (isOf(info.structure)) {
            owners.push_back(info.structure);
        }
    }
    throw CLI::ValidationError(
        flag, fmt::format("is of {}; --skip is {}", namesOf(owners), askedFor(o, serving)));
}

/// Throws where a structure that serves does not offer it.
void refuseBlockEdge(const SceneOptions& o, std::span<const SkipStructure> serving) {
    const int edge = o.skip.blockEdgeVoxels;
    for (const SkipStructure structure : serving) {
        const std::span<const int> offered = infoOf(structure).edges;
        if (isBuilt(structure) &&
            std::find(offered.begin(), offered.end(), edge) == offered.end()) {
            throw CLI::ValidationError("--skip-block",
                                       fmt::format("'{}' is not one of {}, as {} takes; --skip is "
                                                   "{}",
                                                   edge, fmt::join(offered, ", "), name(structure),
                                                   askedFor(o, serving)));
        }
    }
}

void bindOctree(CLI::App& command, SkipOptions& o) {
    addNumber(command, "--initial-level", o.initialLevel, 0, 12,
              "levels from an octree's root that are left out")
        ->type_name("0..12")
        ->default_str(std::to_string(o.initialLevel))
        ->group(kLayersGroup);
    addChoice(
        command, "--traversal", o.traversal,
        {{"bidirectional", Traversal::Bidirectional}, {"top-down", Traversal::TopDown}},
        "whether an octree's tests go on at the level of the last, or begin at the initial one")
        ->group(kLayersGroup);
}

void bindBins(CLI::App& command, SkipOptions& o) {
    addChoice(command, "--skip-bits", o.bits, numbers({8, 16, 32, 64, 128}),
              "bits per node of a bitfield octree")
        ->group(kLayersGroup);
    addChoice(command, "--partitions", o.partitions, numbers({16, 32, 64, 128, 256}),
              "ranges of values that partitioned maps tell apart")
        ->group(kLayersGroup);
    addChoice(command, "--separate-minimum", o.separateMinimum, onOffWords(),
              "whether the least value has a bin or partition of its own")
        ->group(kLayersGroup);
    addParsed<std::optional<std::array<double, 2>>>(
        command, "--value-range", o.valueRange, parseValueRange, "two values, the lower one first",
        "values between which bins and partitions are laid; all of the data's unless given")
        ->type_name("LOW,HIGH")
        ->group(kLayersGroup);
}

void bindBuilder(CLI::App& command, SceneOptions& o) {
    addChoice(command, "--skip-builder", o.skipBuilder,
              {{"auto", SkipBuilder::Auto}, {"cpu", SkipBuilder::Cpu}, {"gpu", SkipBuilder::Gpu}},
              "where it is built, with the same result; auto: on the GPU unless that is software")
        ->group(kLayersGroup);
}

void bindStructures(CLI::App& command, SceneOptions& o, bool (*isOffered)(SkipStructure),
                    Serving serving) {
    const auto words = skipWords(isOffered);
    addChoice(command, "--skip", o.settings.skip, words,
              fmt::format("how empty space is skipped: {}; never changes the picture; auto goes by "
                          "what is visible",
                          wordsOf(words, ", ")))
        ->type_name("NAME")
        ->group(kLayersGroup);
    addChoice(command, "--skip-block", o.skip.blockEdgeVoxels, numbers({1, 2, 4, 8, 16, 32, 64}),
              "edge in voxels of the skip structure's blocks, or of an octree's leaves")
        ->group(kLayersGroup);
    bindBins(command, o.skip);
    bindOctree(command, o.skip);
    // Comes before the final callback, which commands have for what is theirs.
    command.parse_complete_callback([&command, &o, serving] {
        const std::vector<SkipStructure> structures = serving(o);
        for (const SkipParameter& parameter : kParameters) {
            refuseIdle(command, parameter.flag, parameter.isOf, o, structures);
        }
        refuseIdle(command, "--skip-builder", isBuilt, o, structures);
        refuseBlockEdge(o, structures);
    });
}

} // namespace

std::span<const SkipParameter> skipParameters() {
    return kParameters;
}

LiveOptions liveOptions(const SceneOptions& o) {
    LiveOptions live;
    const auto asked = [&](SkipStructure structure) {
        SkipOptions skip = o.skip;
        skip.structure = structure;
        return skip;
    };
    const SkipStructure named = o.settings.skip.value_or(live.settled.structure);
    const bool dependsOnTransfer = infoOf(named).dependsOnTransfer;
    live.always = asked(dependsOnTransfer ? live.always.structure : named);
    live.settled = asked(dependsOnTransfer ? named : SkipStructure::None);
    return live;
}

void bindSkipping(CLI::App& command, SceneOptions& o) {
    bindBuilder(command, o);
    bindStructures(
        command, o, [](SkipStructure) { return true; }, servingDrawn);
}

void bindLiveSkipping(CLI::App& command, SceneOptions& o) {
    bindStructures(command, o, servesEdits, servingEdited);
}

std::string describe(const BuiltSkip& skip) {
    std::string parameters;
    for (const SkipParameter& parameter : kParameters) {
        const std::string word = parameter.word(skip.options);
        if (parameter.isOf(skip.options.structure) && !word.empty()) {
            parameters += fmt::format(" {} {}", parameter.flag, word);
        }
    }
    constexpr double kMib = 1048576.0;
    return fmt::format("{}{}, built on the {} in {:.3g} ms, {:.3g} MiB on the GPU; {}{:.3g} % of "
                       "its {} are occupied under this transfer function",
                       name(skip.options.structure), parameters, skip.onGpu ? "GPU" : "CPU",
                       skip.buildMs, static_cast<double>(gpuBytes(skip)) / kMib,
                       skip.octree ? "at most " : "", 100.0 * skip.occupiedFraction,
                       skip.octree ? "leaves" : "blocks");
}

} // namespace slabcast
