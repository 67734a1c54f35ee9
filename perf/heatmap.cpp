#include "perf/heatmap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <string>

#include "core/transfer/transfer_function.h"
#include "perf/number.h"

namespace slabcast {

namespace {

/// Rows of 5x7 dots, top first, the leftmost dot being the highest bit.
struct Glyph {
    char letter;
    std::array<std::uint8_t, 7> rows;
};

constexpr int kGlyphWidth = 5;
constexpr int kGlyphHeight = 7;
constexpr int kAdvance = kGlyphWidth + 1;

constexpr Glyph kGlyphs[] = {
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}},
    {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}},
    {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}},
    {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}},
    {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}},
    {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}},
    {'a', {0x0e, 0x11, 0x11, 0x11, 0x1f, 0x11, 0x11}},
    {'c', {0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e}},
    {'e', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}},
    {'f', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10}},
    {'h', {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}},
    {'i', {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'l', {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f}},
    {'n', {0x11, 0x11, 0x19, 0x15, 0x13, 0x11, 0x11}},
    {'o', {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}},
    {'p', {0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10, 0x10}},
    {'r', {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}},
    {'s', {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e}},
    {'t', {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
    {'x', {0x11, 0x11, 0x0a, 0x04, 0x0a, 0x11, 0x11}},
    {'y', {0x11, 0x11, 0x11, 0x0a, 0x04, 0x04, 0x04}},
};

/// Where a pixel lies is for the caller to keep within the picture: what is outside is cut off.
class Canvas {
public:
    Canvas(glm::ivec2 size, std::vector<glm::vec4>& pixels) : size_(size), pixels_(pixels) {}

    void fill(glm::ivec2 low, glm::ivec2 extent, glm::vec3 color) {
        const glm::ivec2 begin = glm::clamp(low, glm::ivec2(0), size_);
        const glm::ivec2 end = glm::clamp(low + extent, glm::ivec2(0), size_);
        for (int y = begin.y; y < end.y; ++y) {
            for (int x = begin.x; x < end.x; ++x) {
                pixels_[static_cast<std::size_t>(y) * size_.x + x] = glm::vec4(color, 1.0F);
            }
        }
    }

    void write(std::string_view text, glm::ivec2 at, int dot) {
        for (const char letter : text) {
            const auto* glyph = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                             [=](const Glyph& g) { return g.letter == letter; });
            for (int k = 0; glyph != std::end(kGlyphs) && k < kGlyphWidth * kGlyphHeight; ++k) {
                const glm::ivec2 place(k % kGlyphWidth, k / kGlyphWidth);
                if ((glyph->rows[place.y] >> (kGlyphWidth - 1 - place.x) & 1) != 0) {
                    fill(at + place * dot, glm::ivec2(dot), glm::vec3(1.0F));
                }
            }
            at.x += kAdvance * dot;
        }
    }

private:
    glm::ivec2 size_;
    std::vector<glm::vec4>& pixels_;
};

int widthOf(std::string_view text, int dot) {
    return kAdvance * static_cast<int>(text.size()) * dot;
}

/// Light of a CIELAB colour under D65 (CIE 15).
glm::dvec3 linearFromLab(glm::dvec3 lab) {
    const auto uncurved = [](double t) {
        constexpr double kKnee = 6.0 / 29.0;
        return t > kKnee ? t * t * t : 3.0 * kKnee * kKnee * (t - 4.0 / 29.0);
    };
    const double y = (lab.x + 16.0) / 116.0;
    const glm::dvec3 xyz(0.95047 * uncurved(y + lab.y / 500.0), uncurved(y),
                         1.08883 * uncurved(y - lab.z / 200.0));
    return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

constexpr glm::vec3 kBehindScale(0.0F);

/// One line at the bottom: the quantity, 0, the colours, the maximum.
void drawScale(Canvas& canvas, glm::ivec2 size, HeatmapQuantity quantity, double maximum) {
    const int dot = std::max(1, std::min(size.x, size.y) / 256);
    const int margin = 4 * dot;
    const int height = kGlyphHeight * dot;
    const std::string title = std::string(name(quantity)) + " per pixel";
    const std::string most = maximum < 100.0 ? number(maximum) : fixed(maximum, 0);
    const int top = size.y - height - margin;
    canvas.fill({0, top - margin}, {size.x, height + 2 * margin}, kBehindScale);
    const bool roomForTitle = widthOf(title, dot) < size.x / 2;
    int left = margin;
    if (roomForTitle) {
        canvas.write(title, {left, top}, dot);
        left += widthOf(title, dot) + margin;
    }
    canvas.write("0", {left, top}, dot);
    left += widthOf("0", dot) + margin;
    const int right = size.x - margin - widthOf(most, dot) - margin;
    for (int x = left; x < right; ++x) {
        canvas.fill({x, top}, {1, height}, heatColor((x - left + 0.5) / (right - left)));
    }
    canvas.write(most, {right + margin, top}, dot);
}

} // namespace

const char* name(HeatmapQuantity quantity) {
    constexpr const char* kNames[] = {"iterations", "fetches", "layers"};
    return kNames[static_cast<std::size_t>(quantity)];
}

double costOf(const PixelWork& work, HeatmapQuantity quantity) {
    switch (quantity) {
    case HeatmapQuantity::Iterations:
        return static_cast<double>(work.stretches) + static_cast<double>(work.layersEvaluated);
    case HeatmapQuantity::Fetches:
        return static_cast<double>(work.volumeFetches) + static_cast<double>(work.skipFetches);
    case HeatmapQuantity::Layers:
        break;
    }
    return static_cast<double>(work.layersEvaluated);
}

double maximumOf(const HeatmapScale& scale, const std::vector<double>& costs, int mostLayers) {
    if (scale.maximum) {
        return *scale.maximum;
    }
    const auto most = std::max_element(costs.begin(), costs.end());
    return scale.absolute ? mostLayers : std::max(1.0, most == costs.end() ? 0.0 : *most);
}

glm::vec3 heatColor(double part) {
    // CIELAB: L* goes straight from 0 to 100; a* and b* turn the hue, near the edge of what sRGB
    // holds and never beyond.
    constexpr glm::dvec3 kNodes[] = {{0.0, 0.0, 0.0},    {22.0, 30.0, -36.0}, {45.0, 54.0, -2.0},
                                     {66.0, 30.0, 58.0}, {88.0, -8.0, 66.0},  {95.0, -6.0, 26.0},
                                     {100.0, 0.0, 0.0}};
    const double lightness = 100.0 * std::clamp(part, 0.0, 1.0);
    const auto* above = std::find_if(std::begin(kNodes) + 1, std::end(kNodes) - 1,
                                     [=](const glm::dvec3& n) { return lightness <= n.x; });
    const glm::dvec3& below = *(above - 1);
    const glm::dvec3 lab = glm::mix(below, *above, (lightness - below.x) / (above->x - below.x));
    return glm::vec3(
        srgbFromLinear(glm::clamp(linearFromLab(lab), glm::dvec3(0.0), glm::dvec3(1.0))));
}

std::vector<glm::vec4> drawHeatmap(glm::ivec2 size, const std::vector<double>& costs,
                                   HeatmapQuantity quantity, double maximum) {
    std::vector<glm::vec4> pixels;
    pixels.reserve(costs.size());
    std::transform(costs.begin(), costs.end(), std::back_inserter(pixels),
                   [=](double cost) { return glm::vec4(heatColor(cost / maximum), 1.0F); });
    Canvas canvas(size, pixels);
    drawScale(canvas, size, quantity, maximum);
    return pixels;
}

} // namespace slabcast
