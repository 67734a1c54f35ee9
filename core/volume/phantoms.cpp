#include "core/volume/phantoms.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/parallel.h"
#include "core/volume/phantom_vessels.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr std::string_view kPrefix = "phantom:";
constexpr int kDefaultSize = 128;
constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 30;
constexpr std::int64_t kRowGrain = 64;

/// The centre of a voxel.
struct Place {
    glm::ivec3 voxel;
    glm::dvec3 uvw;
    glm::dvec3 centred; // from the box's centre, in halves of its shortest edge
    double voxelEdge;   // in the same unit
};

/// How much of a voxel lies inside a surface at this signed distance (negative inside): a linear
/// edge one voxel wide, whose half value is the surface.
double inside(double distance, double voxelEdge) {
    return std::clamp(0.5 - distance / voxelEdge, 0.0, 1.0);
}

/// Source: Marschner and Lobb 1994, section 5: alpha 0.25, fM 6.
double marschnerLobb(const Place& place) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kAlpha = 0.25;
    constexpr double kFm = 6.0;
    const glm::dvec3 p = place.centred;
    const double radial = std::cos(2.0 * kPi * kFm * std::cos(0.5 * kPi * std::hypot(p.x, p.y)));
    return (1.0 - std::sin(0.5 * kPi * p.z) + kAlpha * (1.0 + radial)) / (2.0 * (1.0 + kAlpha));
}

double shells(const Place& place) {
    struct Shell {
        double innerRadius;
        double outerRadius;
        double value;
    };
    constexpr std::array kShells{Shell{-1.0, 0.25, 255.0}, Shell{0.45, 0.55, 170.0},
                                 Shell{0.75, 0.85, 85.0}};
    const double radius = glm::length(place.centred);
    double value = 0.0;
    for (const Shell& shell : kShells) {
        const double distance = std::max(shell.innerRadius - radius, radius - shell.outerRadius);
        value = std::max(value, shell.value * inside(distance, place.voxelEdge));
    }
    return value;
}

double vessels(const Place& place) {
    return 3000.0 * inside(vesselDistance(place.centred, place.voxelEdge), place.voxelEdge);
}

double constant(const Place& /*place*/) {
    return 100.0;
}

double ramp(const Place& place) {
    return place.uvw.x;
}

double checkerboard(const Place& place) {
    constexpr int kEdge = 8; // voxels
    const glm::ivec3 square = place.voxel / kEdge;
    return (square.x + square.y + square.z) % 2 == 0 ? 0.0 : 255.0;
}

double sphere(const Place& place) {
    return 255.0 * inside(glm::length(place.centred) - 0.8, place.voxelEdge);
}

/// A matrix of 900 that fills the box, with eight pores of 300 towards its corners and a vessel
/// tree of 1500 in its middle: under a transfer function that shows the outer two alone the bulk
/// lies in the gap, as in a casting of which voids and inclusions are looked for. Pores and tree do
/// not meet, so borders pass 300 to 900 and 900 to 1500, and no value outside.
double gap(const Place& place) {
    constexpr double kTree = 0.6; // of its own size: within 0.6 along each axis
    constexpr glm::dvec3 kPore(0.75);
    constexpr double kPoreRadius = 0.2;
    const double tree = kTree * vesselDistance(place.centred / kTree, place.voxelEdge / kTree);
    const double pore = glm::distance(glm::abs(place.centred), kPore) - kPoreRadius;
    return 900.0 + 600.0 * inside(tree, place.voxelEdge) - 600.0 * inside(pore, place.voxelEdge);
}

struct Phantom {
    const char* name;
    const char* description;
    VoxelType type;
    double (*storedValue)(const Place&);
};

constexpr std::array kPhantoms{
    Phantom{"marschner-lobb", "the Marschner-Lobb signal, 0 to 1, near the limit of sampling at 40",
            VoxelType::F32, marschnerLobb},
    Phantom{"shells", "a ball of 255 in shells of 170 and 85", VoxelType::U8, shells},
    Phantom{"vessels", "a branching vessel tree of 3000 in 0", VoxelType::U16, vessels},
    Phantom{"constant", "100 everywhere", VoxelType::U8, constant},
    Phantom{"ramp", "linear along x, 0 at the one face and 1 at the other", VoxelType::F32, ramp},
    Phantom{"checkerboard", "cubes of 8 voxels, 0 and 255 in turn", VoxelType::U8, checkerboard},
    Phantom{"gap",
            "vessels of 1500 and pores of 300 in a matrix of 900, which the preset gap hides",
            VoxelType::U16, gap},
    Phantom{"sphere", "a ball of 255 in 0, 0.8 of the shortest edge across", VoxelType::U8, sphere},
};

