#include "perf/run_store.h"

#include <algorithm>
#include <optional>
#include <string_view>

namespace slabcast {

namespace {

constexpr const char* kRowsFile = "rows.jsonl";
/// What any run may have left beside its report.
constexpr const char* kLeftFiles[] = {kRowsFile,       "reference.f64",  "refinement.csv",
                                      "worst_ray.csv", "worst_ray.json", "report.html"};

/// Takes the next line off the text, as JSON; nothing where there is none or it is something else.
std::optional<Json> nextLine(std::string_view& text) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    std::optional<Json> line = Json::parse(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
    return line;
}

/// A run that a folder holds.
struct Held {
    RunIdentity run;
    bool finished = false;
    bool hasKey = false;
    std::string pieces; // lines of rows.jsonl after its first
};

std::string namesOf(const Json& volumes) {
    std::string names;
    for (const Json& volume : volumes) {
        names += (names.empty() ? "" : ", ") + volume.at("name").text();
    }
    return names;
}

/// As the report itself tells.
std::optional<Held> finishedRun(const ReportFolder& folder) {
    for (const char* report : kReports) {
        const std::string file = std::string(report) + ".json";
        if (!folder.has(file)) {
            continue;
        }
        const std::optional<std::string> text = folder.read(file);
        const Json json = (text ? Json::parse(*text) : std::nullopt).value_or(Json());
        const std::string& volume = json.at("volume").at("name").text();
        return Held{.run = {.report = report,
                            .subject = volume.empty() ? namesOf(json.at("volumes")) : volume,
                            .command = json.at("command").text()},
                    .finished = true};
    }
    return std::nullopt;
}

/// As the first line of its pieces tells; nothing where that is damaged.
std::optional<Held> runOfPieces(const ReportFolder& folder) {
    const std::optional<std::string> file = folder.read(kRowsFile);
    std::string_view content = file ? *file : std::string_view();
    const Json first = nextLine(content).value_or(Json());
    if (!first.at("report").isText() || !first.at("key").isObject()) {
        return std::nullopt;
    }
    return Held{.run = {.report = first.at("report").text(),
                        .subject = first.at("subject").text(),
                        .command = first.at("command").text(),
                        .key = first.at("key")},
                .finished = folder.has(first.at("report").text() + ".json"),
                .hasKey = true,
                .pieces = std::string(content)};
}

std::optional<Held> heldBy(const ReportFolder& folder) {
    std::optional<Held> held = runOfPieces(folder);
    return held ? held : finishedRun(folder);
}

/// Whether a build of this commit is one that another can be told to be the same as.
bool namesItsSources(const Json& key) {
    return !key.at("commit").text().ends_with("-dirty");
}

/// Names of the members that two keys do not share, those of `settings` by their own names.
std::string difference(const Json& a, const Json& b) {
    std::string names;
    for (const std::string& name : a.names()) {
        if (b.contains(name) && b.at(name) == a.at(name)) {
            continue;
        }
        const std::string inner = a.at(name).isObject() && b.at(name).isObject()
                                      ? difference(a.at(name), b.at(name))
                                      : std::string();
        const std::string told = name == "settings" && !inner.empty() ? inner : name;
        names += (names.empty() ? "" : ", ") + told;
    }
    return names;
}

/// Why a run does not go on where this one is.
std::string reasonAgainst(const Held& held, const RunIdentity& run) {
    if (run.key.isNull()) {
        return "which cannot go on";
    }
    if (held.run.report != run.report) {
        return "which is another report";
    }
    if (!held.hasKey) {
        return std::string("without a ") + kRowsFile + " to go on from";
    }
    if (held.run.key == run.key) {
        return "by a program from sources that no commit names, which cannot go on";
    }
    const std::string names = difference(run.key, held.run.key);
    return "which differs in " + (names.empty() ? "what it depends on" : names);
}

Result<void> refuse(const ReportFolder& folder, const Held& held, const RunIdentity& run) {
    const bool vowel = held.run.report.starts_with('e');
    std::string what = (vowel ? "an '" : "a '") + held.run.report + "' run";
    if (!held.finished) {
        what = "the beginning of " + what;
    }
    if (!held.run.subject.empty()) {
        what += " of " + held.run.subject;
    }
    if (!held.run.command.empty()) {
        what += " (" + held.run.command + ")";
    }
    return fail(ErrorCode::FileUnwritable,
                folder.name() + ": holds " + what + ", " + reasonAgainst(held, run) +
                    ": give --out another folder, or --fresh to start anew in this one");
}

/// All that says what a run found.
void removeRun(ReportFolder& folder) {
    for (const char* file : kLeftFiles) {
        folder.remove(file);
    }
    for (const char* report : kReports) {
        folder.remove(std::string(report) + ".json");
        folder.remove(std::string(report) + ".csv");
    }
}

} // namespace

Result<void> claim(ReportFolder& folder, const RunIdentity& run) {
    if (const std::optional<Held> held = heldBy(folder); held && !folder.mayBeReplaced()) {
        return refuse(folder, *held, run);
    }
    if (folder.mayBeReplaced()) {
        removeRun(folder);
    }
    return {};
}

bool RunStore::take(std::string_view lines, const Sound& isSound) {
    while (std::optional<Json> piece = nextLine(lines)) {
        if (!piece->at("id").isText() || (isSound && !isSound(*piece))) {
            pieces_.clear();
            return false;
        }
        const std::string id = piece->at("id").text();
        pieces_[id] = std::move(*piece);
    }
    return true;
}

Result<RunStore> RunStore::open(ReportFolder& folder, RunIdentity run, const Watcher& watcher,
                                const Sound& isSound) {
    SLABCAST_EXPECTS(run.key.at("commit").isText(), run.report.size());
    const auto say = [&](const std::string& note) {
        if (watcher.say) {
            watcher.say(folder.name() + ": " + note);
        }
    };
    RunStore store(folder, std::move(run));
    const std::optional<Held> held = heldBy(folder);
    const bool goesOn = held && held->hasKey && held->run.report == store.run_.report &&
                        held->run.key == store.run_.key && namesItsSources(store.run_.key) &&
                        !folder.mayBeReplaced();
    if (!goesOn) {
        if (!held && folder.has(kRowsFile) && !folder.mayBeReplaced()) {
            say(std::string(kRowsFile) + " is damaged: starts anew");
        }
        return claim(folder, store.run_).map([&] { return std::move(store); });
    }
    store.goesOn_ = true;
    if (store.take(held->pieces, isSound)) {
        say(std::to_string(store.pieces_.size()) +
            " rows of an earlier run with the same settings are kept");
    } else {
        say(std::string(kRowsFile) + " is damaged: starts anew");
    }
    return store;
}

const Json* RunStore::find(const std::string& id) const {
    const auto found = pieces_.find(id);
    return found == pieces_.end() ? nullptr : &found->second;
}

Result<void> RunStore::begin() {
    return goesOn_ || !pieces_.empty() ? Result<void>{} : write();
}

Result<void> RunStore::add(Json piece) {
    const std::string id = piece.at("id").text();
    SLABCAST_EXPECTS(!id.empty(), id.size());
    pieces_[id] = std::move(piece);
    return write();
}

Result<void> RunStore::write() {
    const Json first = {{"report", run_.report},
                        {"subject", run_.subject},
                        {"command", run_.command},
                        {"key", run_.key}};
    std::string content = first.dump() + "\n";
    for (const auto& entry : pieces_) {
        content += entry.second.dump() + "\n";
    }
    return folder_->write(kRowsFile, content);
}

} // namespace slabcast
