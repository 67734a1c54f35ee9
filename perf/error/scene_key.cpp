#include "perf/error/scene_key.h"

#include <nlohmann/json.hpp>

namespace slabcast {

using nlohmann::json;

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

json placementKey(const VolumeGeometry& geometry) {
    json matrix = json::array();
    const glm::dmat4 modelFromUvw = geometry.modelFromUvw();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            matrix.push_back(modelFromUvw[column][row]);
        }
    }
    const glm::ivec3 dims = geometry.dims;
    return {{"dims", {dims.x, dims.y, dims.z}}, {"model_from_uvw", std::move(matrix)}};
}

json transferKey(const TransferFunction& tf) {
    json points = json::array();
    for (const TransferPoint& p : tf.points) {
        points.push_back({p.value, p.color.x, p.color.y, p.color.z, p.opacity});
    }
    return {{"opacity_unit_mm", tf.opacityUnitMm}, {"points", std::move(points)}};
}

json statisticsKey(const VolumeStatistics& s) {
    return {s.min, s.max, s.mean, s.standardDeviation, s.histogram};
}

} // namespace slabcast
