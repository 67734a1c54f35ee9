#include "platform/cli/scene_options.h"

#include <cmath>
#include <filesystem>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "core/scene/known_devices.h"
#include "core/volume/phantoms.h"
#include "platform/io/load_volume.h"
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

std::optional<std::optional<glm::dvec3>> parseSpacing(const std::string& word) {
    const auto parts = split(word, ',');
    glm::dvec3 spacing(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto length = parts.size() == 3 ? parseReal(parts[axis]) : std::nullopt;
        if (!length || !std::isfinite(*length) || *length <= 0.0) {
            return std::nullopt;
        }
        spacing[axis] = *length;
    }
    return std::optional(spacing);
}

/// Nothing where it cannot be read; a nothing within where there is to be no background.
std::optional<std::optional<glm::dvec3>> parseBackground(const std::string& word) {
    if (word == "none") {
        return std::optional<glm::dvec3>();
    }
    const std::string digits = word.substr(word.starts_with('#') ? 1 : 0);
    if (digits.size() != 6 ||
        digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) {
        return std::nullopt;
    }
    const unsigned long rgb = std::stoul(digits, nullptr, 16);
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

void bindReportFolder(Command& command, FolderOptions& folder, const std::string& what) {
    addText(command,
            {.flag = "--out",
             .help = "folder for " + what,
             .word = "FOLDER",
             .group = "Output",
             .required = true},
            folder.path);
    addFlag(
        command,
        {.flag = "--fresh",
         .help =
             "start anew in a folder that holds another run: its tables and its page are removed",
         .group = "Output"},
        folder.fresh);
}

namespace {

/// Where a volume comes from decides which of its options mean anything.
Result<void> checkInput(const InputOptions& o, const Given& given) {
    std::error_code error;
    const bool phantom = o.volume.starts_with("phantom:");
    const bool file = !phantom && std::filesystem::is_regular_file(o.volume, error);
    for (const char* flag :
         {"--raw", "--series", "--select", "--time", "--resample", "--spacing", "--unit"}) {
        if (phantom && given(flag)) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: does nothing beside {}, which is no file: leave it out",
                                    flag, o.volume));
        }
    }
    if (file && given("--series")) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("--series: does nothing beside {}, which is no folder: leave it "
                                "out",
                                o.volume));
    }
    return {};
}

} // namespace

void bindInput(Command& command, InputOptions& o) {
    const auto group = "Volume";
    addText(command,
            {.flag = "VOLUME",
             .help = fmt::format("a file (NRRD, NIfTI, MetaImage, TIFF), a folder (DICOM, images), "
                                 "or phantom:NAME[:SIZE] with a NAME of {} and a SIZE as 128 or "
                                 "256x256x64",
                                 phantomNames()),
             .required = true},
            o.volume);
    addText(command,
            {.flag = "--series",
             .help = "the DICOM series to take, where a folder holds several",
             .word = "UID",
             .group = group},
            o.load.series);
    command.options.push_back(
        {.flag = "--select",
         .help = "of several images at each place, those with these properties, as EchoTime=20",
         .word = "KEY=VALUE,...",
         .group = group,
         .take = [&o](const std::string& word) -> Result<void> {
             return parseSelections(word).map(
                 [&](const std::vector<Selection>& all) { o.load.select = all; });
         }});
    addNumber(command,
              {.flag = "--time",
               .help = "of several volumes over time, the one to take, from 0",
               .word = "N",
               .group = group},
              o.load.time, 0, 1 << 24);
    addFlag(command,
            {.flag = "--resample",
             .help = "bring slices that lie at uneven distances to even ones, instead of refusing "
                     "them",
             .group = group},
            o.load.resampleUneven);
    addParsed(command,
              {.flag = "--spacing",
               .help = "distances between voxels in mm, in place of the file's",
               .word = "X,Y,Z",
               .group = group},
              o.load.spacingMm, parseSpacing, "X,Y,Z: three positive distances in mm");
    addText(command,
            {.flag = "--unit",
             .help = "unit of the values, as HU, in place of the file's",
             .word = "UNIT",
             .group = group},
            o.load.unit);
    command.options.push_back(
        {.flag = "--raw",
         .help = "layout of a file without header, as 256x256x128,uint16,1x1x1.5",
         .word = "DIMS,TYPE,SPACING",
         .group = group,
         .hides = {"--series", "--select", "--time", "--resample"},
         .take = [&o](const std::string& word) -> Result<void> {
             return parseRawLayout(word).map([&](const RawLayout& layout) { o.load.raw = layout; });
         }});
    addNumber(command,
              {.flag = "--skip-bytes",
               .help = "length of a header that is left out before the voxels",
               .word = "N",
               .usually = "0",
               .group = group,
               .needs = {"--raw"}},
              o.load.rawSkipBytes, 0, std::int64_t{1} << 50);
    addNumber(command,
              {.flag = "--downsample",
               .help = "average blocks of N voxels along each axis",
               .word = "N",
               .usually = "1",
               .group = group},
              o.downsample, 1, 1024);
    command.checks.emplace_back([&o](const Given& given) { return checkInput(o, given); });
}

