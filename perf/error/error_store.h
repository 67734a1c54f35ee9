#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "perf/run_store.h"

namespace slabcast {

/// A reference as a file keeps it.
struct StoredReference {
    std::vector<glm::dvec4> pixels;
    double seconds = 0.0;
};

/// What a measurement of errors has finished: rows in a RunStore, each complete as the page needs
/// it, and the reference in `reference.f64` (a key, then raw doubles) beside. The reference's key
/// is all that it depends on, its `size` among it; of another key none is taken, and none where the
/// run starts anew. Tested by: error_store_test.cpp
class ErrorStore {
public:
    /// Borrows the folder. Fails: as RunStore::open().
    static Result<ErrorStore> open(ReportFolder& folder, RunIdentity run, Json referenceKey,
                                   const Watcher& watcher);

    /// Null where there is none.
    const StoredReference* reference() const { return reference_ ? &*reference_ : nullptr; }
    /// Fails: as the folder.
    Result<void> setReference(StoredReference reference);

    /// Null where it is not finished, or one of its pictures is gone.
    const Json* row(const std::string& id) const;
    /// Fails: as the folder.
    Result<void> add(Json row);

private:
    ErrorStore(ReportFolder& folder, Json referenceKey, RunStore rows)
        : folder_(&folder), referenceKey_(std::move(referenceKey)), rows_(std::move(rows)) {}
    void readReference();

    ReportFolder* folder_;
    Json referenceKey_;
    RunStore rows_;
    std::optional<StoredReference> reference_;
};

} // namespace slabcast
