#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace slabcast {

/// A reference as a file keeps it.
struct StoredReference {
    std::vector<glm::dvec4> pixels;
    double seconds = 0.0;
};

/// What a run of `slabcast error` has finished, kept in its folder so that a run cut short can go
/// on: `rows.jsonl` (a key, then a row per line) and `reference.f64` (a key, then raw doubles).
/// Keys are JSON objects of all that the content depends on, `commit` and the reference's `size`
/// among it; of other keys nothing is taken, and nothing where the commit is of changed sources.
class ErrorStore {
public:
    /// Never fails: what cannot be read is not there, and rows that are damaged start anew. `notes`
    /// receives lines for people.
    static ErrorStore open(const std::filesystem::path& folder, nlohmann::json referenceKey,
                           nlohmann::json rowsKey, std::vector<std::string>& notes);

    const std::optional<StoredReference>& reference() const { return reference_; }
    Result<void> setReference(StoredReference reference);

    /// Null where it is not finished, or one of its pictures is gone.
    const nlohmann::json* row(const std::string& id) const;
    /// Fails: FileUnwritable.
    Result<void> add(nlohmann::json row);

private:
    ErrorStore(std::filesystem::path folder, nlohmann::json referenceKey, nlohmann::json rowsKey)
        : folder_(std::move(folder)), referenceKey_(std::move(referenceKey)),
          rowsKey_(std::move(rowsKey)) {}

    std::string damaged() const; // in words
    void readReference();
    void readRows(std::vector<std::string>& notes);

    std::filesystem::path folder_;
    nlohmann::json referenceKey_, rowsKey_;
    std::optional<StoredReference> reference_;
    std::map<std::string, nlohmann::json> rows_; // by id
};

} // namespace slabcast
