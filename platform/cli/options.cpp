#include "platform/cli/options.h"

#include <map>

#include <fmt/core.h>

namespace slabcast {

namespace {

/// Exactly three numbers separated by commas.
glm::dvec3 parseTriple(const std::string& text) {
    glm::dvec3 value;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &value.x, &value.y, &value.z, &rest) != 3) {
        throw CLI::ValidationError(text, "three numbers separated by commas are needed");
    }
    return value;
}

glm::ivec2 parseSize(const std::string& text) {
    glm::ivec2 size(0);
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &size.x, &size.y, &rest) != 2 || size.x < 1 || size.y < 1 ||
        size.x > 16384 || size.y > 16384) {
        throw CLI::ValidationError(text, "WIDTHxHEIGHT in pixels is needed, each from 1 to 16384");
    }
    return size;
}

std::optional<glm::dvec3> parseBackground(const std::string& text) {
    if (text == "none") {
        return std::nullopt;
    }
    unsigned rgb = 0;
    char rest = 0;
    if (text.size() != 6 || std::sscanf(text.c_str(), "%6x%c", &rgb, &rest) != 1) {
        throw CLI::ValidationError(text, "RRGGBB in hexadecimal or none is needed");
    }
    return glm::dvec3(rgb >> 16 & 255U, rgb >> 8 & 255U, rgb & 255U) / 255.0;
}

std::optional<double> parseTermination(const std::string& text) {
    double value = 0.0;
    char rest = 0;
    if (text == "off") {
        return std::nullopt;
    }
    if (std::sscanf(text.c_str(), "%lf%c", &value, &rest) != 1 || !(value > 0.0 && value <= 1.0)) {
        throw CLI::ValidationError(text, "an opacity above 0 and up to 1, or off, is needed");
    }
    return value;
}

/// An option whose words stand for values.
template <class T>
CLI::Option* addChoice(CLI::App& command, const char* flag, const std::map<std::string, T>& choices,
                       std::function<void(T)> set, const char* help) {
    std::vector<std::string> words;
    for (const auto& [word, value] : choices) {
        words.push_back(word);
    }
    return command
        .add_option_function<std::string>(flag, [=](const std::string& word) { set(choices.at(word)); }, help)
        ->check(CLI::IsMember(words));
}

void bindCamera(CLI::App& command, SceneOptions& o) {
    command
        .add_option_function<std::string>(
            "--camera",
            [&o](const std::string& text) {
                const glm::dvec3 v = parseTriple(text);
                o.camera = {v.x, v.y, v.z};
            },
            "azimuth and elevation in degrees, distance in bounding-sphere radii; azimuth 0 sees the face")
        ->type_name("AZ,EL,DIST")
        ->default_str("0,10,2.5");
    command.add_option("--fov", o.fovDegrees, "vertical field of view in degrees")
        ->type_name("DEG")
        ->check(CLI::Range(0.01, 179.0))
        ->capture_default_str();
    command.add_option("--stereo", o.stereoIpdMm, "two eyes this far apart, side by side, each of half the width")
        ->type_name("IPD_MM")
        ->check(CLI::Range(0.0, 1e6));
    command
        .add_option_function<std::string>(
            "--background", [&o](const std::string& text) { o.background = parseBackground(text); },
            "what is behind the volume, or none for a transparent picture")
        ->type_name("RRGGBB")
        ->default_str("000000");
    command
        .add_option_function<std::string>(
            "--size", [&o](const std::string& text) { o.size = parseSize(text); }, "picture size in pixels")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", o.size.x, o.size.y));
}

