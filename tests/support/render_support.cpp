#include "tests/support/render_support.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace slabcast::test {

namespace {

template <class T>
void putVoxel(VoxelBytes& voxels, std::size_t index, double value) {
    const T voxel = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
    std::memcpy(voxels.data() + index * sizeof(T), &voxel, sizeof(T));
}

/// A target as the plan asks for, bound and cleared.
gl::ColorTargets targetOf(const FramePlan& plan, glm::ivec2 size, glm::vec4 background) {
    gl::ColorTargets target;
    const GLenum format = plan.target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    EXPECT_TRUE(target.resize(size.x, size.y, {format}).has_value());
    target.begin(background);
    return target;
}

} // namespace

Volume makeVolume(glm::ivec3 dims, VoxelType type, const VoxelFormula& formula,
                  glm::dvec3 spacingMm) {
    Volume volume;
    volume.name = "formula";
    volume.type = type;
    volume.geometry.dims = dims;
    volume.geometry.spacingMm = spacingMm;
    volume.voxels = VoxelBytes(std::size_t(volume.geometry.voxelCount()) * bytesPerVoxel(type));
    std::size_t index = 0;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const double value = formula({x, y, z});
                type == VoxelType::U8    ? putVoxel<std::uint8_t>(volume.voxels, index, value)
                : type == VoxelType::U16 ? putVoxel<std::uint16_t>(volume.voxels, index, value)
                                         : putVoxel<float>(volume.voxels, index, value);
                ++index;
            }
        }
    }
    Result<Volume> checked = validated(std::move(volume));
    EXPECT_TRUE(checked.has_value());
    return std::move(*checked);
}

Volume constantVolume(glm::ivec3 dims, int value) {
    return makeVolume(dims, VoxelType::U8, [=](glm::ivec3) { return value; });
}

Volume wavyVolume(Random& random, glm::ivec3 dims, VoxelType type, glm::dvec3 spacingMm) {
    const double half = type == VoxelType::U8 ? 127.0 : 32767.0;
    const glm::dvec3 phase{random.in(0.0, 6.3), random.in(0.0, 6.3), random.in(0.0, 6.3)};
    const glm::dvec3 pace{random.in(0.05, 0.2), random.in(0.05, 0.2), random.in(0.05, 0.2)};
    return makeVolume(
        dims, type,
        [=](glm::ivec3 v) {
            const glm::dvec3 wave =
                glm::sin(glm::dvec3(v) * pace + glm::dvec3(v.y, v.z, v.x) * 0.07 + phase);
            return half * (1.0 + (wave.x + wave.y + wave.z) / 3.0);
        },
        spacingMm);
}

TransferFunction uniformTransfer(double extinctionPerMm, glm::dvec3 color) {
    return {.name = "uniform", .points = {{0.0, color, 1.0 - std::exp(-extinctionPerMm)}}};
}

TransferFunction smoothTransfer(Random& random, double highest, double mostOpacity) {
    TransferFunction tf{.name = "smooth"};
    for (int k = 0; k < 5; ++k) {
        const glm::dvec3 color{random.in(0.0, 1.0), random.in(0.0, 1.0), random.in(0.0, 1.0)};
        tf.points.push_back({std::round(highest * k / 4.0), color, random.in(0.0, mostOpacity)});
    }
    return tf;
}

Picture Picture::part(const Viewport& viewport) const {
    Picture result{{viewport.width, viewport.height}, {}};
    for (int y = 0; y < viewport.height; ++y) {
        const auto row = pixels.begin() + std::ptrdiff_t(viewport.y + y) * size.x + viewport.x;
        result.pixels.insert(result.pixels.end(), row, row + viewport.width);
    }
    return result;
}

int differingPixels(const Picture& a, const Picture& b) {
    EXPECT_EQ(a.size, b.size);
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        count += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(glm::vec4)) != 0;
    }
    return count;
}

double largestDifference(const Picture& a, const Picture& b) {
    EXPECT_EQ(a.size, b.size);
    glm::vec4 largest(0.0F);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        largest = glm::max(largest, glm::abs(a.pixels[i] - b.pixels[i]));
    }
    return double(std::max({largest.x, largest.y, largest.z, largest.w}));
}

View orbitView(const Scene& scene, const OrbitCamera& camera, double fovDegrees, glm::ivec2 size) {
    return {.viewFromModel = viewFromModel(camera, scene.geometry().boundingSphere()),
            .frustum = symmetricFrustum(fovDegrees, double(size.x) / size.y)};
}

