#include "platform/cli/command_line.h"

#include <fmt/core.h>

#include "platform/cli/settings_options.h"
#include "platform/cli/skip_options.h"

namespace slabcast {

namespace {

/// Adds flags with their values to a command; what is the default anyway is left out.
class CommandLine {
public:
    explicit CommandLine(std::string begin) : text_(std::move(begin)) {}

    CommandLine& add(const char* flag, const std::string& word) {
        text_ += fmt::format(" {} {}", flag, shellWord(word));
        return *this;
    }
    CommandLine& addIf(bool differs, const char* flag, const std::string& word) {
        return differs ? add(flag, word) : *this;
    }
    CommandLine& addFlagIf(bool given, const char* flag) {
        text_ += given ? std::string(" ") + flag : "";
        return *this;
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

std::string words(const OrbitCamera& c) {
    return fmt::format("{},{},{}", c.azimuthDegrees, c.elevationDegrees, c.distanceRadii);
}

std::string words(const std::optional<glm::dvec3>& spacing) {
    return spacing ? fmt::format("{},{},{}", spacing->x, spacing->y, spacing->z) : "";
}

std::string words(const std::vector<Selection>& selections) {
    std::string text;
    for (const Selection& selection : selections) {
        text += (text.empty() ? "" : ",") + selection.key + "=" + selection.value;
    }
    return text;
}

} // namespace

std::string shellWord(const std::string& word) {
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
        return word;
    }
    std::string quoted = "'";
    for (const char c : word) {
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return quoted + "'";
}

std::string renderCommandLine(const SceneOptions& scene, const Sampling& sampling,
                              const FramePlan& plan, const std::string& output) {
    const SceneOptions usual;
    const InputOptions& input = scene.input;
    const LoadOptions& load = input.load;
    const auto number = [](double value) { return fmt::format("{}", value); };
    CommandLine line("slabcast render " + shellWord(input.volume));
    line.add("-o", output)
        .addIf(!load.series.empty(), "--series", load.series)
        .addIf(!load.select.empty(), "--select", words(load.select))
        .addIf(load.time.has_value(), "--time", fmt::format("{}", load.time.value_or(0)))
        .addFlagIf(load.resampleUneven, "--resample")
        .addIf(load.spacingMm.has_value(), "--spacing", words(load.spacingMm))
        .addIf(!load.unit.empty(), "--unit", load.unit)
        .addIf(load.raw.has_value(), "--raw", load.raw ? textOf(*load.raw) : "")
        .addIf(load.rawSkipBytes > 0, "--skip-bytes", fmt::format("{}", load.rawSkipBytes))
        .addIf(input.downsample != 1, "--downsample", fmt::format("{}", input.downsample))
        .addFlagIf(input.exact, "--exact")
        .add("--size", fmt::format("{}x{}", scene.size.x, scene.size.y))
        .addIf(words(scene.camera) != words(usual.camera), "--camera", words(scene.camera))
        .addIf(scene.fovDegrees != usual.fovDegrees, "--fov", number(scene.fovDegrees))
        .addIf(!scene.tf.empty(), "--tf", scene.tf)
        .addIf(plan.space != usual.settings.space, "--space", name(plan.space))
        .add("--classify", name(sampling.classification))
        .add("--target", name(sampling.target))
        .add("--layer-spacing", number(sampling.layerSpacingVoxels))
        .add("--layers-per-plane", fmt::format("{}", plan.layersPerPlane))
        .add("--termination", sampling.termination ? number(*sampling.termination) : "off")
        .add("--jitter", sampling.jitter ? "on" : "off")
        .addIf(plan.lattice.kind != usual.settings.lattice, "--lattice", name(plan.lattice.kind))
        .add("--order", name(plan.order))
        .add("--form", plan.variant.unroll > 0 ? "unrolled" : "loop")
        .add("--skip", name(plan.skip))
        .addIf(!plan.tighten, "--tighten", "off");
    for (const Setting* setting : parametersOf(plan.skip)) {
        const SettingValue value = setting->read(scene.settings);
        line.addIf(value != setting->read(usual.settings), flagOf(*setting).c_str(),
                   setting->text(value));
    }
    return line.text();
}

} // namespace slabcast
