#include "perf/stability/report.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/stopwatch.h"
#include "perf/csv.h"
#include "perf/json.h"
#include "perf/stability/bench.h"

namespace slabcast::stability {

namespace {

constexpr CsvColumn kColumns[] = {{"family", "/family"},
                                  {"name", "/name"},
                                  {"quantity", "/quantity"},
                                  {"bound", "/bound"},
                                  {"measured", "/measured"},
                                  {"pass", "/pass"},
                                  {"failure", "/failure"},
                                  {"perturbation", "/condition/perturbation"},
                                  {"largest_change", "/condition/largest_change"},
                                  {"condition_number", "/condition/condition_number"},
                                  {"limit", "/condition/limit"},
                                  {"jumping_share", "/condition/jumping_share"},
                                  {"reason", "/reason"}};

/// JSON knows neither NaN nor infinity.
Json finite(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json toJson(const Series& series) {
    Json result = {{"group", series.group},
                   {"x", series.x},
                   {"y", finite(series.y)},
                   {"x_label", series.xLabel},
                   {"y_label", series.yLabel}};
    if (!series.panel.empty()) {
        result["panel"] = series.panel;
    }
    if (series.bound) {
        result["bound"] = finite(*series.bound);
    }
    return result;
}

Json toJson(const Condition& condition) {
    return {{"scene", condition.scene},
            {"input", condition.input},
            {"perturbation", condition.perturbation},
            {"largest_change", finite(condition.largestChange)},
            {"condition_number", finite(condition.largestChange / condition.perturbation)},
            {"limit", condition.limit ? finite(*condition.limit) : Json()},
            {"jumping_share", condition.jumpingShare}};
}

Json toJson(const LeftOut& leftOut) {
    return {{"plan", Json::listOf(leftOut.plan)},
            {"active_uniforms", leftOut.activeUniforms},
            {"samplers", Json::listOf(leftOut.samplers)},
            {"fragments", leftOut.fragments},
            {"layers", leftOut.layers},
            {"volume_and_skip_bytes", leftOut.volumeAndSkipBytes},
            {"timed_frames", leftOut.timedFrames},
            {"least_frame_ms", leftOut.leastFrameMs},
            {"least_frame_ms_with_all", leftOut.leastFrameMsWithAll}};
}

/// "stiff_one-unit-step-slicing-rgba8_0.png": letters, digits and points of the name.
std::string pictureFile(const Case& c, std::size_t index) {
    std::string file = c.family + "_";
    for (const char letter : c.name) {
        const bool kept = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '.';
        if (kept || file.back() != '-') {
            file += kept ? letter : '-';
        }
    }
    return std::string(kPictures) + "/" + file + "_" + std::to_string(index) + ".png";
}

/// Over black, as a premultiplied picture is where nothing is added.
ReportPicture forPage(const Picture& picture) {
    ReportPicture topDown{picture.size, {}};
    topDown.pixels.reserve(picture.pixels.size());
    for (int y = picture.size.y - 1; y >= 0; --y) {
        const auto row = picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.size.x;
        topDown.pixels.insert(topDown.pixels.end(), row, row + picture.size.x);
    }
    return topDown;
}

/// One case, and its pictures as files.
Result<Json> written(const Case& c, ReportFolder& folder) {
    Json result = {{"family", c.family},     {"name", c.name},
                   {"quantity", c.quantity}, {"bound", finite(c.bound)},
                   {"reason", c.reason},     {"measured", finite(c.measured)},
                   {"pass", c.pass()}};
    if (!c.failure.empty()) {
        result["failure"] = c.failure;
    }
    if (c.series) {
        result["series"] = toJson(*c.series);
    }
    if (c.leftOut) {
        result["left_out"] = toJson(*c.leftOut);
    }
    if (c.condition) {
        result["condition"] = toJson(*c.condition);
    }
    for (std::size_t k = 0; k < c.pictures.size(); ++k) {
        const std::string file = pictureFile(c, k);
        if (Result<void> done = folder.savePicture(file, forPage(c.pictures[k].picture)); !done) {
            return tl::unexpected(done.error());
        }
        result["pictures"].push_back({{"name", c.pictures[k].name}, {"file", file}});
    }
    return result;
}

/// The family of this name; all where it is empty.
std::vector<Family> chosen(const std::string& name) {
    std::vector<Family> result;
    for (const Family& family : families()) {
        if (name.empty() || name == family.name) {
            result.push_back(family);
        }
    }
    return result;
}

void runFamilies(Bench& bench, std::span<const Family> run, const Watcher& watcher) {
    ProgressLine progress(watcher);
    int failed = 0;
    const char* title = "";
    bench.setWatcher([&](const Case& c) {
        failed += c.pass() ? 0 : 1;
        progress.show(std::string(title) + ": " + std::to_string(bench.cases().size() + 1) +
                      " cases, " + std::to_string(failed) + " failed");
    });
    for (const Family& family : run) {
        title = family.title;
        progress.show(title);
        family.run(bench);
    }
    bench.setWatcher({});
}

Json namesOf(std::span<const Family> families) {
    Json result = Json::list();
    for (const Family& family : families) {
        result.push_back({{"name", family.name}, {"title", family.title}});
    }
    return result;
}

} // namespace

Result<void> measure(Bench& bench, const std::string& family, const RunInfo& run,
                     ReportFolder& folder, const Watcher& watcher) {
    const Stopwatch watch;
    const std::vector<Family> families = chosen(family);
    runFamilies(bench, families, watcher);
    Json report = reportHeader(run, bench.caps());
    report.update({{"reduced", bench.reduced()},
                   {"seconds", watch.ms() / 1000.0},
                   {"families", namesOf(families)},
                   {"cases", Json::list()}});
    for (const Case& c : bench.cases()) {
        Result<Json> one = written(c, folder);
        if (!one) {
            return tl::unexpected(one.error());
        }
        report["cases"].push_back(std::move(*one));
    }
    return folder.write("stability.json", report.dump(2) + "\n").and_then([&] {
        return folder.write("stability.csv", csvOf(report["cases"], kColumns));
    });
}

} // namespace slabcast::stability
