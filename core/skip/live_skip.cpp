#include "core/skip/live_skip.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/stopwatch.h"
#include "core/skip/minmax_octree.h"
#include "core/skip/occupancy.h"
#include "core/skip/skip_layout.h"

namespace slabcast {

namespace {

using Clock = GridRebuild::Clock;

/// Cubes of 8^3 blocks: one is as much work as a slice of a small grid.
constexpr int kRegionLevel = 3;

/// The settled structure stays for a TF that shows less, down to this share of the occupied blocks
/// that it was built for. Below, an octree skips more, though it takes a third longer per block.
constexpr double kTightEnough = 0.75;

bool hasStructure(const SkipOptions& options) {
    return options.structure != SkipStructure::None;
}

Result<void> checkServes(const LiveOptions& o) {
    if (!hasStructure(o.always) || infoOf(o.always.structure).dependsOnTransfer) {
        return fail(ErrorCode::InvalidArgument,
                    std::string("editing needs a structure that is right under every transfer "
                                "function, which ") +
                        name(o.always.structure) +
                        " is not: take bitfield-octree, minmax-octree or partitioned");
    }
    const SkipStructure settled = o.settled.structure;
    if (settled != SkipStructure::None && settled != SkipStructure::Blocks &&
        settled != SkipStructure::Proximity && settled != SkipStructure::Chebyshev) {
        return fail(ErrorCode::InvalidArgument,
                    std::string("editing needs a structure that is rebuilt in pieces when edits "
                                "pause, which ") +
                        name(settled) + " is not: take proximity, chebyshev, blocks or none");
    }
    return check(o.always).and_then([&] { return check(o.settled); });
}

/// The level of the octree whose nodes are blocks of this edge, or -1.
int levelOfEdge(int leafEdge, int levels, int blockEdge) {
    for (int level = 0; level < levels; ++level) {
        if (leafEdge << level == blockEdge) {
            return level;
        }
    }
    return -1;
}

/// Ranges of the blocks, from the octree where it has them: a block grown by one voxel is the union
/// of its leaves grown by one.
Result<OctreeLevel> rangesOf(const Octree* minMax, const TexelCodes& codes, int blockEdge) {
    const int level = minMax == nullptr ? -1
                                        : levelOfEdge(minMax->leafEdgeVoxels,
                                                      int(minMax->levels.size()), blockEdge);
    return level < 0 ? blockRanges(codes, blockEdge) : minMax->levels[level];
}

} // namespace

const char* name(LiveProgress progress) {
    constexpr const char* kNames[] = {"settled", "waiting", "building", "incoming", "swapped"};
    return kNames[static_cast<std::size_t>(progress)];
}

Result<LiveSkip> LiveSkip::start(LiveSource source, const LiveOptions& options,
                                 CellVisibility visibility, const BuiltSkip& present) {
    if (Result<void> ok = checkServes(options); !ok) {
        return tl::unexpected(ok.error());
    }
    const Stopwatch watch;
    LiveSkip live;
    live.source_ = std::move(source);
    live.options_ = options;
    if (Result<void> built = live.build(visibility, present); !built) {
        return tl::unexpected(built.error());
    }
    if (live.always_.octree) {
        live.always_ = underTransfer(live.always_, visibility); // counts as edits will
    }
    live.shown_ = visibleValues(visibility);
    live.visibility_ = std::make_shared<CellVisibility>(std::move(visibility));
    if (hasStructure(options.settled) && present.options == options.settled) {
        live.settled_ = present;
        live.settledFraction_ = live.always_.occupiedFraction;
        live.settledServes_ = true;
    }
    live.startMs_ = watch.ms();
    return live;
}

Result<void> LiveSkip::build(const CellVisibility& visibility, const BuiltSkip& present) {
    std::optional<Octree> minMax;
    if (present.options == options_.always) {
        always_ = present;
    } else {
        if (isOctree(options_.always.structure)) {
            Result<Octree> built = buildMinMaxOctree(*source_.codes, options_.always);
            if (!built) {
                return tl::unexpected(built.error());
            }
            minMax = std::move(*built);
        }
        Result<BuiltSkip> built = buildSkip({*source_.codes, *source_.texels, visibility,
                                             source_.geometry, minMax ? &*minMax : nullptr},
                                            options_.always);
        if (!built) {
            return tl::unexpected(built.error());
        }
        always_ = std::move(*built);
    }
    if (!hasStructure(options_.settled)) {
        return {};
    }
    return rangesOf(minMax ? &*minMax : nullptr, *source_.codes, options_.settled.blockEdgeVoxels)
        .map([&](OctreeLevel&& ranges) {
            ranges_ = std::make_shared<const OctreeLevel>(std::move(ranges));
        });
}

void LiveSkip::edit(const CellVisibility& visibility) {
    findVisibleValues(visibility, spareShown_);
    if (spareShown_ == shown_) {
        return; // other colours: what is begun goes on
    }
    std::swap(shown_, spareShown_);
    rebuild_.reset();
    incoming_ = noSkip();
    framesSinceEdit_ = 0;
    if (visibility_.use_count() == 1) {
        *visibility_ = visibility; // into what is allocated
    } else {
        visibility_ = std::make_shared<CellVisibility>(visibility);
    }
    settledServes_ = settled_.exists() && settled_.shown == shown_;
    if (settledServes_) {
        return;
    }
    always_ = underTransfer(std::move(always_), *visibility_);
    // What was free then is free now.
    settledServes_ = settled_.exists() && covers(settled_.shown, shown_) &&
                     always_.occupiedFraction >= kTightEnough * settledFraction_;
}

std::vector<LiveSkip> LiveSkip::eachServing() const {
    std::vector<LiveSkip> each{*this};
    each[0].settledServes_ = false;
    if (hasStructure(options_.settled)) {
        const auto empty = std::make_shared<const FreeLengths>(
            FreeLengths{.blocks = ranges_->nodes,
                        .blockEdgeVoxels = options_.settled.blockEdgeVoxels,
                        .counts = std::vector<std::uint8_t>(ranges_->words.size(), 255)});
        each.push_back(*this);
        LiveSkip& other = each.back();
        other.settledServes_ = true;
        other.incoming_ = builtSkip(options_.settled, empty, VisibleValues());
        if (!settled_.exists()) {
            other.settled_ = builtSkip(options_.settled, empty, VisibleValues());
        }
    }
    return each;
}

bool LiveSkip::wantsRebuild() const {
    return hasStructure(options_.settled) && (!settled_.exists() || settled_.shown != shown_);
}

/// Where the octree shows that fewer blocks can have changed than there are. A block that two TFs
/// show differently has one of the changed codes between its least and its greatest, and so does
/// every node above it.
std::optional<ChangedRegions> LiveSkip::changedRegions() const {
    const Octree* octree = always_.octree.get();
    if (!settled_.exists() || octree == nullptr ||
        octree->leafEdgeVoxels != options_.settled.blockEdgeVoxels) {
        return std::nullopt;
    }
    NodeTest changed;
    if (octree->content == NodeContent::Bits) {
        const BinSet bins = changedBins(*always_.bins, settled_.shown, shown_);
        changed.words = {bins[0], bins[1], bins[2], bins[3]};
    } else {
        const std::optional<CodeRange> codes = changedCodes(settled_.shown, shown_);
        SLABCAST_EXPECTS(codes.has_value(), options_.settled.blockEdgeVoxels);
        changed.words = {codes->least, codes->most, 0, 0};
    }
    const int level = std::min(kRegionLevel, octree->coarsest());
    ChangedRegions regions{level, visibleNodes(*octree, changed, level)};
    const glm::ivec3 all = octree->levels[level].nodes;
    // A block costs the same either way; the others have to be copied, at a fraction of that.
    const bool fewer = 4 * regions.cubes.size() < 3 * std::size_t(all.x) * all.y * all.z;
    return fewer ? std::optional(std::move(regions)) : std::nullopt;
}

void LiveSkip::beginRebuild() {
    rebuildSoFarMs_ = 0.0;
    const GridSource source{options_.settled.structure, options_.settled.blockEdgeVoxels,
                            source_.geometry, ranges_};
    rebuild_ = std::make_unique<GridRebuild>(source, visibility_,
                                             EarlierGrid{settled_.lengths, changedRegions()});
}

void LiveSkip::finishRebuild() {
    const std::shared_ptr<const FreeLengths> grid = rebuild_->finish();
    rebuild_.reset();
    rebuildMs_ = rebuildSoFarMs_;
    if (grid == settled_.lengths) { // and its texture is there
        incoming_ = settled_;
        incoming_.shown = shown_;
        framesToUpload_ = 0;
    } else {
        incoming_ = builtSkip(options_.settled, grid, shown_);
        framesToUpload_ = (grid->blocks.z - 1) / slicesWithin(kUploadBytesPerFrame, grid->blocks);
    }
    incoming_.buildMs = rebuildMs_;
}

LiveProgress LiveSkip::handOver() {
    if (framesToUpload_ > 0) {
        --framesToUpload_;
        return LiveProgress::Incoming;
    }
    settled_ = std::exchange(incoming_, noSkip());
    settledFraction_ = always_.occupiedFraction;
    settledServes_ = true;
    return LiveProgress::Swapped;
}

LiveProgress LiveSkip::work(double budgetMs) {
    if (!wantsRebuild()) {
        return LiveProgress::Settled;
    }
    if (framesSinceEdit_ < options_.quietFrames) {
        ++framesSinceEdit_;
        return LiveProgress::Waiting;
    }
    if (!(budgetMs > 0.0)) {
        return LiveProgress::Waiting;
    }
    if (incoming_.exists()) {
        return handOver();
    }
    const Stopwatch watch;
    const std::chrono::duration<double, std::milli> budget(std::min(budgetMs, 1e9));
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(budget);
    if (!rebuild_) {
        beginRebuild();
    }
    const bool done = rebuild_->work(deadline);
    rebuildSoFarMs_ += watch.ms();
    if (!done) {
        return LiveProgress::Building;
    }
    finishRebuild();
    return handOver();
}

} // namespace slabcast
