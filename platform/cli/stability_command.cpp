#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/core.h>

#include "perf/csv.h"
#include "perf/report_folder.h"
#include "perf/report_json.h"
#include "perf/stability/bench.h"
#include "perf/stage.h"
#include "platform/cli/commands.h"
#include "platform/cli/commit.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using stability::Bench;
using stability::Case;
using stability::Family;
using stability::LeftOut;
using stability::NamedPicture;
using stability::Picture;
using stability::Series;

constexpr const char* kPictureFolder = "pictures";

constexpr CsvColumn kColumns[] = {
    {"family", "/family"},     {"name", "/name"}, {"quantity", "/quantity"}, {"bound", "/bound"},
    {"measured", "/measured"}, {"pass", "/pass"}, {"failure", "/failure"},   {"reason", "/reason"}};

/// JSON knows neither NaN nor infinity.
json toJson(double value) {
    return std::isfinite(value) ? json(value) : json();
}

json toJson(const Series& series) {
    json result = {{"group", series.group},
                   {"x", series.x},
                   {"y", toJson(series.y)},
                   {"xLabel", series.xLabel},
                   {"yLabel", series.yLabel}};
    if (!series.panel.empty()) {
        result["panel"] = series.panel;
    }
    return result;
}

json toJson(const LeftOut& leftOut) {
    return {{"plan", leftOut.plan},
            {"activeUniforms", leftOut.activeUniforms},
            {"samplers", leftOut.samplers},
            {"fragments", leftOut.fragments},
            {"layers", leftOut.layers},
            {"volumeAndSkipBytes", leftOut.volumeAndSkipBytes},
            {"timedFrames", leftOut.timedFrames},
            {"leastFrameMs", leftOut.leastFrameMs},
            {"leastFrameMsWithAll", leftOut.leastFrameMsWithAll}};
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
    return fmt::format("{}/{}_{}.png", kPictureFolder, file, index);
}

/// Over black, as a premultiplied picture is where nothing is added.
Result<void> writePicture(const fs::path& path, const Picture& picture) {
    std::vector<glm::vec4> topDown;
    topDown.reserve(picture.pixels.size());
    for (int y = picture.size.y - 1; y >= 0; --y) {
        const auto row = picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.size.x;
        topDown.insert(topDown.end(), row, row + picture.size.x);
    }
    return savePicture(path, picture.size, topDown, true);
}

/// One case, and its pictures as files.
Result<json> written(const Case& c, const fs::path& folder) {
    json result = {{"family", c.family},     {"name", c.name},
                   {"quantity", c.quantity}, {"bound", toJson(c.bound)},
                   {"reason", c.reason},     {"measured", toJson(c.measured)},
                   {"pass", c.pass()}};
    if (!c.failure.empty()) {
        result["failure"] = c.failure;
    }
    if (c.series) {
        result["series"] = toJson(*c.series);
    }
    if (c.leftOut) {
        result["leftOut"] = toJson(*c.leftOut);
    }
    for (std::size_t k = 0; k < c.pictures.size(); ++k) {
        const std::string file = pictureFile(c, k);
        if (Result<void> done = writePicture(folder / file, c.pictures[k].picture); !done) {
            return tl::unexpected(done.error());
        }
        result["pictures"].push_back({{"name", c.pictures[k].name}, {"file", file}});
    }
    return result;
}

/// The family of this name; all where it is empty.
std::vector<Family> chosen(const std::string& name) {
    const std::span<const Family> all = stability::families();
    std::vector<Family> result;
    std::copy_if(all.begin(), all.end(), std::back_inserter(result),
                 [&](const Family& f) { return name.empty() || name == f.name; });
    return result;
}

void runFamilies(Bench& bench, std::span<const Family> families) {
    Progress progress;
    int failed = 0;
    const char* title = "";
    bench.setWatcher([&](const Case& c) {
        failed += c.pass() ? 0 : 1;
        progress.show(
            fmt::format("{}: {} cases, {} failed", title, bench.cases().size() + 1, failed));
    });
    for (const Family& family : families) {
        title = family.title;
        progress.show(title);
        family.run(bench);
    }
    bench.setWatcher({});
}

Result<void> writeReport(json report, std::span<const Case> cases, const fs::path& folder) {
    report["cases"] = json::array();
    for (const Case& c : cases) {
        Result<json> one = written(c, folder);
        if (!one) {
            return tl::unexpected(one.error());
        }
        report["cases"].push_back(std::move(*one));
    }
    for (const auto& [file, text] :
         {std::pair("stability.json", report.dump(2) + "\n"),
          std::pair("stability.csv", csvOf(report["cases"], kColumns))}) {
        if (Result<void> done = writeFileAtomically(folder / file, text); !done) {
            return done;
        }
    }
    return writePage(folder, "stability_report.py", "stability.json and stability.csv");
}

json namesOf(std::span<const Family> families) {
    json result = json::array();
    for (const Family& family : families) {
        result.push_back({{"name", family.name}, {"title", family.title}});
    }
    return result;
}

} // namespace

Result<void> stabilityCommand(const StabilityOptions& options, const std::string& command) {
    const auto start = std::chrono::steady_clock::now();
    const fs::path folder = options.outputFolder;
    const std::vector<Family> families = chosen(options.family);
    if (Result<void> made = makeReportFolder(folder / kPictureFolder); !made) {
        return made;
    }
    Result<Session> session = openSession();
    if (!session) {
        return tl::unexpected(session.error());
    }
    Result<Renderer> renderer = Renderer::create(session->caps);
    if (!renderer) {
        return tl::unexpected(renderer.error());
    }
    Bench bench(*renderer, session->caps, session->formats, options.reduced);
    runFamilies(bench, families);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    json report = {{"command", command},           {"commit", commit()},
                   {"date", timestamp()},          {"device", slabcast::toJson(session->caps)},
                   {"reduced", options.reduced},   {"seconds", seconds.count()},
                   {"families", namesOf(families)}};
    if (Result<void> done = writeReport(std::move(report), bench.cases(), folder); !done) {
        return done;
    }
    return stability::verdict(bench.cases()).map_error([&](Error error) {
        error.detail += fmt::format(" in {}", folder.string());
        return error;
    });
}

} // namespace slabcast