std::string nameList() {
    std::string names;
    for (const Phantom& phantom : kPhantoms) {
        names += (names.empty() ? "" : ", ") + std::string(phantom.name);
    }
    return names;
}

/// One, or three joined by `x`, of numbers without a sign; nothing where the text is anything else.
std::optional<glm::i64vec3> parsedSize(std::string_view text) {
    std::vector<std::int64_t> sizes;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data();; ++at) {
        std::uint32_t size = 0;
        const auto [next, error] = std::from_chars(at, end, size);
        if (error == std::errc::result_out_of_range) {
            size = std::numeric_limits<std::uint32_t>::max(); // too large, to be told as such
        } else if (error != std::errc{}) {
            return std::nullopt;
        }
        sizes.push_back(size);
        at = next;
        if (at == end) {
            break;
        }
        if (*at != 'x') {
            return std::nullopt;
        }
    }
    if (sizes.size() == 1) {
        return glm::i64vec3(sizes[0]);
    }
    return sizes.size() == 3 ? std::optional(glm::i64vec3(sizes[0], sizes[1], sizes[2]))
                             : std::nullopt;
}

Result<glm::ivec3> dimsFrom(std::string_view text) {
    const std::optional<glm::i64vec3> dims = parsedSize(text);
    if (!dims) {
        return fail(ErrorCode::InvalidArgument, "phantom size '" + std::string(text) +
                                                    "' is not a size; give 128 or 256x256x64");
    }
    // Bytes of a one-byte voxel are voxels.
    const Result<std::int64_t> voxels = checkedByteCount(*dims, VoxelType::U8);
    if (!voxels) {
        return tl::unexpected<Error>(voxels.error());
    }
    if (*voxels > kMaxVoxels) {
        return fail(ErrorCode::SizeOverflow, "phantom size '" + std::string(text) +
                                                 "' is over 2^30 voxels; ask for 1024 or less");
    }
    return glm::ivec3(*dims);
}

VolumeGeometry centredGeometry(glm::ivec3 dims) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    geometry.originMm = -0.5 * (glm::dvec3(dims) - 1.0);
    return geometry;
}

template <class T>
void fill(const Phantom& phantom, glm::ivec3 dims, std::span<T> voxels) {
    const double voxelEdge = 2.0 / std::min({dims.x, dims.y, dims.z});
    const glm::dvec3 size(dims);
    parallelFor(
        std::int64_t{dims.y} * dims.z, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                for (int x = 0; x < dims.x; ++x) {
                    const glm::ivec3 voxel(x, row % dims.y, row / dims.y);
                    const glm::dvec3 uvw = (glm::dvec3(voxel) + 0.5) / size;
                    const glm::dvec3 centred = (uvw - 0.5) * size * voxelEdge;
                    const double value = phantom.storedValue({voxel, uvw, centred, voxelEdge});
                    voxels[static_cast<std::size_t>(row * dims.x + x)] =
                        static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
                }
            }
        });
}

} // namespace

std::vector<PhantomInfo> phantomList() {
    std::vector<PhantomInfo> list;
    for (const Phantom& phantom : kPhantoms) {
        list.push_back({phantom.name, phantom.description});
    }
    return list;
}

Result<Volume> makePhantom(std::string_view spec) {
    if (spec.substr(0, kPrefix.size()) != kPrefix) {
        return fail(ErrorCode::InvalidArgument,
                    std::string("'").append(spec) + "' is no phantom; write phantom:NAME:SIZE");
    }
    spec.remove_prefix(kPrefix.size());
    const std::size_t colon = spec.find(':');
    const std::string_view asked = spec.substr(0, colon);
    const auto* phantom =
        std::find_if(kPhantoms.begin(), kPhantoms.end(),
                     [&](const Phantom& candidate) { return asked == candidate.name; });
    if (phantom == kPhantoms.end()) {
        return fail(ErrorCode::InvalidArgument,
                    "there is no phantom '" + std::string(asked) + "'; choose of " + nameList());
    }
    const Result<glm::ivec3> dims = colon == std::string_view::npos
                                        ? Result<glm::ivec3>(glm::ivec3(kDefaultSize))
                                        : dimsFrom(spec.substr(colon + 1));
    if (!dims) {
        return tl::unexpected<Error>(dims.error());
    }
    Volume volume;
    volume.name = phantom->name;
    volume.type = phantom->type;
    volume.geometry = centredGeometry(*dims);
    volume.voxels.resize(static_cast<std::size_t>(volume.geometry.voxelCount()) *
                         bytesPerVoxel(volume.type));
    visitVoxels(volume, [&]<class T>(std::span<T> voxels) { fill(*phantom, *dims, voxels); });
    return volume;
}

} // namespace slabcast
