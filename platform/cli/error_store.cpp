#include "platform/cli/error_store.h"

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

bool isRow(const json& line) {
    return line.is_object() && line.contains("id") && line.at("id").is_string() &&
           line.contains("pictures");
}

/// Names of the members that two keys do not share.
std::string difference(const json& a, const json& b) {
    std::string names;
    for (const auto& [name, value] : a.items()) {
        if (!b.is_object() || !b.contains(name) || b.at(name) != value) {
            names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names;
}

} // namespace

ErrorStore ErrorStore::open(const fs::path& folder, json referenceKey, json rowsKey,
                            std::vector<std::string>& notes) {
    ErrorStore store(folder, std::move(referenceKey), std::move(rowsKey));
    store.readReference();
    store.readRows(notes);
    return store;
}

void ErrorStore::readReference() {
    std::ifstream file(folder_ / kReferenceFile, std::ios::binary);
    const json header = nextLine(file);
    if (!header.is_object() || !header.contains("key") || header.at("key") != referenceKey_) {
        return;
    }
    StoredReference stored;
    stored.seconds = header.value("seconds", 0.0);
    const std::size_t count = header.value("pixels", std::size_t{0});
    stored.pixels.resize(count);
    const auto bytes = static_cast<std::streamsize>(count * sizeof(glm::dvec4));
    if (count > 0 && file.read(reinterpret_cast<char*>(stored.pixels.data()), bytes)) {
        reference_ = std::move(stored);
    }
}

void ErrorStore::readRows(std::vector<std::string>& notes) {
    std::ifstream file(folder_ / kRowsFile);
    if (!file) {
        return;
    }
    const json key = nextLine(file);
    if (key != rowsKey_) {
        notes.push_back(fmt::format("{}: holds rows that differ in {}: starts anew",
                                    folder_.string(), difference(rowsKey_, key)));
        return;
    }
    for (json row = nextLine(file); isRow(row); row = nextLine(file)) {
        const std::string id = row.at("id");
        rows_[id] = std::move(row);
    }
    notes.push_back(fmt::format("{}: {} rows of an earlier run with the same settings are kept",
                                folder_.string(), rows_.size()));
}

Result<void> ErrorStore::setReference(StoredReference reference) {
    const json header = {{"key", referenceKey_},
                         {"seconds", reference.seconds},
                         {"pixels", reference.pixels.size()}};
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
        if (!fs::exists(folder_ / file.get<std::string>())) {
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
