#include "platform/cli/session.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/core.h>

#include "core/gl/api.h"
#include "core/volume/downsample.h"
#include "core/volume/phantoms.h"
#include "core/volume/resample.h"
#include "platform/io/load_volume.h"

namespace slabcast {

Result<Session> openSession() {
    Result<EglContext> context = EglContext::create();
    if (!context) {
        return tl::unexpected(context.error());
    }
    if (Result<void> loaded = gl::loadApi(context->getProc()); !loaded) {
        return tl::unexpected(loaded.error());
    }
    const char* mask = std::getenv("SLABCAST_MASK_EXTENSIONS");
    Result<gl::Caps> caps = gl::queryCaps(gl::parseExtensionMask(mask == nullptr ? "" : mask));
    if (!caps) {
        return tl::unexpected(caps.error());
    }
    std::vector<TexelFormatTest> formats = selfTestTexelFormats(*caps);
    return Session{std::move(*context), std::move(*caps), std::move(formats)};
}

Result<Volume> openVolume(const InputOptions& options) {
    Result<Volume> volume = tl::unexpected(Error{});
    if (options.volume.rfind("phantom:", 0) == 0) {
        volume = makePhantom(options.volume);
    } else {
        LoadOptions load{.series = options.series};
        if (!options.raw.empty()) {
            Result<RawLayout> layout = parseRawLayout(options.raw);
            if (!layout) {
                return tl::unexpected(layout.error());
            }
            load.raw = *layout;
        }
        volume = loadVolume(options.volume, load);
    }
    if (volume && options.downsample > 1) {
        volume = downsample(*volume, glm::ivec3(options.downsample));
    }
    if (volume && options.cubeEdge > 0) {
        volume = resample(*volume, glm::ivec3(options.cubeEdge));
    }
    return volume;
}

namespace {

/// Of full scale.
double maxFilterError(const Session& session, TexelFormat format) {
    const auto test = std::find_if(session.formats.begin(), session.formats.end(),
                                   [=](const TexelFormatTest& t) { return t.format == format; });
    return test == session.formats.end() ? 0.0 : test->maxFilterError;
}

} // namespace

double filterErrorSampled(const Session& session, TexelFormat format) {
    return maxFilterError(session, format) * fullScaleSampled(format);
}

Result<MemoryForecast> checkMemory(const VolumeInfo& info, TexelFormat format,
                                   Classification classification, const InputOptions& options,
                                   const gl::Caps& caps) {
    const bool preclassified = classification == Classification::Pre;
    const std::optional<std::int64_t> budget =
        options.gpuBudgetMib
            ? std::optional(static_cast<std::int64_t>(*options.gpuBudgetMib * 1048576.0))
            : std::nullopt;
    if (Result<void> fits =
            checkFits(info.dims, uploadedBytesPerTexel(format, preclassified), caps, budget);
        !fits) {
        return tl::unexpected(fits.error());
    }
    return forecastMemory(info.dims, info.type, format, preclassified);
}

Result<LoadedScene> openScene(const InputOptions& options, Classification classification,
                              const Session& session) {
    Result<Volume> volume = openVolume(options);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    VolumeInfo info{.name = volume->name,
                    .type = volume->type,
                    .unit = volume->unit,
                    .dims = volume->geometry.dims,
                    .spacingMm = volume->geometry.spacingMm,
                    .bytes = static_cast<std::int64_t>(volume->voxels.size())};
    if (volume->nonFiniteVoxels > 0) {
        fmt::print(stderr,
                   "slabcast: {}: {} voxels are NaN or infinite: treated as the lowest value\n",
                   info.name, volume->nonFiniteVoxels);
    }
    const VolumeStatistics statistics = computeStatistics(*volume);
    info.modality = likelyModality(*volume, statistics);
    const TexelFormat format = chooseTexelFormat(volume->type, statistics, options.exact,
                                                 session.formats, &info.formatReason);
    const Result<MemoryForecast> forecast =
        checkMemory(info, format, classification, options, session.caps);
    if (!forecast) {
        return tl::unexpected(forecast.error());
    }
    info.forecast = *forecast;
    std::optional<Texels> values;
    if (options.keepValues) {
        values = encodeTexels(*volume, statistics, TexelFormat::R32fExact);
    }
    return LoadedScene{Scene::create(std::move(*volume), format, maxFilterError(session, format)),
                       std::move(info), std::move(values)};
}

std::int64_t peakHostBytes() {
    std::ifstream status("/proc/self/status");
    std::string key;
    while (status >> key) {
        if (key == "VmHWM:") {
            std::int64_t kib = 0;
            status >> kib;
            return kib * 1024;
        }
        status.ignore(4096, '\n');
    }
    return 0;
}

} // namespace slabcast
