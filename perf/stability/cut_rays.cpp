#include <algorithm>
#include <cmath>
#include <random>

#include "core/volume/half.h"
#include "perf/stability/reference_picture.h"
#include "perf/stability/symmetry.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "cut-rays";
constexpr int kLayers = 48; // divides into nearly all of the pieces
constexpr int kPieces[] = {1, 2, 3, 7, 16, kLayers};

using Layers = std::vector<glm::dvec4>; // premultiplied, from the nearest

const char* nameOf(BlendOrder order) {
    return order == BlendOrder::BackToFront ? "back to front" : "front to back";
}

/// How pieces are put together: with what rounding, and how many of its roundings k pieces may be
/// from the whole ray. With e the error of what is gathered and a the opacity of the next piece,
/// back to front e becomes at most (1 - a) e + r, that is k r of k pieces. Front to back so does
/// the opacity's; and the colour gathers, beside its own r, each time the piece's colour, at most
/// a, times e, and a e <= e - (the next e) + r: another r per piece but the last.
struct Arithmetic {
    const char* name;
    double unit; // one rounding, of full scale
    double (*rounded)(double);
    bool everyOperation; // is rounded; else what is stored
    bool sources;        // are rounded before they are blended
    double over;         // roundings of a piece that is blended over others
    double under;        // of one that is blended under others, the errors of opacity included
    double first;        // of the first one, beside which there is nothing
};

double same(double value) {
    return value;
}
double toFloat(double value) {
    return static_cast<float>(value);
}
double toHalf(double value) {
    return roundedToHalf(static_cast<float>(value));
}
double toByte(double value) {
    return std::round(std::clamp(value, 0.0, 1.0) * 255.0) / 255.0;
}

constexpr Arithmetic kArithmetic[] = {{"float64", 0x1p-53, same, true, false, 3.0, 6.0, 0.0},
                                      {"float32", 0x1p-24, toFloat, true, true, 4.0, 8.0, 1.0},
                                      {"fp16", 0x1p-11, toHalf, false, false, 1.0, 2.0, 1.0},
                                      {"8 bits", 1.0 / 510.0, toByte, true, true, 3.0, 4.0, 1.0}};

struct Target {
    const Arithmetic& by;
    TargetFormat format;
};
const Target kTargets[] = {{kArithmetic[2], TargetFormat::Rgba16f},
                           {kArithmetic[3], TargetFormat::Rgba8}};

double roundings(const Arithmetic& by, BlendOrder order, int pieces) {
    const double each = order == BlendOrder::BackToFront ? by.over : by.under;
    return by.first + each * (pieces - 1);
}

/// `front` over `back`. In 8 bits 1 - a and the sum are exact.
glm::dvec4 blended(const Arithmetic& by, glm::dvec4 front, glm::dvec4 back) {
    const auto inner = [&](double value) { return by.everyOperation ? by.rounded(value) : value; };
    const double clear = inner(1.0 - front.a);
    glm::dvec4 result;
    for (int k = 0; k < 4; ++k) {
        result[k] = by.rounded(front[k] + inner(clear * back[k]));
    }
    return result;
}

glm::dvec4 composited(std::span<const glm::dvec4> layers) {
    glm::dvec4 sum(0.0);
    for (const glm::dvec4& layer : layers) {
        sum += (1.0 - sum.a) * layer;
    }
    return sum;
}

/// Pieces are whole in float64, and put together by `by`.
glm::dvec4 compositedInPieces(const Layers& layers, int count, const Arithmetic& by,
                              BlendOrder order) {
    std::vector<glm::dvec4> pieces;
    const std::size_t length = (layers.size() + std::size_t(count) - 1) / std::size_t(count);
    for (std::size_t begin = 0; begin < layers.size(); begin += length) {
        const auto piece = std::span(layers).subspan(begin);
        pieces.push_back(composited(piece.first(std::min(length, piece.size()))));
        for (int k = 0; by.sources && k < 4; ++k) {
            pieces.back()[k] = by.rounded(pieces.back()[k]);
        }
    }
    if (order == BlendOrder::BackToFront) {
        std::reverse(pieces.begin(), pieces.end());
    }
    glm::dvec4 sum(0.0);
    for (const glm::dvec4& piece : pieces) {
        sum = order == BlendOrder::BackToFront ? blended(by, piece, sum) : blended(by, sum, piece);
    }
    return sum;
}

/// Rays of faint, mixed and dense layers.
std::vector<Layers> someRays() {
    std::minstd_rand random(1);
    const auto share = [&] { return double(random()) / double(std::minstd_rand::max()); };
    std::vector<Layers> rays;
    for (const double densest : {0.003, 0.1, 0.999}) {
        for (int ray = 0; ray < 64; ++ray) {
            Layers layers;
            for (int i = 0; i < kLayers; ++i) {
                const double alpha = densest * share() * share();
                layers.push_back({alpha * share(), alpha * share(), alpha * share(), alpha});
            }
            rays.push_back(std::move(layers));
        }
    }
    return rays;
}

double largestOf(glm::dvec4 v) {
    const glm::dvec4 size = glm::abs(v);
    return std::max({size.x, size.y, size.z, size.w});
}

