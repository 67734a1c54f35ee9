#include "perf/error/error_report.h"
#include "perf/error/error_table_json.h"
#include "platform/cli/command_line.h"
#include "platform/cli/commands.h"
#include "platform/cli/error_table_file.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"

namespace slabcast {

namespace {

/// Into the table that `render --target-error` reads. The report is there already: what goes wrong
/// is only said.
void refreshTable(const Stage& stage, const std::vector<MeasuredError>& measured) {
    if (!hasUsualSettings(stage.desc())) {
        say("the table for --target-error is left as it was: it holds what was measured without "
            "--skip, its parameters, --tighten, --lattice, --form and --exact");
        return;
    }
    if (const Result<void> done = refreshErrorTable(stage.caps(), measured); !done) {
        say(done.error().detail);
    }
}

} // namespace

Result<void> errorCommand(const ErrorOptions& given, const std::string& command) {
    ErrorOptions options = given;
    options.background.reset();
    options.input.keepValues = true;
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage& stage = opened->stage;
    DiskFolder folder(options.folder, kErrorPictures);
    if (Result<void> made = folder.make("error.json"); !made) {
        return made;
    }
    const auto commandOf = [&options](const Sampling& sampling, const FramePlan& plan,
                                      const std::string& file) {
        return renderCommandLine(options, sampling, plan, file);
    };
    const ErrorDesc desc{.axes = completed(options.axes, options.quick),
                         .quick = options.quick,
                         .frames = options.frames,
                         .verification = options.verification.value_or(!options.quick),
                         .commandOf = commandOf};
    const Result<std::vector<MeasuredError>> measured =
        measureErrors(stage, desc, runOf(command), folder);
    if (!measured) {
        return tl::unexpected(measured.error());
    }
    const Result<void> page = folder.makePage("error_report.py", "error.json and error.csv");
    refreshTable(stage, *measured);
    return page;
}

} // namespace slabcast
