#include <fmt/core.h>

#include "platform/cli/commands.h"

namespace {

/// Exit status as documented: 0 done, 1 failed with one line on stderr, 2 bad usage.
int finished(const slabcast::Result<void>& result) {
    if (result) {
        return 0;
    }
    fmt::print(stderr, "slabcast: {}\n", result.error().detail);
    return 1;
}

std::string commandLine(int argc, char** argv) {
    std::string line = "slabcast";
    for (int k = 1; k < argc; ++k) {
        line += std::string(" ") + argv[k];
    }
    return line;
}

} // namespace

int main(int argc, char** argv) {
    using namespace slabcast;
    CLI::App app("Slabcast draws volumes (CT, MR, simulation) on GLES 3.2 class GPUs.\n"
                 "Start with: slabcast render phantom:marschner-lobb -o picture.png\n",
                 "slabcast");
    app.require_subcommand(1);
    app.set_help_all_flag("--help-all", "help of all commands");

    RenderOptions render;
    CLI::App* renderApp = app.add_subcommand("render", "draw a picture");
    bindScene(*renderApp, render);
    renderApp->add_option("-o,--output", render.output, "picture to write: .png or .exr")->required();
    auto* layers = renderApp->add_option("--layers", render.settings.totalLayers, "total layers instead of --layer-spacing");
    layers->check(CLI::Range(1, 1 << 20));
    renderApp->add_option("--planes", render.settings.planes,
                          "proxy planes: 1 is ray casting, as many as layers is slicing; by default measured")
        ->check(CLI::Range(1, 1 << 20));
    renderApp->add_option("--frames", render.frames, "turn the volume once around in this many frames and time them; the first is written")
        ->check(CLI::Range(1, 100000));
    renderApp->add_option("--stats", render.statsFile, "write device, plan, frame times and work counters as JSON");
    renderApp->add_flag("--explain", render.explain, "print what the plan chose and why");

    SweepOptions sweep;
    sweep.size = {512, 512};
    CLI::App* sweepApp = app.add_subcommand("sweep", "measure the planes to layers ratio, with and without skipping");
    bindScene(*sweepApp, sweep);
    sweepApp->add_option("--layers", sweep.layersPerPlane, "layers per plane to measure, as 1,2,4,8; 0 is all in one plane")
        ->delimiter(',')
        ->check(CLI::Range(0, 1 << 20));
    sweepApp->add_option("--frames", sweep.frames, "frames of one turn per row")->check(CLI::Range(1, 10000))->capture_default_str();
    sweepApp->add_option("--out", sweep.outputFolder, "folder for sweep.json, sweep.csv and report.html")->required();

    InputOptions info;
    CLI::App* infoApp = app.add_subcommand("info", "what a volume is and what drawing it takes");
    bindInput(*infoApp, info);
    CLI::App* deviceApp = app.add_subcommand("device", "what the GPU can do, which texel formats were chosen and why");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (*renderApp) {
        return finished(renderCommand(render));
    }
    if (*sweepApp) {
        return finished(sweepCommand(sweep, commandLine(argc, argv)));
    }
    if (*infoApp) {
        return finished(infoCommand(info));
    }
    return *deviceApp ? finished(deviceCommand()) : 2;
}
