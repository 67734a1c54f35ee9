#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "core/draw/renderer.h"
#include "core/gl/color_targets.h"
#include "core/scene/texel_format.h"
#include "perf/stability/appearance.h"
#include "perf/stability/reference_picture.h"
#include "tests/support/gl_fixture.h"

namespace slabcast::test {

/// Seeded by hand and the same on every machine.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double in(double low, double high) {
        return low + (high - low) * std::ldexp(double(engine_() >> 11), -53);
    }
    int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    bool chance(double share) { return in(0.0, 1.0) < share; }
    template <class T>
    T oneOf(std::initializer_list<T> values) {
        return values.begin()[below(static_cast<int>(values.size()))];
    }

private:
    std::mt19937_64 engine_;
};

/// Why a test of work is skipped where extensions are masked.
inline constexpr const char* kCannotCount =
    "work cannot be counted without GL_EXT_float_blend; CountersTest holds that this is said";

using VoxelFormula = std::function<double(glm::ivec3)>;

/// Voxels from a formula; U8, U16 or F32, one mm each where no spacing is given.
Volume makeVolume(glm::ivec3 dims, VoxelType type, const VoxelFormula& formula,
                  glm::dvec3 spacingMm = glm::dvec3(1.0));
Volume constantVolume(glm::ivec3 dims, int value);
/// A few long waves: neighbours differ by a few steps in a hundred, so that a filter's error stays
/// small.
Volume wavyVolume(Random& random, glm::ivec3 dims, VoxelType type,
                  glm::dvec3 spacingMm = glm::dvec3(1.0));

/// One material, whatever the value: an extinction and a colour.
TransferFunction uniformTransfer(double extinctionPerMm, glm::dvec3 color);
/// Five points of random colour and opacity over [0, highest].
TransferFunction smoothTransfer(Random& random, double highest, double mostOpacity);

struct Picture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels; // rows from the bottom up

    glm::dvec4 at(glm::ivec2 p) const {
        return glm::dvec4(pixels[static_cast<std::size_t>(p.y) * size.x + p.x]);
    }
    Picture part(const Viewport& viewport) const;
};

/// Pixels of which any bit differs.
int differingPixels(const Picture& a, const Picture& b);
/// Largest difference of any component.
double largestDifference(const Picture& a, const Picture& b);

View orbitView(const Scene& scene, const OrbitCamera& camera, double fovDegrees, glm::ivec2 size);

/// Planes of so many layers into fp16, nothing skipped or left early.
Settings segments(int layersPerPlane, SegmentForm form);

/// More layers per plane than there are: one plane.
inline constexpr int kAll = 1 << 20;

struct SegmentCase {
    int layersPerPlane;
    SegmentForm form;
};

inline constexpr SegmentCase kSegmentCases[] = {{1, SegmentForm::Unrolled},
                                                {1, SegmentForm::Loop},
                                                {8, SegmentForm::Unrolled},
                                                {11, SegmentForm::Loop},
                                                {kAll, SegmentForm::Loop}};

inline constexpr glm::ivec2 kSize(96, 72);
/// From 2.5 radii away, turned about two axes and seen past the middle: nothing is symmetric. For
/// pictures of kSize.
View asymmetricView(const Scene& scene);

/// One renderer for all tests of the process, so that a shader is compiled once.
class RenderTest : public GlTest {
protected:
    Renderer& renderer();
    const std::vector<TexelFormatTest>& formats();

    Device device(DeviceOptions options = {});
    Scene makeScene(const Volume& volume, const Appearance& appearance,
                    const SkipOptions& skip = {}, bool exact = false);
    FramePlan decide(const Scene& scene, const Settings& settings);
    /// Prepares and draws into a target of the plan's format.
    Picture draw(const Scene& scene, const FramePlan& plan, const View& view, glm::ivec2 size,
                 glm::vec4 background = glm::vec4(0.0F));
    Picture draw(const Scene& scene, const Settings& settings, const View& view, glm::ivec2 size);
    /// The same target where nothing is drawn.
    Picture cleared(const FramePlan& plan, glm::ivec2 size, glm::vec4 background);
};

/// Every pixel within its bound and the blending's; at most 0.5 % of the pixels may graze the box.
/// The mean difference may be `meanLimit` and half of the blending's bound: cutting digits off errs
/// by half a step on average.
void expectMatchesReference(const Picture& picture, const Scene& scene, const FramePlan& plan,
                            const View& view, double meanLimit);

} // namespace slabcast::test
