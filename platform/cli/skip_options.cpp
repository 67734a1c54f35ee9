#include "platform/cli/skip_options.h"

#include <algorithm>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "platform/cli/settings_options.h"

namespace slabcast {

namespace {

bool isBuilt(SkipStructure structure) {
    return structure != SkipStructure::None;
}
/// Edits can be skipped by it at once, or once it was rebuilt in pieces.
bool servesEdits(SkipStructure structure) {
    return isBuilt(structure) && !(isOctree(structure) && infoOf(structure).dependsOnTransfer);
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

/// Refuses an option that was given, and that nothing that serves has a use for.
Result<void> refuseIdle(const Setting& setting, const SceneOptions& o,
                        std::span<const SkipStructure> serving) {
    if (std::any_of(serving.begin(), serving.end(), setting.usedBy)) {
        return {};
    }
    std::vector<SkipStructure> owners;
    for (const SkipStructureInfo& info : skipStructures()) {
        if (setting.usedBy(info.structure)) {
            owners.push_back(info.structure);
        }
    }
    return fail(ErrorCode::InvalidArgument,
                fmt::format("{}: is of {}; --skip is {}", flagOf(setting), namesOf(owners),
                            askedFor(o, serving)));
}

/// Refuses a block edge that a structure that serves does not offer.
Result<void> refuseBlockEdge(const SceneOptions& o, std::span<const SkipStructure> serving) {
    const int edge = o.settings.skipOptions.blockEdgeVoxels;
    for (const SkipStructure structure : serving) {
        const std::span<const int> offered = infoOf(structure).edges;
        if (isBuilt(structure) &&
            std::find(offered.begin(), offered.end(), edge) == offered.end()) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("--skip-block: '{}' is not one of {}, as {} takes; --skip is "
                                    "{}",
                                    edge, fmt::join(offered, ", "), name(structure),
                                    askedFor(o, serving)));
        }
    }
    return {};
}

Result<void> checkServing(const SceneOptions& o, std::span<const SkipStructure> serving,
                          const Given& given) {
    for (const Setting& setting : settingsTable()) {
        if (setting.usedBy != nullptr && given(flagOf(setting))) {
            if (Result<void> used = refuseIdle(setting, o, serving); !used) {
                return used;
            }
        }
    }
    return refuseBlockEdge(o, serving);
}

} // namespace

LiveOptions liveOptions(const SceneOptions& o) {
    LiveOptions live;
    const auto asked = [&](SkipStructure structure) {
        SkipOptions skip = o.settings.skipOptions;
        skip.structure = structure;
        return skip;
    };
    const SkipStructure named = o.settings.skip.value_or(live.settled.structure);
    const bool dependsOnTransfer = infoOf(named).dependsOnTransfer;
    live.always = asked(dependsOnTransfer ? live.always.structure : named);
    live.settled = asked(dependsOnTransfer ? named : SkipStructure::None);
    return live;
}

void checkSkipping(Command& command, const SceneOptions& o) {
    command.checks.emplace_back(
        [&o](const Given& given) { return checkServing(o, servingDrawn(o), given); });
}

void bindLiveSkipping(Command& command, SceneOptions& o) {
    const auto words = skipWords(servesEdits);
    addChoice(command,
              {.flag = "--skip",
               .help = fmt::format("how empty space is skipped: {}; never changes the picture; "
                                   "auto takes what this device is best served by",
                                   wordsOf(words, ", ")),
               .group = findSetting("skip")->group},
              o.settings.skip, words)
        .word = "NAME";
    command.checks.emplace_back(
        [&o](const Given& given) { return checkServing(o, servingEdited(o), given); });
}

std::vector<const Setting*> parametersOf(SkipStructure structure) {
    std::vector<const Setting*> parameters;
    for (const Setting& setting : settingsTable()) {
        const std::string_view name = setting.name;
        const bool elsewhere = name == "skip-builder" || name == "partition-budget";
        if (!elsewhere && setting.usedBy != nullptr && setting.usedBy(structure)) {
            parameters.push_back(&setting);
        }
    }
    return parameters;
}

std::string describe(const BuiltSkip& skip) {
    const Settings settings{.skipOptions = skip.options};
    std::string parameters;
    for (const Setting* setting : parametersOf(skip.options.structure)) {
        if (setting->read(settings).count > 0) {
            parameters += fmt::format(" {} {}", flagOf(*setting), get(settings, setting->name));
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
