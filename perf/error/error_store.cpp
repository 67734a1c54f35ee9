#include "perf/error/error_store.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

namespace slabcast {

namespace {

using nlohmann::json;

constexpr const char* kRowsFile = "rows.jsonl";
constexpr const char* kReferenceFile = "reference.f64";

/// Takes the next line off the text, as JSON; discarded where there is none or it is something
/// else.
json nextLine(std::string_view& text) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    json line = json::parse(text.substr(0, length), nullptr, false);
    text.remove_prefix(std::min(length + 1, text.size()));
    return line;
}

/// What is read of a row before the page is: its place, and whether it is of the right kind.
struct Member {
    const char* pointer;
    bool (*isSound)(const json& value);
};

bool isText(const json& value) {
    return value.is_string();
}
bool isNumber(const json& value) {
    return value.is_number();
}
bool isThere(const json&) {
    return true;
}
bool isErrorOrNull(const json& value) {
    return value.is_null() ||
           (value.is_object() && value.contains("rmse") && value.at("rmse").is_number());
}
bool areCountersOrNull(const json& value) {
    const auto counts = [&value](const char* key) {
        return value.contains(key) && value.at(key).is_number();
    };
    return value.is_null() ||
           (value.is_object() && counts("volume_fetches") && counts("skip_fetches"));
}

constexpr Member kMembers[] = {{"/id", isText},
                               {"/date", isText},
                               {"/spacing", isNumber},
                               {"/layers", isNumber},
                               {"/classification", isText},
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

bool isRow(const json& line) {
    return std::all_of(std::begin(kMembers), std::end(kMembers), [&line](const Member& member) {
        const json::json_pointer place(member.pointer);
        return line.contains(place) && member.isSound(line.at(place));
    });
}

/// Whether a build of this commit is one that another can be told to be the same as.
bool namesItsSources(const json& commit) {
    return !commit.get<std::string>().ends_with("-dirty");
}

/// Names of the members that two keys do not share.
std::string difference(const json& a, const json& b) {
    std::string names;
    for (const auto& [name, value] : a.items()) {
        if (!b.contains(name) || b.at(name) != value) {
            names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names;
}

} // namespace

struct ErrorStore::State {
    ReportFolder* folder;
    json referenceKey, rowsKey;
    std::optional<StoredReference> reference;
    std::map<std::string, json> rows; // by id

    std::string startsAnew(const std::string& why) const {
        return folder->name() + ": " + why + ": starts anew";
    }
    void readReference();
    void readRows(std::vector<std::string>& notes);
};

void ErrorStore::State::readReference() {
    const std::optional<std::string> file = folder->read(kReferenceFile);
    std::string_view content = file ? *file : std::string_view();
    const json header = nextLine(content);
    if (!header.is_object() || !header.contains("key") || header.at("key") != referenceKey ||
        !header.contains("seconds") || !header.at("seconds").is_number()) {
        return;
    }
    StoredReference stored;
    stored.seconds = header.at("seconds");
    const json& size = referenceKey.at("size");
    stored.pixels.resize(size.at(0).get<std::size_t>() * size.at(1).get<std::size_t>());
    const std::size_t bytes = stored.pixels.size() * sizeof(glm::dvec4);
    if (content.size() >= bytes) {
        std::memcpy(stored.pixels.data(), content.data(), bytes);
        reference = std::move(stored);
    }
}

void ErrorStore::State::readRows(std::vector<std::string>& notes) {
    const std::string damaged = startsAnew(std::string(kRowsFile) + " is damaged");
    const std::optional<std::string> file = folder->read(kRowsFile);
    if (!file) {
        return;
    }
    std::string_view content = *file;
    const json key = nextLine(content);
    if (!key.is_object()) {
        notes.push_back(damaged);
        return;
    }
    if (key != rowsKey) {
        notes.push_back(startsAnew("holds rows that differ in " + difference(rowsKey, key)));
        return;
    }
    for (json row = nextLine(content); !row.is_discarded(); row = nextLine(content)) {
        if (!isRow(row)) {
            notes.push_back(damaged);
            rows.clear();
            return;
        }
        const std::string id = row.at("id");
        rows[id] = std::move(row);
    }
    notes.push_back(folder->name() + ": " + std::to_string(rows.size()) +
                    " rows of an earlier run with the same settings are kept");
}

ErrorStore::ErrorStore(std::unique_ptr<State> state) : state_(std::move(state)) {}
ErrorStore::ErrorStore(ErrorStore&&) noexcept = default;
ErrorStore& ErrorStore::operator=(ErrorStore&&) noexcept = default;
ErrorStore::~ErrorStore() = default;

ErrorStore ErrorStore::open(ReportFolder& folder, const json& referenceKey, const json& rowsKey,
                            std::vector<std::string>& notes) {
    auto state = std::make_unique<State>();
    state->folder = &folder;
    state->referenceKey = referenceKey;
    state->rowsKey = rowsKey;
    if (namesItsSources(rowsKey.at("commit"))) {
        state->readReference();
        state->readRows(notes);
    } else if (folder.has(kRowsFile)) {
        notes.push_back(folder.name() + ": starts anew, as this program was built from sources "
                                        "that no commit names");
    }
    return ErrorStore(std::move(state));
}

const StoredReference* ErrorStore::reference() const {
    return state_->reference ? &*state_->reference : nullptr;
}

Result<void> ErrorStore::setReference(StoredReference reference) {
    const json header = {{"key", state_->referenceKey}, {"seconds", reference.seconds}};
    std::string content = header.dump() + "\n";
    content.append(reinterpret_cast<const char*>(reference.pixels.data()),
                   reference.pixels.size() * sizeof(glm::dvec4));
    state_->reference = std::move(reference);
    return state_->folder->write(kReferenceFile, content);
}

const json* ErrorStore::row(const std::string& id) const {
    const auto found = state_->rows.find(id);
    if (found == state_->rows.end()) {
        return nullptr;
    }
    const json& pictures = found->second.at("pictures");
    const bool there = state_->folder->has(pictures.at("thumbnail").get<std::string>()) &&
                       state_->folder->has(pictures.at("difference").get<std::string>());
    return there ? &found->second : nullptr;
}

Result<void> ErrorStore::add(json row) {
    const std::string id = row.at("id");
    state_->rows[id] = std::move(row);
    std::string content = state_->rowsKey.dump() + "\n";
    for (const auto& entry : state_->rows) {
        content += entry.second.dump() + "\n";
    }
    return state_->folder->write(kRowsFile, content);
}

} // namespace slabcast