Case caseOf(const char* panel, const std::string& arithmetic, BlendOrder order, int pieces,
            double bound, double measured) {
    const std::string group = named({arithmetic, nameOf(order)});
    return {.family = kFamily,
            .name = named(
                {panel, group, std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces")}),
            .quantity = "largest difference from the whole ray, in roundings",
            .bound = bound,
            .measured = measured,
            .series = Series{.group = group,
                             .panel = panel,
                             .x = double(pieces),
                             .y = measured,
                             .xLabel = "pieces",
                             .yLabel = "roundings",
                             .bound = bound}};
}

void recordArithmetic(Bench& bench, const Arithmetic& by, BlendOrder order, int pieces,
                      const std::vector<Layers>& rays) {
    double worst = 0.0;
    for (const Layers& layers : rays) {
        worst = largerOf(
            worst, largestOf(compositedInPieces(layers, pieces, by, order) - composited(layers)));
    }
    // Whole and pieces are themselves sums of layers in float64: six roundings of 2^-53 each.
    const double ofLayers = 2.0 * 6.0 * kLayers * 0x1p-53 / by.unit;
    Case c = caseOf("computed", by.name, order, pieces, roundings(by, order, pieces) + ofLayers,
                    worst / by.unit);
    if (by.unit < kTargets[0].by.unit) {
        c.series.reset(); // beside what is drawn stands what targets do
    }
    c.reason = "with e the error of what is gathered, a the next piece's opacity and r roundings "
               "of a piece: back to front e becomes (1 - a) e + r at most, k r in all; front to "
               "back the opacity's error comes on top, times a: another k r; in one rounding of "
               "the arithmetic (float64: 2^-53, float32: 2^-24, fp16: 2^-11, 8 bits: 1/510); and "
               "six of 2^-53 for every layer of the whole and of the pieces";
    bench.record(std::move(c));
}

// --- Planes as pieces ---

Settings settingsOf(TargetFormat target, BlendOrder order, int planes) {
    Settings settings = stability::settingsOf(methods().back());
    settings.target = target;
    settings.layersPerPlane.reset();
    settings.planes = planes;
    settings.totalLayers = kLayers;
    settings.order = order;
    return settings;
}

void recordDrawn(Bench& bench, const Scene& scene, const Target& target, BlendOrder order,
                 int pieces, const Result<Picture>& whole) {
    const glm::ivec2 size(bench.reduced() ? 16 : 32);
    // Twice 2^-22 per layer, as other families allow float32.
    const double float32 = (2.0 * kLayers * 0x1p-22 + bench.finest().rounding) / target.by.unit;
    Case c = caseOf("drawn", target.by.name, order, pieces,
                    roundings(target.by, order, pieces) + float32, 0.0);
    c.reason = "planes are the pieces: as computed, in roundings of the target (fp16: 2^-11, for "
               "a device may take either neighbour; 8 bits: 1/510); and 2^-22 per layer in float32 "
               "in either picture, and the whole ray's own target (float32: 2^-24, fp16: 2^-11)";
    if (!whole) {
        return bench.recordFailure(std::move(c), whole.error());
    }
    const View view = orbitView(scene, {37.0, 23.0, 2.4}, 40.0, size);
    bench.examine(std::move(c), scene, settingsOf(target.format, order, pieces), view, size,
                  [&](Case& judged, const Drawn& drawn) {
                      const std::vector<glm::dvec4> meant(whole->pixels.begin(),
                                                          whole->pixels.end());
                      judged.measured = largestDifference(drawn.picture, meant) / target.by.unit;
                      judged.series->y = judged.measured;
                      if (drawn.plan.planes != pieces) {
                          judged.failure = "the plan has " + std::to_string(drawn.plan.planes) +
                                           " planes: other pieces than asked for";
                      }
                  });
}

void drawnCases(Bench& bench) {
    const Result<Scene> scene =
        bench.scene(formulaVolume({14, 10, 18}, VoxelType::U8, lopsided, {0.8, 1.3, 0.6}),
                    {.tf = lopsidedTransfer()}, {.structure = SkipStructure::None});
    if (!scene) {
        return bench.recordFailure({.family = kFamily, .name = "drawn"}, scene.error());
    }
    const glm::ivec2 size(bench.reduced() ? 16 : 32);
    const View view = orbitView(*scene, {37.0, 23.0, 2.4}, 40.0, size);
    const Result<FramePlan> plan =
        bench.plan(*scene, settingsOf(TargetFormat::Rgba16f, BlendOrder::BackToFront, 1));
    const Result<Picture> whole =
        plan ? bench.drawFinely(*scene, *plan, view, size) : tl::unexpected(plan.error());
    for (const Target& target : kTargets) {
        for (const BlendOrder order : {BlendOrder::BackToFront, BlendOrder::FrontToBack}) {
            for (const int pieces : kPieces) {
                recordDrawn(bench, *scene, target, order, pieces, whole);
            }
        }
    }
}

} // namespace

void cutRayCases(Bench& bench) {
    const std::vector<Layers> rays = someRays();
    for (const Arithmetic& by : kArithmetic) {
        for (const BlendOrder order : {BlendOrder::BackToFront, BlendOrder::FrontToBack}) {
            for (const int pieces : kPieces) {
                recordArithmetic(bench, by, order, pieces, rays);
            }
        }
    }
    drawnCases(bench);
}

} // namespace slabcast::stability
