#include "perf/stability/left_out_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/volume/phantoms.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr int kEdge = 48;
constexpr double kBallRadius = 4.0;
constexpr glm::dvec3 kBallCentre(12.0, 16.0, 34.0); // voxels

Volume phantom(const char* spec) {
    Result<Volume> volume = makePhantom(spec);
    SLABCAST_EXPECTS(volume.has_value(), 0);
    return std::move(*volume);
}
Volume shells() {
    return phantom("phantom:shells:48");
}
Volume vessels() {
    return phantom("phantom:vessels:48");
}
Volume constant() {
    return phantom("phantom:constant:48");
}
Volume waves() {
    return phantom("phantom:marschner-lobb:48");
}
Volume smallBall() {
    return formulaVolume(glm::ivec3(kEdge), VoxelType::U8, [](glm::ivec3 v) {
        const double distance = glm::distance(glm::dvec3(v) + 0.5, kBallCentre);
        return 200.0 * std::clamp(0.5 + kBallRadius - distance, 0.0, 1.0);
    });
}

TransferFunction rampTransfer(double from, double to, double least, double most) {
    return {.points = {{from, {0.9, 0.5, 0.3}, least}, {to, {0.3, 0.6, 1.0}, most}}};
}
TransferFunction stepTransfer(double at, double opacity) {
    return {.points = {{at, {0.9, 0.7, 0.4}, 0.0}, {at, {0.9, 0.7, 0.4}, opacity}}};
}

double perLayer(std::int64_t count, const Evidence& e) {
    return double(count) / double(std::max<std::int64_t>(1, e.work.layersEvaluated));
}
double zero(const Evidence& /*evidence*/) {
    return 0.0;
}

/// Layers of all rays in a loop's groups that begin where a block may hold something visible. No
/// group goes on from plane to plane; one that reaches beyond its plane's end counts whole.
double layersFromOccupiedBlocks(const Evidence& e) {
    const FreeLengths& cloud = *e.scene.skip().lengths;
    const Viewport viewport{0, 0, e.size.x, e.size.y};
    const RayFrame frame = makeRayFrame(e.view, viewport, e.scene.geometry(), e.plan.lattice);
    const int total = e.plan.lattice.total;
    const glm::dvec3 blocksPerUvw =
        glm::dvec3(e.scene.geometry().dims) / double(cloud.blockEdgeVoxels);
    const auto isOccupied = [&](const LatticeRay& ray, int layer) {
        const glm::dvec3 uvw = samplePosition(ray, total, layer);
        const glm::ivec3 block =
            glm::clamp(glm::ivec3(glm::floor(uvw * blocksPerUvw)), glm::ivec3(0), cloud.blocks - 1);
        const std::int64_t index =
            (std::int64_t(block.z) * cloud.blocks.y + block.y) * cloud.blocks.x + block.x;
        return cloud.counts[std::size_t(index)] == 0;
    };
    std::int64_t count = 0;
    for (int i = 0; i < e.size.x * e.size.y; ++i) {
        const LatticeRay ray = rayAt(frame, glm::dvec2(i % e.size.x, i / e.size.x) + 0.5);
        const LayerRange met = layersOf(ray, total);
        for (int front = 0; front < total; front += e.plan.layersPerPlane) {
            const int end = std::min(met.end, front + e.plan.layersPerPlane);
            for (int k = std::max(met.begin, front); k < end; ++k) {
                if (isOccupied(ray, k)) {
                    count += kLoopGroup;
                    k += kLoopGroup - 1;
                }
            }
        }
    }
    return double(count);
}

/// Pixels times planes that a cube around the ball can touch. The ball's visible cells reach one
/// voxel further, their blocks one more and up to their own edge of 4, those merged for outlines up
/// to 8.
double fragmentsAroundTheBall(const Evidence& e) {
    const double reach = kBallRadius + 0.5 + 1.0 + 1.0 + 4.0 + 8.0;
    const glm::dmat4 viewFromUvw = e.view.viewFromModel * e.scene.geometry().modelFromUvw();
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side = glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) * 2.0 - 1.0;
        const glm::dvec3 place(viewFromUvw *
                               glm::dvec4((kBallCentre + side * reach) / double(kEdge), 1.0));
        const glm::dvec3 seen(place.x / -place.z, place.y / -place.z, -place.z);
        low = glm::min(low, seen);
        high = glm::max(high, seen);
    }
    const Frustum& f = e.view.frustum;
    const glm::dvec2 tangentPerPixel((f.right - f.left) / e.size.x, (f.top - f.bottom) / e.size.y);
    const glm::dvec2 pixels = glm::dvec2(high - low) / tangentPerPixel + 2.0;
    const double planes =
        std::ceil((high.z - low.z) / (e.plan.lattice.spacingMm * e.plan.layersPerPlane)) + 1.0;
    return std::min(pixels.x, double(e.size.x)) * std::min(pixels.y, double(e.size.y)) * planes;
}

/// All pixels of the planes in front of the eye.
double fragmentsInFront(const Evidence& e) {
    const BoundingSphere sphere = e.scene.geometry().boundingSphere();
    const double depth = -(e.view.viewFromModel * glm::dvec4(sphere.centreMm, 1.0)).z;
    const double inFront = (depth + sphere.radiusMm) / e.plan.lattice.spacingMm;
    return double(e.size.x) * e.size.y * (std::floor(inFront / e.plan.layersPerPlane) + 2.0);
}

