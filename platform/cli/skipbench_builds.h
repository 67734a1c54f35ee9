#pragma once

#include <vector>

#include "core/skip/built_skip.h"
#include "platform/cli/skipbench_subject.h"

namespace slabcast {

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
/// `rounds` times, fewer where these take seconds: `buildMs` on the CPU, from codes and
/// visibility to what is uploaded; `gpuBuildMs` on the GPU, from the volume's texture until the
/// host has its copy, or null with the reason in `gpuRefused`; and what it holds. A row each of
/// `table`, of which `row` is the beginning. Structures over their memory budget are rows with
/// `refused`.
Result<nlohmann::json> buildRows(const Workshop& workshop, const CellVisibility& visibility,
                                 const std::vector<SkipOptions>& structures, int rounds,
                                 const nlohmann::json& row);

} // namespace slabcast
