#include "perf/error/error_store.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>

namespace slabcast {

namespace {

constexpr const char* kRowsFile = "rows.jsonl";
constexpr const char* kReferenceFile = "reference.f64";

/// Takes the next line off the text, as JSON; nothing where there is none or it is something else.
std::optional<Json> nextLine(std::string_view& text) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    std::optional<Json> line = Json::parse(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
    return line;
}

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

bool isRow(const Json& line) {
    return std::all_of(std::begin(kMembers), std::end(kMembers), [&line](const Member& member) {
        const Json* value = line.atPointer(member.pointer);
        return value != nullptr && member.isSound(*value);
    });
}

/// Whether a build of this commit is one that another can be told to be the same as.
bool namesItsSources(const Json& commit) {
    return !commit.text().ends_with("-dirty");
}

/// Names of the members that two keys do not share.
std::string difference(const Json& a, const Json& b) {
    std::string names;
    for (const std::string& name : a.names()) {
        if (!b.contains(name) || b.at(name) != a.at(name)) {
            names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names;
}

} // namespace

struct ErrorStore::State {
    ReportFolder* folder;
    Json referenceKey, rowsKey;
    std::optional<StoredReference> reference;
    std::map<std::string, Json> rows; // by id

    std::string startsAnew(const std::string& why) const {
        return folder->name() + ": " + why + ": starts anew";
    }
    void readReference();
    void readRows(std::vector<std::string>& notes);
};

void ErrorStore::State::readReference() {
    const std::optional<std::string> file = folder->read(kReferenceFile);
    std::string_view content = file ? *file : std::string_view();
    const Json header = nextLine(content).value_or(Json());
    if (!header.isObject() || !header.contains("key") || header.at("key") != referenceKey ||
        !header.contains("seconds") || !header.at("seconds").isNumber()) {
        return;
    }
    StoredReference stored;
    stored.seconds = header.at("seconds").number();
    const Json& size = referenceKey.at("size");
    stored.pixels.resize(static_cast<std::size_t>(size.at(0).whole()) *
                         static_cast<std::size_t>(size.at(1).whole()));
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
    const Json key = nextLine(content).value_or(Json());
    if (!key.isObject()) {
        notes.push_back(damaged);
        return;
    }
    if (key != rowsKey) {
        notes.push_back(startsAnew("holds rows that differ in " + difference(rowsKey, key)));
        return;
    }
    while (std::optional<Json> row = nextLine(content)) {
        if (!isRow(*row)) {
            notes.push_back(damaged);
            rows.clear();
            return;
        }
        const std::string id = row->at("id").text();
        rows[id] = std::move(*row);
    }
    notes.push_back(folder->name() + ": " + std::to_string(rows.size()) +
                    " rows of an earlier run with the same settings are kept");
}

ErrorStore::ErrorStore(std::unique_ptr<State> state) : state_(std::move(state)) {}
ErrorStore::ErrorStore(ErrorStore&&) noexcept = default;
ErrorStore& ErrorStore::operator=(ErrorStore&&) noexcept = default;
ErrorStore::~ErrorStore() = default;

ErrorStore ErrorStore::open(ReportFolder& folder, const Json& referenceKey, const Json& rowsKey,
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
    const Json header = {{"key", state_->referenceKey}, {"seconds", reference.seconds}};
    std::string content = header.dump() + "\n";
    content.append(reinterpret_cast<const char*>(reference.pixels.data()),
                   reference.pixels.size() * sizeof(glm::dvec4));
    state_->reference = std::move(reference);
    return state_->folder->write(kReferenceFile, content);
}

const Json* ErrorStore::row(const std::string& id) const {
    const auto found = state_->rows.find(id);
    if (found == state_->rows.end()) {
        return nullptr;
    }
    const Json& pictures = found->second.at("pictures");
    const bool there = state_->folder->has(pictures.at("thumbnail").text()) &&
                       state_->folder->has(pictures.at("difference").text());
    return there ? &found->second : nullptr;
}

Result<void> ErrorStore::add(Json row) {
    const std::string id = row.at("id").text();
    state_->rows[id] = std::move(row);
    std::string content = state_->rowsKey.dump() + "\n";
    for (const auto& entry : state_->rows) {
        content += entry.second.dump() + "\n";
    }
    return state_->folder->write(kRowsFile, content);
}

} // namespace slabcast
