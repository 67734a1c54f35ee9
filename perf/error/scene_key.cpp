#include "perf/error/scene_key.h"

#include "perf/report_json.h"
#include "perf/settings_json.h"
#include "perf/stage.h"

namespace slabcast {

std::string fingerprint(std::span<const std::byte> bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const std::byte byte : bytes) {
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 1099511628211ULL;
    }
    std::string digits(16, '0');
    for (std::size_t k = digits.size(); k-- > 0; hash >>= 4) {
        digits[k] = "0123456789abcdef"[hash & 15];
    }
    return digits;
}

Json placementKey(const VolumeGeometry& geometry) {
    Json matrix = Json::list();
    const glm::dmat4 modelFromUvw = geometry.modelFromUvw();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            matrix.push_back(modelFromUvw[column][row]);
        }
    }
    const glm::ivec3 dims = geometry.dims;
    return {{"dims", Json::list({dims.x, dims.y, dims.z})}, {"model_from_uvw", std::move(matrix)}};
}

Json transferKey(const TransferFunction& tf) {
    Json points = Json::list();
    for (const TransferPoint& p : tf.points) {
        points.push_back(Json::list({p.value, p.color.x, p.color.y, p.color.z, p.opacity}));
    }
    return {{"opacity_unit_mm", tf.opacityUnitMm}, {"points", std::move(points)}};
}

Json statisticsKey(const VolumeStatistics& s) {
    return Json::list({s.min, s.max, s.mean, s.standardDeviation, Json::listOf(s.histogram)});
}

Json frameKey(const gl::Caps& caps, const Scene& scene, const StageDesc& drawn) {
    const Texels& texels = scene.texels();
    Json key = conditionsOf(drawn);
    key.update({{"device", toJson(caps)},
                {"extensions", Json::listOf(caps.extensions)},
                {"voxels", fingerprint(texels.data)},
                {"texels", Json::list({name(texels.format), texels.valueScale, texels.valueBias})},
                {"placement", placementKey(scene.geometry())},
                {"transfer_function", transferKey(scene.look().tf)},
                {"stereo", drawn.stereoIpdMm ? Json(*drawn.stereoIpdMm) : Json()},
                {"background",
                 drawn.background
                     ? Json::list({drawn.background->x, drawn.background->y, drawn.background->z})
                     : Json()}});
    return key;
}

} // namespace slabcast
