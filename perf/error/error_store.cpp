#include "perf/error/error_store.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace slabcast {

namespace {

constexpr const char* kReferenceFile = "reference.f64";

/// What is read of a row before the page is: its place, and whether it is of the right kind.
struct Member {
    const char* pointer;
    bool (*isSound)(const Json& value);
};

bool isText(const Json& value) {
    return value.isText();
}
bool isNumber(const Json& value) {
    return value.isNumber();
}
bool isThere(const Json&) {
    return true;
}
bool isErrorOrNull(const Json& value) {
    return value.isNull() ||
           (value.isObject() && value.contains("rmse") && value.at("rmse").isNumber());
}
bool areCountersOrNull(const Json& value) {
    const auto counts = [&value](const char* key) {
        return value.contains(key) && value.at(key).isNumber();
    };
    return value.isNull() ||
           (value.isObject() && counts("volume_fetches") && counts("skip_fetches"));
}

constexpr Member kMembers[] = {{"/id", isText},
                               {"/date", isText},
                               {"/layer_spacing", isNumber},
                               {"/layers_per_plane", isNumber},
                               {"/classify", isText},
                               {"/target", isText},
                               {"/termination", isThere},
                               {"/jitter", isThere},
                               {"/error/total/rmse", isNumber},
                               {"/error/sampling", isErrorOrNull},
                               {"/error/table", isErrorOrNull},
                               {"/error/gpu", isErrorOrNull},
                               {"/frame_ms/median", isNumber},
                               {"/counters", areCountersOrNull},
                               {"/pictures/thumbnail", isText},
                               {"/pictures/difference", isText}};

bool isRow(const Json& line) {
    return std::all_of(std::begin(kMembers), std::end(kMembers), [&line](const Member& member) {
        const Json* value = line.atPointer(member.pointer);
        return value != nullptr && member.isSound(*value);
    });
}

} // namespace

void ErrorStore::readReference() {
    const std::optional<std::string> file = folder_->read(kReferenceFile);
    std::string_view content = file ? *file : std::string_view();
    const std::size_t length = std::min(content.find('\n'), content.size());
    const Json header = Json::parse(content.substr(0, length)).value_or(Json());
    content.remove_prefix(std::min(length + 1, content.size()));
    if (header.at("key") != referenceKey_ || !header.at("seconds").isNumber()) {
        return;
    }
    StoredReference stored;
    stored.seconds = header.at("seconds").number();
    const Json& size = referenceKey_.at("size");
    stored.pixels.resize(static_cast<std::size_t>(size.at(0).whole()) *
                         static_cast<std::size_t>(size.at(1).whole()));
    const std::size_t bytes = stored.pixels.size() * sizeof(glm::dvec4);
    if (content.size() >= bytes) {
        std::memcpy(stored.pixels.data(), content.data(), bytes);
        reference_ = std::move(stored);
    }
}

Result<ErrorStore> ErrorStore::open(ReportFolder& folder, RunIdentity run, Json referenceKey,
                                    const Watcher& watcher) {
    return RunStore::open(folder, std::move(run), watcher, isRow).map([&](RunStore rows) {
        ErrorStore store(folder, std::move(referenceKey), std::move(rows));
        if (store.rows_.goesOn()) {
            store.readReference();
        }
        return store;
    });
}

Result<void> ErrorStore::setReference(StoredReference reference) {
    const Json header = {{"key", referenceKey_}, {"seconds", reference.seconds}};
    std::string content = header.dump() + "\n";
    content.append(reinterpret_cast<const char*>(reference.pixels.data()),
                   reference.pixels.size() * sizeof(glm::dvec4));
    reference_ = std::move(reference);
    // What the folder holds is said before it is there.
    return rows_.begin().and_then([&] { return folder_->write(kReferenceFile, content); });
}

const Json* ErrorStore::row(const std::string& id) const {
    const Json* found = rows_.find(id);
    if (found == nullptr) {
        return nullptr;
    }
    const Json& pictures = found->at("pictures");
    const bool there = folder_->has(pictures.at("thumbnail").text()) &&
                       folder_->has(pictures.at("difference").text());
    return there ? found : nullptr;
}

Result<void> ErrorStore::add(Json row) {
    return rows_.add(std::move(row));
}

} // namespace slabcast
