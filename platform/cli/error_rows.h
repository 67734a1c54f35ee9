#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "perf/frame_times.h"
#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/error_store.h"
#include "platform/cli/options.h"
#include "platform/cli/progress.h"

namespace slabcast {

/// Measures a grid's rows, or takes them from the store.
class ErrorRows {
public:
    /// Borrows all. Contract: the store has the reference.
    ErrorRows(Stage& stage, const ErrorOptions& options, ErrorStore& store)
        : stage_(stage), options_(options), store_(store), reference_(store.reference()->pixels) {}

    /// Every row of the grid with a plan of its own, in order; those of a classification that
    /// cannot be had are left out. Fails: InvalidArgument (none can be had), as what is measured.
    Result<nlohmann::json> measure(const std::vector<Sampling>& grid);

    /// Classifications, each with why.
    const nlohmann::json& leftOut() const { return leftOut_; }

private:
    /// Sampled in float64, once for all rows that take the same samples.
    struct Sampled {
        Lattice lattice;
        Classification classification = Classification::Post;
        std::vector<glm::dvec4> withTable;
        nlohmann::json sampling, table; // the parts of the error
    };

    /// False where it cannot be had: it is left out from then on.
    bool classify(Classification classification);
    Result<nlohmann::json> measureRow(const Sampling& sampling, const FramePlan& plan);
    const Sampled& sampledFor(const FramePlan& plan);
    Result<FrameTimes> time(const FramePlan& plan);
    nlohmann::json countersOf(const FramePlan& plan);
    Result<nlohmann::json> savePictures(const std::string& id,
                                        const std::vector<glm::dvec4>& picture);

    Stage& stage_;
    const ErrorOptions& options_;
    ErrorStore& store_;
    const std::vector<glm::dvec4>& reference_;
    Progress progress_;
    std::optional<Sampled> sampled_;
    nlohmann::json leftOut_ = nlohmann::json::array();
    std::vector<std::pair<FramePlan, nlohmann::json>>
        counted_; // work does not depend on the target
};

} // namespace slabcast