const std::vector<std::string> kFieldAndTable = {"transferTable", "volumeTexels"};
const std::vector<std::string> kAll = {"skipTexels", "transferTable", "volumeTexels"};

constexpr WorkClaim kOneFetch{
    "volume fetches per layer beyond the sample's own",
    [](const Evidence& e) { return perLayer(e.work.volumeFetches, e) - 1.0; }, zero,
    "unlit: no gradient is fetched"};

constexpr WorkClaim kOccupiedOnly{
    "layers evaluated", [](const Evidence& e) { return double(e.work.layersEvaluated); },
    [](const Evidence& e) { return 1.005 * layersFromOccupiedBlocks(e); },
    "layers of groups of eight that begin in a block with something visible, counted in float64; a "
    "half per cent for those that float32 places beyond a block's face"};

} // namespace

std::vector<FrugalScene> frugalScenes() {
    return {
        {.name = "nothing empty",
         .volume = waves,
         .tf = rampTransfer(0.0, 1.0, 0.01, 0.1),
         .samplers = kFieldAndTable,
         .claim = {"skip fetches, and bytes of a skip structure",
                   [](const Evidence& e) {
                       return double(e.work.skipFetches + e.memory.skipBytes);
                   },
                   zero, "every block holds something visible: there is nothing to skip"}},
        {.name = "all empty",
         .volume = shells,
         .tf = rampTransfer(0.0, 255.0, 0.0, 0.0),
         .samplers = {},
         .claim = {"fragments, and bytes of volume and skip structure",
                   [](const Evidence& e) {
                       return double(e.work.fragments + e.memory.volumeBytes + e.memory.skipBytes);
                   },
                   zero, "nothing is visible: nothing is drawn and no texture kept"}},
        {.name = "one material",
         .volume = constant,
         .tf = uniformTransfer(0.05, {0.9, 0.6, 0.3}),
         .samplers = kFieldAndTable,
         .claim = {"texels of the table",
                   [](const Evidence& e) { return double(e.scene.table().texels.size()); },
                   [](const Evidence&) { return 2.0; },
                   "the TF is constant over the data: two equal texels say it"}},
        {.name = "no light",
         .volume = shells,
         .tf = stepTransfer(60.0, 0.1),
         .samplers = kAll,
         .claim = kOneFetch},
        {.name = "light",
         .volume = shells,
         .tf = stepTransfer(60.0, 0.1),
         .lit = true,
         .samplers = kAll,
         .claim = {"volume fetches per layer",
                   [](const Evidence& e) { return perLayer(e.work.volumeFetches, e); },
                   [](const Evidence&) { return 7.0; },
                   "the sample, and six for a gradient where it is visible"}},
        {.name = "opaque",
         .volume = constant,
         .tf = uniformTransfer(1.0, {0.9, 0.6, 0.3}),
         .samplers = kFieldAndTable,
         .claim = {"layers evaluated per fragment",
                   [](const Evidence& e) {
                       return double(e.work.layersEvaluated) / double(e.work.fragments);
                   },
                   [](const Evidence&) { return 2.0; },
                   "a whole layer ends its segment; the one before it may be cut by the box"}},
        {.name = "transparent",
         .volume = shells,
         .tf = stepTransfer(60.0, 0.01),
         .samplers = kAll,
         .claim = {"segments that may be left early",
                   [](const Evidence& e) { return e.plan.variant.terminates ? 1.0 : 0.0; }, zero,
                   "16 layers of an opacity of 0.01 stay below any threshold"}},
        {.name = "eye inside",
         .volume = waves,
         .tf = rampTransfer(0.0, 1.0, 0.01, 0.1),
         .camera = {30.0, 20.0, 0.3},
         .fovDegrees = 70.0,
         .samplers = kFieldAndTable,
         .claim = {"fragments", [](const Evidence& e) { return double(e.work.fragments); },
                   fragmentsInFront,
                   "planes behind the eye are not drawn: at most all pixels of the others"}},
        {.name = "small visible region",
         .volume = smallBall,
         .tf = stepTransfer(60.0, 0.3),
         .samplers = kAll,
         .claim = {"fragments", [](const Evidence& e) { return double(e.work.fragments); },
                   fragmentsAroundTheBall,
                   "planes before and behind what is visible are not drawn, the others as "
                   "rectangles around a cube that holds the ball's cells, their blocks and those "
                   "merged with them"}},
        {.name = "nested shells",
         .volume = shells,
         .tf = stepTransfer(127.5, 0.2),
         .samplers = kAll,
         .claim = kOccupiedOnly},
        {.name = "vessels",
         .volume = vessels,
         .tf = stepTransfer(1000.0, 0.5),
         .samplers = kAll,
         .claim = kOccupiedOnly},
    };
}

int textOutOfPlace(const ShaderVariant& variant) {
    const struct {
        const char* text;
        bool needed;
    } entries[] = {{"skipTexels", variant.skip != SkipForm::None},
                   {"gradientRow[0].xyz", variant.shaded && variant.normals == Normals::Computed},
                   {"normalTexels", variant.normals == Normals::Baked},
                   {"texelFetch(volumeTexels", variant.exactField},
                   {"alpha > viewport.w", variant.terminates},
                   {"work1", variant.counts}};
    const Result<ShaderPair> program = shaderText(variant);
    SLABCAST_EXPECTS(program.has_value(), variant.unroll);
    return int(std::count_if(std::begin(entries), std::end(entries), [&](const auto& entry) {
        const bool there = program->fragment.find(entry.text) != std::string::npos;
        return there && !entry.needed;
    }));
}

} // namespace slabcast::stability
