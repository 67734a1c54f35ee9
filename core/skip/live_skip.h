#pragma once

#include <memory>
#include <optional>

#include "core/skip/built_skip.h"
#include "core/skip/grid_rebuild.h"
#include "core/skip/live_options.h"
#include "core/skip/visible_values.h"

namespace slabcast {

/// A pointer that is not copied with its owner: the copy holds null.
template <class T>
struct NotCopied : std::unique_ptr<T> {
    NotCopied() = default;
    NotCopied(const NotCopied&) : NotCopied() {}
    NotCopied(NotCopied&&) = default;
    NotCopied& operator=(const NotCopied&) { return *this = NotCopied(); }
    NotCopied& operator=(NotCopied&&) = default;
    using std::unique_ptr<T>::operator=;
};

/// The data that both structures are built from. It does not change and is shared with the scene.
struct LiveSource {
    std::shared_ptr<const TexelCodes> codes;
    std::shared_ptr<const Texels> texels; // scale and bias
    VolumeGeometry geometry;
};

/// Bytes of a rebuilt structure's texture that one frame uploads.
constexpr std::int64_t kUploadBytesPerFrame = 1 << 20;

/// Chooses the skip structure while a TF is edited. current() is exact under the last TF at any
/// moment. It is the settled structure as long as that is still exact, which is where the TF shows
/// no value that it was not built for, and as long as it skips more than the other. Otherwise it is
/// the structure that is exact under any TF; work() then rebuilds the settled one in pieces. A
/// further edit that shows other values drops an unfinished rebuilding; so does copying. No GL. Not
/// thread-safe; heavy steps use all cores inside.
/// Tested by: live_skip_test.cpp
class LiveSkip {
public:
    /// Builds the structure that is exact under any TF. `present` is the structure that the scene
    /// has under its TF; it is taken over instead of building where its options are those of
    /// either structure. Cost: O(voxels).
    /// Fails: InvalidArgument (structures that cannot serve so), and as buildSkip().
    static Result<LiveSkip> start(LiveSource source, const LiveOptions& options,
                                  CellVisibility visibility, const BuiltSkip& present);

    /// Takes another TF, given as the codes that it makes visible. Cost: O(codes), and O(blocks x
    /// partitions) where partitioned maps are merged.
    void edit(const CellVisibility& visibility);

    /// To be called once a frame. Rebuilds for about `budgetMs`: at least one slice of blocks,
    /// nothing at 0. A rebuilt structure serves after the frames that its upload takes.
    LiveProgress work(double budgetMs);

    /// A copy for each structure that may come to serve, in which it serves and the next one is
    /// being uploaded. For making all textures and shaders beforehand: the copies need not be exact
    /// under the present TF, and structures that were not built yet are empty grids.
    std::vector<LiveSkip> eachServing() const;

    const BuiltSkip& current() const { return settledServes_ ? settled_ : always_; }
    const BuiltSkip& always() const { return always_; }   // under the present TF or an earlier one
    const BuiltSkip& settled() const { return settled_; } // likewise; may not exist
    /// The rebuilt structure while its texture is being uploaded.
    const BuiltSkip& incoming() const { return incoming_; }
    /// Whether there is nothing left to rebuild under this TF.
    bool isSettled() const { return !wantsRebuild(); }
    /// Time that start() took; and the last finished rebuilding, summed over its calls of work().
    double startMs() const { return startMs_; }
    double rebuildMs() const { return rebuildMs_; }

private:
    LiveSkip() = default;

    Result<void> build(const CellVisibility& visibility, const BuiltSkip& present);
    bool wantsRebuild() const;
    std::optional<ChangedRegions> changedRegions() const;
    void beginRebuild();
    void finishRebuild();
    LiveProgress handOver();

    LiveSource source_;
    LiveOptions options_;
    std::shared_ptr<CellVisibility> visibility_; // of now
    VisibleValues shown_;                        // of now
    VisibleValues spareShown_;                   // of no use: room for the next
    BuiltSkip always_;
    BuiltSkip settled_ = noSkip();
    double settledFraction_ = 0.0; // that always_ found occupied when settled_ began to serve
    BuiltSkip incoming_ = noSkip();
    int framesToUpload_ = 0; // before it serves
    bool settledServes_ = false;
    std::shared_ptr<const OctreeLevel> ranges_; // of the settled structure's blocks
    NotCopied<GridRebuild> rebuild_;
    int framesSinceEdit_ = 0;
    double startMs_ = 0.0;
    double rebuildMs_ = 0.0;
    double rebuildSoFarMs_ = 0.0;
};

} // namespace slabcast
