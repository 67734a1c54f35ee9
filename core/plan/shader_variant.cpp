#include "core/plan/shader_variant.h"

#include <algorithm>
#include <map>

#include "core/gl/shader_text.h"
#include "core/plan/accumulate_rules.h"
#include "core/plan/frame_fields.h"
#include "core/plan/shader_axes.h"

namespace slabcast {

namespace {

static_assert(std::size(kAxes) == static_cast<std::size_t>(Axis::Form) + 1);
static_assert(std::size(axes::kAccumulate) == kAccumulateRules.size());
static_assert(std::size(axes::kForm) == kUnrollLengths.size() + 1);

const AxisValue& valueOn(const AxisInfo& axis, const ShaderVariant& variant) {
    const std::size_t value = axis.valueOf(variant);
    SLABCAST_EXPECTS(value < axis.count, value);
    return axis.values[value];
}

const AxisInfo& infoOf(Axis axis) {
    return kAxes[static_cast<std::size_t>(axis)];
}

bool met(const Requirement& requirement, const ShaderVariant& variant) {
    const auto& among = requirement.among;
    return infoOf(requirement.axis).valueOf(variant) != requirement.value ||
           std::find(among.begin(), among.end(), infoOf(requirement.other).valueOf(variant)) !=
               among.end();
}

/// The members of the uniform block, on one line.
std::string frameFields() {
    const auto member = [](const char* type, const char* name, int number) {
        std::string declaration = std::string(type) + " " + name;
        if (number > 1) {
            declaration.append("[").append(std::to_string(number)).append("]");
        }
        return declaration + "; ";
    };
    std::string text;
#define SLABCAST_MEMBER(type, name, number) text += member(#type, #name, number);
    SLABCAST_FRAME_FIELDS(SLABCAST_MEMBER)
#undef SLABCAST_MEMBER
    return text;
}

/// X(0) X(1) ..., each number with `suffix`, up to and without `end`.
std::string writtenOut(int end, int step, const char* suffix) {
    std::string text;
    for (int k = 0; k < end; k += step) {
        text.append("X(").append(std::to_string(k)).append(suffix).append(") ");
    }
    return text;
}

} // namespace

const char* name(Classification classification) {
    const auto index = static_cast<std::size_t>(classification);
    SLABCAST_EXPECTS(index < std::size(axes::kClassification), index);
    return axes::kClassification[index].name;
}

int unrollLengthFor(int layersPerPlane) {
    const auto fit = std::find_if(kUnrollLengths.begin(), kUnrollLengths.end(),
                                  [=](int length) { return length >= layersPerPlane; });
    return fit == kUnrollLengths.end() ? 0 : *fit;
}

bool ShaderVariant::valid() const {
    return std::all_of(std::begin(kAxes), std::end(kAxes),
                       [this](const AxisInfo& axis) { return axis.valueOf(*this) < axis.count; }) &&
           std::all_of(std::begin(kRequirements), std::end(kRequirements),
                       [this](const Requirement& one) { return met(one, *this); });
}

std::string name(const ShaderVariant& variant) {
    std::string text;
    for (const AxisInfo& axis : kAxes) {
        text += valueOn(axis, variant).suffix;
    }
    return text;
}

int groupOf(const ShaderVariant& variant) {
    return valueOn(infoOf(Axis::Form), variant).layersPerGroup;
}

std::vector<std::string> samplersOf(const ShaderVariant& variant) {
    std::vector<std::string> names;
    for (const AxisInfo& axis : kAxes) {
        const AxisValue& value = valueOn(axis, variant);
        for (const Sampler sampler : value.samplers) {
            names.emplace_back(kSamplerNames[unitOf(sampler)]);
        }
        for (const Sampler sampler : value.samplersCounting) {
            if (variant.counts) {
                names.emplace_back(kSamplerNames[unitOf(sampler)]);
            }
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

Result<ShaderPair> shaderText(const ShaderVariant& variant, const MeasuringText& measuring) {
    SLABCAST_EXPECTS(variant.valid(), variant.unroll);
    const bool rounds = measuring.halfGroups != 0;
    std::map<std::string, std::string> defines = {
        {"MAX_OUTLINES", std::to_string(kMaxOutlines)},
        {"FRAME_FIELDS", frameFields()},
        {"PRECISION_FILE", rounds ? "segment/precision/half.glsl" : "segment/precision/exact.glsl"},
    };
    if (rounds) {
        defines["HALF_GROUPS"] = std::to_string(measuring.halfGroups);
    }
    for (const AxisInfo& axis : kAxes) {
        const AxisValue& value = valueOn(axis, variant);
        for (const SlotFile& slot : value.files) {
            defines[slot.slot] = slot.file;
        }
    }
    const int group = groupOf(variant);
    defines["GROUP"] = std::to_string(group);
    defines["GROUP_LAYERS(X)"] = writtenOut(group, 1, "");
    if (variant.unroll > 0) {
        defines["REPEAT_GROUPS(X)"] = writtenOut(variant.unroll, group, ".0");
    }
    Result<std::string> vertex = expandShader(defines.at("COVER_FILE"), defines);
    Result<std::string> fragment = expandShader("segment/segment.frag", defines);
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    return ShaderPair{std::move(*vertex), std::move(*fragment)};
}

} // namespace slabcast
