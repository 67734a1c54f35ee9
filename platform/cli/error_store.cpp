#include "platform/cli/error_store.h"

#include <algorithm>
#include <fstream>

#include <fmt/core.h>

#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRowsFile = "rows.jsonl";
constexpr const char* kReferenceFile = "reference.f64";

/// The next line as JSON; discarded where there is none or it is something else.
json nextLine(std::ifstream& file) {
    std::string line;
    return std::getline(file, line) ? json::parse(line, nullptr, false)
                                    : json(json::value_t::discarded);
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
                               {"/frameMs/median", isNumber},
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

ErrorStore ErrorStore::open(const fs::path& folder, json referenceKey, json rowsKey,
                            std::vector<std::string>& notes) {
    ErrorStore store(folder, std::move(referenceKey), std::move(rowsKey));
    if (namesItsSources(store.rowsKey_.at("commit"))) {
        store.readReference();
        store.readRows(notes);
    } else if (std::error_code ignored; fs::exists(folder / kRowsFile, ignored)) {
        notes.push_back(fmt::format("{}: starts anew, as this program was built from sources that "
                                    "no commit names",
                                    folder.string()));
    }
    return store;
}

std::string ErrorStore::damaged() const {
    return fmt::format("{}: {} is damaged: starts anew", folder_.string(), kRowsFile);
}

void ErrorStore::readReference() {
    std::ifstream file(folder_ / kReferenceFile, std::ios::binary);
    const json header = nextLine(file);
    if (!header.is_object() || !header.contains("key") || header.at("key") != referenceKey_) {
        return;
    }
    if (!header.contains("seconds") || !header.at("seconds").is_number()) {
        return;
    }
    StoredReference stored;
    stored.seconds = header.at("seconds");
    const json& size = referenceKey_.at("size");
    stored.pixels.resize(size.at(0).get<std::size_t>() * size.at(1).get<std::size_t>());
    const auto bytes = static_cast<std::streamsize>(stored.pixels.size() * sizeof(glm::dvec4));
    if (file.read(reinterpret_cast<char*>(stored.pixels.data()), bytes)) {
        reference_ = std::move(stored);
    }
}

void ErrorStore::readRows(std::vector<std::string>& notes) {
    std::ifstream file(folder_ / kRowsFile);
    if (!file) {
        return;
    }
    const json key = nextLine(file);
    if (!key.is_object()) {
        notes.push_back(damaged());
        return;
    }
    if (key != rowsKey_) {
        notes.push_back(fmt::format("{}: holds rows that differ in {}: starts anew",
                                    folder_.string(), difference(rowsKey_, key)));
        return;
    }
    for (json row = nextLine(file); !row.is_discarded(); row = nextLine(file)) {
        if (!isRow(row)) {
            notes.push_back(damaged());
            rows_.clear();
            return;
        }
        const std::string id = row.at("id");
        rows_[id] = std::move(row);
    }
    notes.push_back(fmt::format("{}: {} rows of an earlier run with the same settings are kept",
                                folder_.string(), rows_.size()));
}

Result<void> ErrorStore::setReference(StoredReference reference) {
    const json header = {{"key", referenceKey_}, {"seconds", reference.seconds}};
    std::string content = header.dump() + "\n";
    content.append(reinterpret_cast<const char*>(reference.pixels.data()),
                   reference.pixels.size() * sizeof(glm::dvec4));
    reference_ = std::move(reference);
    return writeFileAtomically(folder_ / kReferenceFile, content);
}

const json* ErrorStore::row(const std::string& id) const {
    const auto found = rows_.find(id);
    if (found == rows_.end()) {
        return nullptr;
    }
    for (const char* picture : {"thumbnail", "difference"}) {
        const json& file = found->second.at("pictures").at(picture);
        std::error_code ignored; // what cannot be asked after is not there
        if (!fs::exists(folder_ / file.get<std::string>(), ignored)) {
            return nullptr;
        }
    }
    return &found->second;
}

Result<void> ErrorStore::add(json row) {
    const std::string id = row.at("id");
    rows_[id] = std::move(row);
    std::string content = rowsKey_.dump() + "\n";
    for (const auto& entry : rows_) {
        content += entry.second.dump() + "\n";
    }
    return writeFileAtomically(folder_ / kRowsFile, content);
}

} // namespace slabcast
