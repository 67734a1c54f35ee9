#pragma once

#include <memory>
#include <optional>

#include "core/skip/built_skip.h"
#include "core/skip/grid_rebuild.h"
#include "core/skip/visible_values.h"

namespace slabcast {

/// What a copy of its owner begins without.
template <class T>
struct NotCopied : std::unique_ptr<T> {
    NotCopied() = default;
    NotCopied(const NotCopied&) : NotCopied() {}
    NotCopied(NotCopied&&) = default;
    NotCopied& operator=(const NotCopied&) { return *this = NotCopied(); }
    NotCopied& operator=(NotCopied&&) = default;
    using std::unique_ptr<T>::operator=;
};

/// How empty space is skipped while a TF is edited.
struct LiveOptions {
    /// Right under any TF at once: an octree of bits or ranges, or partitioned maps.
    SkipOptions always{.structure = SkipStructure::BitfieldOctree};
    /// Faster, and for one TF: proximity, chebyshev or blocks. None: never built.
    SkipOptions settled{.structure = SkipStructure::Proximity};
    /// Calls of work() after an edit that do nothing. A hand that drags edits in every frame or
    /// two: what is begun in between is thrown away. After three it has come to rest, for 50 ms at
    /// 60 Hz, and what one waits for then is the rebuilding.
    int quietFrames = 3;
};

/// What structures are built from: immutable, shared with whoever made it.
struct LiveSource {
    std::shared_ptr<const TexelCodes> codes;
    std::shared_ptr<const Texels> texels; // scale and bias
    VolumeGeometry geometry;
};

enum class LiveProgress : std::uint8_t {
    Settled,  // nothing to do: the structure is the TF's own
    Waiting,  // for the hand to come to rest, or for a budget
    Building, // the settled structure is in the making
    Incoming, // it is finished, and its texture is being filled
    Swapped,  // it serves from this call on
};

const char* name(LiveProgress progress);

/// Of a finished structure's texture, for one frame to upload.
constexpr std::int64_t kUploadBytesPerFrame = 1 << 20;

/// Which structure serves while a TF changes again and again. At any moment current() is exact
/// under the last TF: the settled structure where the TF shows nothing that it was not built for,
/// nor so much less that the other skips more, else the one that is right under any TF. The settled
/// one is then rebuilt in pieces. What is in the making is dropped by a further edit, where it
/// shows other values, and by copying. No GL. Not thread-safe; heavy steps use all cores inside.
/// Tested by: live_skip_test.cpp
class LiveSkip {
public:
    /// Builds the structure for all TFs, unless it is `present`; takes `present`, which is right
    /// under the TF of now, as the settled one where its options are. Cost: O(voxels).
    /// Fails: InvalidArgument (structures that cannot serve so), and as buildSkip().
    static Result<LiveSkip> start(LiveSource source, const LiveOptions& options,
                                  CellVisibility visibility, const BuiltSkip& present);

    /// Another TF, by what it shows of the source's codes. Cost: O(codes); where maps are merged,
    /// O(blocks x partitions).
    void edit(CellVisibility visibility);

    /// Once a frame: rebuilds for about `budgetMs`, but one item at least, which is a slice of
    /// blocks; nothing at 0. What is finished serves once there were frames enough to upload it.
    LiveProgress work(double budgetMs);

    /// Of each structure that is used, as it is when that one serves and another is incoming,
    /// whether or not they are right under the TF of now: empty grids stand for those that were not
    /// built yet.
    std::vector<LiveSkip> eachServing() const;

    const BuiltSkip& current() const { return settledServes_ ? settled_ : always_; }
    const BuiltSkip& always() const { return always_; }   // of the TF of now, or of an earlier one
    const BuiltSkip& settled() const { return settled_; } // as well; may not exist
    /// The next settled one, while its texture is being filled.
    const BuiltSkip& incoming() const { return incoming_; }
    /// Whether what serves is all that can be had under this TF.
    bool isSettled() const { return !wantsRebuild(); }
    /// What start() took, and the last finished rebuilding, over all its calls of work().
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
    std::shared_ptr<const CellVisibility> visibility_; // of now
    VisibleValues shown_;                              // of now
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
