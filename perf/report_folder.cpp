#include "perf/report_folder.h"

#include <algorithm>

namespace slabcast {

namespace {

constexpr int kThumbnailEdge = 192;

} // namespace

ReportPicture thumbnail(glm::ivec2 size, const std::vector<glm::vec4>& picture) {
    const int shrink = std::max(1, std::max(size.x, size.y) / kThumbnailEdge);
    const glm::ivec2 small = glm::max(size / shrink, glm::ivec2(1));
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(small.x) * small.y, glm::vec4(0.0F));
    for (int y = 0; y < small.y * shrink && y < size.y; ++y) {
        for (int x = 0; x < small.x * shrink && x < size.x; ++x) {
            pixels[static_cast<std::size_t>(y / shrink) * small.x + x / shrink] +=
                picture[static_cast<std::size_t>(y) * size.x + x] /
                static_cast<float>(shrink * shrink);
        }
    }
    return {small, std::move(pixels)};
}

} // namespace slabcast
