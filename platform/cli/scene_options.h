#pragma once

#include "platform/cli/option_kinds.h"
#include "platform/cli/options.h"

namespace slabcast {

inline constexpr int kMaxLayers = 1 << 20;
inline constexpr double kLeastSpacing = 0.001; // of layers, voxels
inline constexpr double kMostSpacing = 1e6;
inline constexpr const char* kLayersGroup = "Layers, planes and skipping"; // of the help
inline constexpr const char* kTerminationNeeded = "an opacity above 0 and up to 1, or off";

// The words of choices that commands take one or several of.
const Choices<Classification>& classificationWords();
const Choices<TargetFormat>& targetWords();
const Choices<SegmentForm>& formWords();
const Choices<bool>& onOffWords();
/// Nothing where it cannot be read; a nothing within for "off".
std::optional<std::optional<double>> parseTermination(const std::string& word);

// What commands that draw have in common, in parts: none takes all of them as they are.
void bindInput(CLI::App& command, InputOptions& options);
void bindTexture(CLI::App& command, InputOptions& options); // how the volume lies on the GPU
void bindCamera(CLI::App& command, SceneOptions& options);  // and the picture's size
void bindEyes(CLI::App& command, SceneOptions& options);
void bindLook(CLI::App& command, SceneOptions& options);
void bindShading(CLI::App& command, Settings& settings);
void bindStack(CLI::App& command, SceneOptions& options);
/// What a picture's accuracy depends on most, one value each.
void bindSampling(CLI::App& command, Settings& settings);
/// All of these.
void bindScene(CLI::App& command, SceneOptions& options);

/// Where pictures are kept.
void bindBackground(CLI::App& command, SceneOptions& options);

/// The ratio, where a command takes one.
void bindLayersPerPlane(CLI::App& command, Settings& settings, const char* help,
                        const char* usually);

} // namespace slabcast
