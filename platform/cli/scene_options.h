#pragma once

#include "platform/cli/options.h"
#include "platform/cli/settings_options.h"

namespace slabcast {

/// A picture's size, as "1024x1024" means it.
std::optional<glm::ivec2> parseSize(const std::string& word);

/// The folder of a report that holds `what`.
void bindReportFolder(Command& command, FolderOptions& folder, const std::string& what);

// What commands that draw have in common, beside the table's settings, in parts.
void bindInput(Command& command, InputOptions& options);
void bindTexture(Command& command, InputOptions& options); // how the volume lies on the GPU
void bindCamera(Command& command, SceneOptions& options);  // and the picture's size
void bindEyes(Command& command, SceneOptions& options);
void bindTransfer(Command& command, SceneOptions& options);
/// All of these.
void bindScene(Command& command, SceneOptions& options);

/// Where pictures are kept.
void bindBackground(Command& command, SceneOptions& options);

} // namespace slabcast
