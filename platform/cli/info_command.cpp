#include <cmath>

#include <fmt/core.h>

#include "platform/cli/advice.h"
#include "platform/cli/commands.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

namespace {

double mib(std::int64_t bytes) {
    return static_cast<double>(bytes) / 1048576.0;
}

const char* modalityName(Modality modality) {
    return modality == Modality::Ct ? "CT" : modality == Modality::Mr ? "MR" : "unknown";
}

/// Distance of data values that a volume holds apart near this one; 0: any two numbers.
double resolutionAt(const Volume& volume, double value) {
    const double slope = std::abs(volume.rescaleSlope);
    if (!isFloatingPoint(volume.type)) {
        return 1e-3 * slope;
    }
    return volume.type == VoxelType::F32 ? std::ldexp(std::abs(value), -24) : 0.0;
}

} // namespace

Result<void> infoCommand(const InputOptions& options) {
    const Result<Volume> volume = openVolume(options);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    sayNotes(options, *volume);
    const VolumeGeometry& g = volume->geometry;
    const VolumeStatistics s = statisticsOf(*volume);
    const glm::dvec3 box = glm::dvec3(g.dims) * g.spacingMm;
    const Modality modality = likelyModality(*volume, s);
    fmt::print("{}\n", volume->name);
    fmt::print("  voxels     {} x {} x {}, {}, {:.1f} MiB\n", g.dims.x, g.dims.y, g.dims.z,
               name(volume->type), mib(static_cast<std::int64_t>(volume->voxels.size())));
    fmt::print("  spacing    {:.6g} x {:.6g} x {:.6g} mm, box {:.6g} x {:.6g} x {:.6g} mm\n",
               g.spacingMm.x, g.spacingMm.y, g.spacingMm.z, box.x, box.y, box.z);
    fmt::print("  origin     {:.6g}, {:.6g}, {:.6g} mm (LPS, centre of the first voxel)\n",
               g.originMm.x, g.originMm.y, g.originMm.z);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 d = g.direction[axis];
        fmt::print("  axis {}     ({:.6g}, {:.6g}, {:.6g})\n", "xyz"[axis], d.x, d.y, d.z);
    }
    fmt::print("  values     {} to {} {}, mean {}, standard deviation {:.6g}\n",
               valueText(s.min, resolutionAt(*volume, s.min)),
               valueText(s.max, resolutionAt(*volume, s.max)), volume->unit,
               valueText(s.mean, 1e-3 * (s.max - s.min)), s.standardDeviation);
    fmt::print("  rescale    value = {:.6g} * voxel + {:.6g}\n", volume->rescaleSlope,
               volume->rescaleIntercept);
    fmt::print("  non-finite {} voxels\n", volume->nonFiniteVoxels);
    const bool guessed = modality != volume->modality;
    fmt::print("  modality   {}{}, default transfer function {}\n", modalityName(modality),
               guessed ? " (guessed from the values)" : "", defaultPresetName(modality, s));
    for (const TexelFormat format : {TexelFormat::R8, TexelFormat::R16, TexelFormat::R16F,
                                     TexelFormat::Rg8Exact, TexelFormat::R32fExact}) {
        const Result<MemoryForecast> forecast = forecastMemory(g.dims, volume->type, format);
        if (forecast) {
            fmt::print("  as {:<10} {:.1f} MiB on the GPU, {:.1f} MiB on the host\n", name(format),
                       mib(forecast->gpuTexelBytes), mib(forecast->hostBytes()));
        }
    }
    return {};
}

} // namespace slabcast
