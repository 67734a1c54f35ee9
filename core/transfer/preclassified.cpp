#include "core/transfer/preclassified.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/volume/gradient_field.h"

namespace slabcast {
namespace {

constexpr std::int64_t kRowGrain = 64;

/// Lookup of the table with extinction turned into the opacity of one reference layer.
class LayerTable {
public:
    LayerTable(const TransferTable& table, const Texels& texels, double referenceLengthMm)
        : table_(table.texels), last_(static_cast<float>(table.texels.size() - 1)),
          referenceLength_(static_cast<float>(referenceLengthMm * table.extinctionPerMm)) {
        const double texelsPerValue = double{last_} / (table.lastValue - table.firstValue);
        scale_ = texels.valueScale * texelsPerValue;
        bias_ = (texels.valueBias - table.firstValue) * texelsPerValue;
    }

    /// Not premultiplied; alpha in [0,1].
    glm::vec4 at(double sampled) const {
        const float position =
            std::clamp(static_cast<float>(sampled * scale_ + bias_), 0.0F, last_);
        const auto index = std::min(static_cast<std::size_t>(position), table_.size() - 2);
        glm::vec4 sample =
            glm::mix(table_[index], table_[index + 1], position - static_cast<float>(index));
        sample.w = 1.0F - std::exp(-sample.w * referenceLength_);
        return sample;
    }

private:
    const std::vector<glm::vec4>& table_;
    float last_;
    float referenceLength_; // in units of 1 / the table's extinction
    double scale_;          // table position = scale * sampled + bias
    double bias_;
};

/// What a baked light multiplies a colour by; 1 where the gradient points nowhere.
double bakedFactor(const BakedLight& light, glm::dvec3 toLight, glm::dvec3 gradient) {
    const double length = glm::length(gradient);
    const double weight = shadingWeight(light.params, length);
    if (weight == 0.0) {
        return 1.0;
    }
    const double lit = diffuseLight(light.params, glm::dot(gradient, toLight) / length);
    return glm::mix(1.0, lit, weight);
}

glm::u8vec4 premultipliedBytes(glm::vec4 sample) {
    const glm::vec3 color = glm::clamp(glm::vec3(sample), 0.0F, 1.0F) * sample.w;
    return {glm::vec4(color, sample.w) * 255.0F + 0.5F}; // truncated: rounds to nearest
}

} // namespace

ClassifiedTexels classify(const Texels& texels, const VolumeGeometry& geometry,
                          const TransferTable& table, const ClassifySettings& settings) {
    const double referenceLengthMm =
        settings.referenceLengthMm.value_or(geometry.smallestVoxelEdgeMm());
    SLABCAST_EXPECTS(referenceLengthMm > 0.0, referenceLengthMm);
    const BakedLight light = settings.light.value_or(BakedLight{});
    const double distance = glm::length(light.directionToLight);
    SLABCAST_EXPECTS(distance > 0.0, distance);
    const glm::dvec3 toLight = light.directionToLight / distance;
    const LayerTable layers(table, texels, referenceLengthMm);
    const glm::i64vec3 dims(texels.dims);
    ClassifiedTexels result{texels.dims, referenceLengthMm, {}};
    result.texels.resize(static_cast<std::size_t>(dims.x * dims.y * dims.z));
    visitTexelFormat(texels.format, [&]<class Codec>(Codec codec) {
        const auto* data = texelData(texels, codec);
        const GradientField gradients(texels, geometry, codec);
        const auto classifyRow = [&](std::int64_t row) {
            for (std::int64_t x = 0; x < dims.x; ++x) {
                const std::int64_t index = row * dims.x + x;
                glm::vec4 sample = layers.at(Codec::unpack(data[index]) / Codec::kUnitsPerSampled);
                if (settings.light && sample.w * 255.0F >= 0.5F) { // fainter texels are all zero
                    const glm::dvec3 gradient =
                        gradients.at({x, row % dims.y, row / dims.y}, index);
                    const auto factor = static_cast<float>(bakedFactor(light, toLight, gradient));
                    sample = glm::vec4(glm::vec3(sample) * factor, sample.w);
                }
                result.texels[static_cast<std::size_t>(index)] = premultipliedBytes(sample);
            }
        };
        parallelFor(dims.y * dims.z, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                classifyRow(row);
            }
        });
    });
    return result;
}

TexelCodes alphaCodes(const ClassifiedTexels& classified) {
    TexelCodes result;
    result.dims = classified.dims;
    const auto alphas = std::make_shared<std::vector<std::uint8_t>>(classified.texels.size());
    std::transform(classified.texels.begin(), classified.texels.end(), alphas->begin(),
                   [](glm::u8vec4 texel) { return texel.w; });
    result.bytes = *alphas;
    result.owner = alphas;
    for (int code = 0; code < 256; ++code) {
        result.lowSampled.push_back(static_cast<float>(code) / 255.0F);
    }
    result.highSampled = result.lowSampled;
    return result;
}

} // namespace slabcast