void bindLook(CLI::App& command, SceneOptions& o) {
    Settings& s = o.settings;
    command.add_option("--tf", o.tf, "transfer function: a preset (ct-bone, ct-bone-skin, ct-lung, mr, angio, linear) "
                                     "or a JSON file; by default chosen by modality and range");
    addChoice<Classification>(command, "--classify",
                              {{"post", Classification::Post}, {"preclassified", Classification::Pre}},
                              [&s](Classification c) { s.classification = c; },
                              "classify interpolated values, or interpolate classified texels (default: post)");
    addChoice<bool>(command, "--shade", {{"off", false}, {"phong", true}}, [&s](bool on) { s.shaded = on; },
                    "Blinn-Phong with a head light (default: off)");
    addChoice<CompositingSpace>(command, "--space",
                                {{"display", CompositingSpace::Display}, {"linear", CompositingSpace::Linear}},
                                [&s](CompositingSpace v) { s.space = v; },
                                "blend encoded values as most viewers do, or light (default: display)");
    addChoice<TargetFormat>(command, "--target", {{"rgba8", TargetFormat::Rgba8}, {"rgba16f", TargetFormat::Rgba16f}},
                            [&s](TargetFormat v) { s.target = v; }, "what planes are blended into (default: rgba8)");
}

void bindLayers(CLI::App& command, SceneOptions& o) {
    Settings& s = o.settings;
    command.add_option("--layer-spacing", s.layerSpacingVoxels, "distance of layers in units of the smallest voxel edge")
        ->type_name("VOXELS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    addChoice<LatticeKind>(command, "--lattice", {{"planar", LatticeKind::Planar}, {"shells", LatticeKind::Shells}},
                           [&s](LatticeKind v) { s.lattice = v; },
                           "layers at equal depth or at equal distance from the eye (default: planar)");
    addChoice<SegmentForm>(command, "--form",
                           {{"auto", SegmentForm::Auto}, {"unrolled", SegmentForm::Unrolled}, {"loop", SegmentForm::Loop}},
                           [&s](SegmentForm v) { s.form = v; },
                           "segments written out layer by layer, or as a loop (default: auto, by device and length)");
    addChoice<std::optional<SkipStructure>>(
        command, "--skip",
        {{"auto", std::nullopt}, {"none", SkipStructure::None}, {"proximity", SkipStructure::Proximity}},
        [&s](std::optional<SkipStructure> v) { s.skip = v; },
        "how empty space is skipped; never changes the picture (default: auto, by what is visible)");
    command.add_option("--skip-block", o.skipBlockEdge, "edge of the skip structure's blocks in voxels")
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
    addChoice<bool>(command, "--tighten", {{"on", true}, {"off", false}}, [&s](bool on) { s.tighten = on; },
                    "planes as rectangles around what is visible in their slab, or the sphere's 10-gons (default: on)");
    command
        .add_option_function<std::string>(
            "--termination", [&s](const std::string& text) { s.termination = parseTermination(text); },
            "opacity at which a segment is left, or off")
        ->type_name("A")
        ->default_str("0.9995");
}

} // namespace

void bindInput(CLI::App& command, InputOptions& o) {
    command.add_option("VOLUME", o.volume, "a file (NRRD, NIfTI, MetaImage, TIFF), a folder (DICOM, images), or phantom:NAME[:SIZE]")
        ->required();
    command.add_option("--series", o.series, "the DICOM series to take, where a folder holds several");
    command.add_option("--raw", o.raw, "layout of a file without header, as 256x256x128,uint16,1x1x1.5")
        ->type_name("DIMS,TYPE,SPACING");
    command.add_option("--downsample", o.downsample, "average blocks of N voxels along each axis")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    command.add_flag("--exact", o.exact, "keep every voxel exactly: 8 fetches per sample instead of the texture unit's filter");
    command.add_option("--gpu-budget", o.gpuBudgetMib, "refuse volumes whose texture is larger than this")
        ->type_name("MIB")
        ->check(CLI::PositiveNumber);
}

void bindScene(CLI::App& command, SceneOptions& o) {
    bindInput(command, o.input);
    bindCamera(command, o);
    bindLook(command, o);
    bindLayers(command, o);
}

} // namespace slabcast
