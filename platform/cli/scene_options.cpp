#include "platform/cli/scene_options.h"

#include <cmath>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "core/volume/phantoms.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

namespace {

constexpr int kMaxEdge = 16384;
constexpr double kMaxDistanceRadii = 1e6; // rays are right up to here

std::optional<OrbitCamera> parseCamera(const std::string& word) {
    const auto parts = split(word, ',');
    if (parts.size() != 3) {
        return std::nullopt;
    }
    const auto azimuth = parseReal(parts[0]);
    const auto elevation = parseReal(parts[1]);
    const auto distance = parseReal(parts[2]);
    const auto isAngle = [](std::optional<double> degrees) {
        return degrees && std::abs(*degrees) <= 360.0;
    };
    if (!isAngle(azimuth) || !isAngle(elevation) || !distance ||
        !(*distance >= 0.0 && *distance <= kMaxDistanceRadii)) {
        return std::nullopt;
    }
    return OrbitCamera{*azimuth, *elevation, *distance};
}

std::optional<glm::ivec2> parseSize(const std::string& word) {
    const auto parts = split(word, 'x');
    if (parts.size() != 2) {
        return std::nullopt;
    }
    const auto width = parseInteger(parts[0]);
    const auto height = parseInteger(parts[1]);
    const auto isEdge = [](std::optional<std::int64_t> edge) {
        return edge && *edge >= 1 && *edge <= kMaxEdge;
    };
    return isEdge(width) && isEdge(height) ? std::optional(glm::ivec2(*width, *height))
                                           : std::nullopt;
}

/// Nothing where it cannot be read; a nothing within where there is to be no background.
std::optional<std::optional<glm::dvec3>> parseBackground(const std::string& word) {
    if (word == "none") {
        return std::optional<glm::dvec3>();
    }
    if (word.size() != 6 || word.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) {
        return std::nullopt;
    }
    const unsigned long rgb = std::stoul(word, nullptr, 16);
    return glm::dvec3(rgb >> 16 & 255U, rgb >> 8 & 255U, rgb & 255U) / 255.0;
}

std::string phantomNames() {
    std::vector<std::string> names;
    for (const PhantomInfo& phantom : phantomList()) {
        names.push_back(phantom.name);
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

} // namespace

const Choices<Classification>& classificationWords() {
    static const Choices<Classification> words = {{"post", Classification::Post},
                                                  {"preclassified", Classification::Pre},
                                                  {"preintegrated", Classification::Preintegrated}};
    return words;
}

const Choices<TargetFormat>& targetWords() {
    static const Choices<TargetFormat> words = {{"rgba8", TargetFormat::Rgba8},
                                                {"rgba16f", TargetFormat::Rgba16f}};
    return words;
}

const Choices<SegmentForm>& formWords() {
    static const Choices<SegmentForm> words = {{"auto", SegmentForm::Auto},
                                               {"unrolled", SegmentForm::Unrolled},
                                               {"loop", SegmentForm::Loop}};
    return words;
}

const Choices<bool>& onOffWords() {
    static const Choices<bool> words = {{"off", false}, {"on", true}};
    return words;
}

std::optional<std::optional<double>> parseTermination(const std::string& word) {
    if (word == "off") {
        return std::optional<double>();
    }
    const auto opacity = parseReal(word);
    if (!opacity || !(*opacity > 0.0 && *opacity <= 1.0)) {
        return std::nullopt;
    }
    return opacity;
}

void bindInput(CLI::App& command, InputOptions& o) {
    command
        .add_option("VOLUME", o.volume,
                    fmt::format("a file (NRRD, NIfTI, MetaImage, TIFF), a folder (DICOM, images), "
                                "or phantom:NAME[:SIZE] "
                                "with a NAME of {} and a SIZE as 128 or 256x256x64",
                                phantomNames()))
        ->required();
    const auto group = "Volume";
    command
        .add_option("--series", o.series, "the DICOM series to take, where a folder holds several")
        ->type_name("UID")
        ->group(group);
    command
        .add_option("--raw", o.raw,
                    "layout of a file without header, as 256x256x128,uint16,1x1x1.5")
        ->type_name("DIMS,TYPE,SPACING")
        ->group(group);
    addNumber(command, "--downsample", o.downsample, 1, 1024,
              "average blocks of N voxels along each axis")
        ->type_name("N")
        ->default_str("1")
        ->group(group);
}

void bindTexture(CLI::App& command, InputOptions& o) {
    const auto group = "Volume";
    command
        .add_flag(
            "--exact", o.exact,
            "keep every voxel exactly: 8 fetches per sample instead of the texture unit's filter")
        ->group(group);
    addNumber(command, "--gpu-budget", o.gpuBudgetMib, 0.001, 1e9,
              "refuse a volume whose texture takes more, and name the --downsample that fits")
        ->type_name("MIB")
        ->default_str("what the device can")
        ->group(group);
}

void bindCamera(CLI::App& command, SceneOptions& o) {
    const auto group = "Picture and camera";
    addParsed<glm::ivec2>(command, "--size", o.size, parseSize,
                          fmt::format("WIDTHxHEIGHT in pixels, each from 1 to {}", kMaxEdge),
                          "in pixels")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", o.size.x, o.size.y))
        ->group(group);
    addParsed<OrbitCamera>(
        command, "--camera", o.camera, parseCamera,
        "AZ,EL,DIST: two angles from -360 to 360 degrees and a distance from 0 to 1e6",
        "azimuth and elevation in degrees, distance in bounding-sphere radii; azimuth 0 sees the "
        "face")
        ->type_name("AZ,EL,DIST")
        ->default_str(fmt::format("{:g},{:g},{:g}", o.camera.azimuthDegrees,
                                  o.camera.elevationDegrees, o.camera.distanceRadii))
        ->group(group);
    addNumber(command, "--fov", o.fovDegrees, 0.01, 179.0, "vertical field of view in degrees")
        ->type_name("DEG")
        ->default_str(fmt::format("{:g}", o.fovDegrees))
        ->group(group);
}

void bindEyes(CLI::App& command, SceneOptions& o) {
    const auto group = "Picture and camera";
    addNumber(command, "--stereo", o.stereoIpdMm, 0.0, 1e6,
              "two eyes this far apart, side by side, each of half the width; 63 for people")
        ->type_name("IPD_MM")
        ->default_str("off")
        ->group(group);
}

void bindBackground(CLI::App& command, SceneOptions& o) {
    addParsed<std::optional<glm::dvec3>>(
        command, "--background", o.background, parseBackground, "RRGGBB in hexadecimal, or none",
        "what is behind the volume, or none for a transparent picture")
        ->type_name("RRGGBB|none")
        ->default_str("000000")
        ->group("Picture and camera");
}

void bindLook(CLI::App& command, SceneOptions& o) {
    const auto group = "Look";
    command
        .add_option("--tf", o.tf,
                    fmt::format("transfer function: a .json file or a preset, one of {}",
                                fmt::join(presetNames(), ", ")))
        ->type_name("NAME|FILE")
        ->default_str("by modality and range")
        ->group(group);
    addChoice(command, "--space", o.settings.space,
              {{"display", CompositingSpace::Display}, {"linear", CompositingSpace::Linear}},
              "blend encoded values as most viewers do, or light")
        ->group(group);
}

void bindShading(CLI::App& command, Settings& s) {
    addChoice(command, "--shade", s.shaded, {{"off", false}, {"phong", true}},
              "Blinn-Phong with a head light")
        ->group("Look");
}

void bindStack(CLI::App& command, SceneOptions& o) {
    Settings& s = o.settings;
    const auto group = kLayersGroup;
    addChoice(command, "--lattice", s.lattice,
              {{"planar", LatticeKind::Planar}, {"shells", LatticeKind::Shells}},
              "layers at equal depth, or at equal distance from the eye")
        ->group(group);
    addChoice(command, "--form", s.form, formWords(),
              "segments written out layer by layer, or as a loop; auto goes by device and length")
        ->group(group);
    addChoice(command, "--order", s.order,
              {{"auto", std::nullopt},
               {"back-to-front", BlendOrder::BackToFront},
               {"front-to-back", BlendOrder::FrontToBack}},
              "planes over each other, or nearest first, which leaves out what is behind opaque "
              "material; auto goes by how soon a ray can be opaque")
        ->group(group);
    addChoice(command, "--tighten", s.tighten, {{"on", true}, {"off", false}},
              "planes as rectangles around what is visible in their slab, or the sphere's 10-gons")
        ->group(group);
}

void bindSampling(CLI::App& command, Settings& s) {
    const auto look = "Look";
    addChoice(command, "--classify", s.classification, classificationWords(),
              "colours looked up after filtering voxels, filtered themselves, or integrated over "
              "each layer beforehand")
        ->group(look);
    addChoice(command, "--target", s.target, targetWords(), "what planes are blended into")
        ->group(look);
    const auto group = kLayersGroup;
    addNumber(command, "--layer-spacing", s.layerSpacingVoxels, kLeastSpacing, kMostSpacing,
              "distance of layers in units of the smallest voxel edge")
        ->type_name("VOXELS")
        ->default_str(fmt::format("{:g}", s.layerSpacingVoxels))
        ->group(group);
    addChoice(command, "--jitter", s.jitter, onOffWords(),
              "move every ray's layers by up to half a layer: grain where few layers would band")
        ->group(group);
    addParsed<std::optional<double>>(command, "--termination", s.termination, parseTermination,
                                     kTerminationNeeded,
                                     "opacity at which a segment is left and, front to back, a "
                                     "ray, or off: the picture lacks at most what it lacks of 1")
        ->type_name("A|off")
        ->default_str(fmt::format("{:.4f}", s.termination.value_or(1.0)))
        ->group(group);
}

void bindScene(CLI::App& command, SceneOptions& o) {
    bindInput(command, o.input);
    bindTexture(command, o.input);
    bindCamera(command, o);
    bindEyes(command, o);
    bindLook(command, o);
    bindShading(command, o.settings);
    bindSampling(command, o.settings);
    bindStack(command, o);
}

void bindLayersPerPlane(CLI::App& command, Settings& s, const char* help, const char* usually) {
    addNumber(command, "--layers-per-plane", s.layersPerPlane, 1, kMaxLayers, help)
        ->type_name("N")
        ->default_str(usually)
        ->group(kLayersGroup);
}

} // namespace slabcast