void bindTexture(Command& command, InputOptions& o) {
    const auto group = "Volume";
    addFlag(command,
            {.flag = "--exact",
             .help = "keep every voxel exactly: 8 fetches per sample instead of the texture unit's "
                     "filter",
             .group = group},
            o.exact);
    addNumber(command,
              {.flag = "--gpu-budget",
               .help = "refuse a volume whose texture takes more, and name the --downsample that "
                       "fits",
               .word = "MIB",
               .usually = "what the device can",
               .group = group},
              o.gpuBudgetMib, 0.001, 1e9);
}

void bindCamera(Command& command, SceneOptions& o) {
    const auto group = "Picture and camera";
    addParsed(command,
              {.flag = "--size",
               .help = "in pixels",
               .word = "WxH",
               .usually = fmt::format("{}x{}", o.size.x, o.size.y),
               .group = group},
              o.size, parseSize,
              fmt::format("WIDTHxHEIGHT in pixels, each from 1 to {}", kMaxEdge));
    addParsed(command,
              {.flag = "--camera",
               .help = "azimuth and elevation in degrees, distance in bounding-sphere radii; "
                       "azimuth 0 sees the face",
               .word = "AZ,EL,DIST",
               .usually = fmt::format("{:g},{:g},{:g}", o.camera.azimuthDegrees,
                                      o.camera.elevationDegrees, o.camera.distanceRadii),
               .group = group},
              o.camera, parseCamera,
              "AZ,EL,DIST: two angles from -360 to 360 degrees and a distance from 0 to 1e6");
    addNumber(command,
              {.flag = "--fov",
               .help = "vertical field of view in degrees",
               .word = "DEG",
               .usually = fmt::format("{:g}", o.fovDegrees),
               .group = group},
              o.fovDegrees, 0.01, 179.0);
}

void bindEyes(Command& command, SceneOptions& o) {
    addNumber(command,
              {.flag = "--stereo",
               .help = "two eyes this far apart, side by side, each of half the width; 63 for "
                       "people",
               .word = "IPD_MM",
               .usually = "off",
               .group = "Picture and camera"},
              o.stereoIpdMm, 0.0, 1e6);
}

void bindBackground(Command& command, SceneOptions& o) {
    addParsed(command,
              {.flag = "--background",
               .help = "what is behind the volume, or none for a transparent picture",
               .word = "RRGGBB|none",
               .usually = "000000",
               .group = "Picture and camera"},
              o.background, parseBackground,
              "RRGGBB in hexadecimal, with or without # before it, or none");
}

void bindTransfer(Command& command, SceneOptions& o) {
    addText(command,
            {.flag = "--tf",
             .help = fmt::format("transfer function: a .json file or a preset, one of {}",
                                 fmt::join(presetNames(), ", ")),
             .word = "NAME|FILE",
             .usually = "by modality and range",
             .group = "Look"},
            o.tf);
    command.checks.emplace_back([&o](const Given&) -> Result<void> {
        const std::vector<std::string> known = presetNames();
        if (o.tf.empty() || o.tf.ends_with(".json") ||
            std::find(known.begin(), known.end(), o.tf) != known.end()) {
            return {};
        }
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("--tf: '{}' is not one of {}, or the name of a .json file", o.tf,
                                fmt::join(known, ", ")));
    });
}

void bindDevice(Command& command, SessionOptions& o) {
    Choices<std::string> names;
    for (const KnownDevice& known : knownDevices()) {
        names.emplace_back(known.name, known.name);
    }
    addChoice(command,
              {.flag = "--device",
               .help = "assume what this device can do instead of asking and testing the one that "
                       "is there; for compilers of devices that are not at hand: " +
                       knownDeviceNames(),
               .group = "Device"},
              o.device, names)
        .word = "NAME";
}

void bindScene(Command& command, SceneOptions& o) {
    bindInput(command, o.input);
    bindTexture(command, o.input);
    bindCamera(command, o);
    bindEyes(command, o);
    bindTransfer(command, o);
    bindDevice(command, o.session);
}

} // namespace slabcast