View asymmetricView(const Scene& scene) {
    View view = orbitView(scene, {35.0, 20.0, 2.5}, 45.0, kSize);
    view.frustum.left -= 0.11;
    view.frustum.right -= 0.11;
    view.frustum.top += 0.06;
    view.frustum.bottom += 0.06;
    return view;
}

Settings segments(int layersPerPlane, SegmentForm form) {
    Settings settings;
    settings.layersPerPlane = layersPerPlane;
    settings.form = form;
    settings.lattice = LatticeKind::Planar;
    settings.target = TargetFormat::Rgba16f;
    settings.skip = SkipStructure::None;
    settings.termination.reset();
    return settings;
}

Renderer& RenderTest::renderer() {
    static Renderer* shared = [this] {
        Result<Renderer> made = Renderer::create(device());
        EXPECT_TRUE(made.has_value());
        return new Renderer(std::move(*made)); // kept to the process's end, as the context is
    }();
    return *shared;
}

const std::vector<TexelFormatTest>& RenderTest::formats() {
    static const auto* tests = new std::vector<TexelFormatTest>(selfTestTexelFormats(caps()));
    return *tests;
}

Device RenderTest::device(DeviceOptions options) {
    return Device(caps(), formats(), std::move(options));
}

Scene RenderTest::makeScene(const Volume& volume, const Appearance& appearance,
                            const SkipOptions& skip, bool exact) {
    Result<Scene> scene = Scene::create(volume, device(), exact);
    EXPECT_TRUE(scene.has_value()) << (scene ? "" : scene.error().detail);
    const Result<void> shown = show(*scene, appearance, skip);
    EXPECT_TRUE(shown.has_value()) << (shown ? "" : shown.error().detail);
    return std::move(*scene);
}

FramePlan RenderTest::decide(const Scene& scene, const Settings& settings) {
    const Result<FramePlan> made = plan(scene.facts(), settings, caps(), {});
    EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().detail);
    return made.value_or(FramePlan{});
}

Picture RenderTest::cleared(const FramePlan& plan, glm::ivec2 size, glm::vec4 background) {
    return {size, targetOf(plan, size, background).read()};
}

Picture RenderTest::draw(const Scene& scene, const FramePlan& plan, const View& view,
                         glm::ivec2 size, glm::vec4 background) {
    gl::ColorTargets target = targetOf(plan, size, background);
    const TargetEncoding encoding =
        plan.space == CompositingSpace::Display ? TargetEncoding::Encoded : TargetEncoding::Linear;
    const ViewTarget where{view, target.framebuffer(), {0, 0, size.x, size.y}, encoding};
    EXPECT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
    EXPECT_TRUE(renderer().draw(scene, plan, {&where, 1}).has_value());
    return {size, target.read()};
}

Picture RenderTest::draw(const Scene& scene, const Settings& settings, const View& view,
                         glm::ivec2 size) {
    return draw(scene, decide(scene, settings), view, size);
}

void expectMatchesReference(const Picture& picture, const Scene& scene, const FramePlan& plan,
                            const View& view, double meanLimit) {
    const ReferencePicture reference(scene, plan, view, {0, 0, picture.size.x, picture.size.y});
    const double blending = blendingBound(plan);
    const double pixels = picture.size.x * picture.size.y;
    double sum = 0.0;
    double worstExcess = -1.0;
    std::string worst;
    int grazing = 0;
    for (int y = 0; y < picture.size.y; ++y) {
        for (int x = 0; x < picture.size.x; ++x) {
            const PixelReference expected = reference.at(glm::dvec2(x, y) + 0.5);
            const glm::dvec4 off = glm::abs(picture.at({x, y}) - expected.color);
            const double largest = std::max({off.x, off.y, off.z, off.w});
            if (expected.atEdge) {
                ++grazing;
                continue;
            }
            sum += (off.x + off.y + off.z + off.w) / 4.0;
            const double excess = largest - (expected.bound + blending);
            if (!(excess <= worstExcess)) {
                worstExcess = excess;
                worst = "pixel " + std::to_string(x) + "," + std::to_string(y) + ": off by " +
                        std::to_string(largest) + ", bound " + std::to_string(expected.bound) +
                        " + " + std::to_string(blending) + ", alpha " +
                        std::to_string(expected.color.a);
            }
        }
    }
    EXPECT_LE(worstExcess, 0.0) << worst;
    EXPECT_LE(sum / pixels, meanLimit + blending / 2.0) << worst;
    EXPECT_LE(grazing, 0.005 * pixels);
}

} // namespace slabcast::test
