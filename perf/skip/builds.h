#pragma once

#include <span>
#include <vector>

#include "core/skip/built_skip.h"
#include "perf/skip/subject.h"

namespace slabcast::skipbench {

/// Builds structures of a stage's volume again and again, apart from what is drawn.
class Workshop {
public:
    explicit Workshop(Stage& stage);
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    /// What the transfer function of a variation of the stage's scene shows.
    CellVisibility visibilityUnder(const Scene& scene) const;

    Result<BuiltSkip> build(const SkipOptions& options, const CellVisibility& visibility) const {
        return buildSkip({codes_, stage_.scene().texels(), visibility, stage_.scene().geometry()},
                         options);
    }
    /// The same under the stage's own transfer function, from the volume's texture. Fails: as
    /// Renderer::buildSkip(); DeviceUnsupported where a software driver would take minutes.
    Result<BuiltSkip> buildOnGpu(const SkipOptions& options) const;

    const TexelCodes& codes() const { return codes_; }
    double codesMs() const { return codesMs_; } // of what all builds share: once per volume

private:
    Stage& stage_;
    TexelCodes codes_;
    double codesMs_ = 0.0;
};

/// What each structure takes to build under the stage's transfer function, all in turn and up to
/// `rounds` times, fewer where these take seconds: on the CPU, from codes and visibility to what is
/// uploaded; on the GPU, from the volume's texture until the host has its copy; and what it holds.
/// A row each, of which `beginning` is the beginning.
/// From the store where all of them are there.
Result<std::vector<Row>> buildRows(const Workshop& workshop, const CellVisibility& visibility,
                                   std::span<const SkipOptions> structures, int rounds,
                                   const Row& beginning, RunStore& store);

} // namespace slabcast::skipbench
