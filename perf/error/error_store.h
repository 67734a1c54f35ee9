#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "perf/json.h"
#include "perf/report_folder.h"

namespace slabcast {

/// A reference as a file keeps it.
struct StoredReference {
    std::vector<glm::dvec4> pixels;
    double seconds = 0.0;
};

/// What a measurement of errors has finished, kept in its folder so that one cut short can go on:
/// `rows.jsonl` (a key, then a row per line) and `reference.f64` (a key, then raw doubles). Keys
/// are JSON objects of all that the content depends on, `commit` and the reference's `size` among
/// it; of other keys nothing is taken, and nothing where the commit is of changed sources. Tested
/// by: error_store_test.cpp
class ErrorStore {
public:
    /// Never fails: what cannot be read is not there, and rows that are damaged start anew. `notes`
    /// receives lines for people. Borrows the folder.
    static ErrorStore open(ReportFolder& folder, const Json& referenceKey, const Json& rowsKey,
                           std::vector<std::string>& notes);
    ErrorStore(ErrorStore&&) noexcept;
    ErrorStore& operator=(ErrorStore&&) noexcept;
    ~ErrorStore();

    /// Null where there is none.
    const StoredReference* reference() const;
    /// Fails: as the folder.
    Result<void> setReference(StoredReference reference);

    /// Null where it is not finished, or one of its pictures is gone.
    const Json* row(const std::string& id) const;
    /// Fails: as the folder.
    Result<void> add(Json row);

private:
    struct State;
    explicit ErrorStore(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace slabcast
