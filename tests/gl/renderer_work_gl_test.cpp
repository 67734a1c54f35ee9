#include <algorithm>
#include <cmath>
#include <functional>

#include "core/draw/ratio_tuner.h"
#include "core/gl/program.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

class RendererUpkeepTest : public RenderTest {};

class CountersTest : public RenderTest {
protected:
    WorkCounters count(const Scene& scene, const Settings& settings, const View& view) {
        const FramePlan plan = decide(scene, settings);
        const ViewTarget where{view, 0, {0, 0, kSize.x, kSize.y}};
        EXPECT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
        const Result<WorkCounters> counted = renderer().countWork(scene, plan, {&where, 1});
        EXPECT_TRUE(counted.has_value());
        return counted.value_or(WorkCounters{});
    }
};

TEST_F(CountersTest, WhereTargetsDoNotBlendItIsSaid) {
    gl::Caps masked = caps();
    masked.floatBlend = false;
    Result<Renderer> made = Renderer::create(Device(masked, formats(), {}));
    ASSERT_TRUE(made.has_value());
    const Scene scene =
        makeScene(constantVolume({8, 8, 8}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    const FramePlan plan = decide(scene, segments(8, SegmentForm::Loop));
    const ViewTarget where{asymmetricView(scene), 0, {0, 0, kSize.x, kSize.y}};
    EXPECT_TRUE(made->prepare(scene, plan, {&where, 1}).has_value());
    const Result<WorkCounters> counted = made->countWork(scene, plan, {&where, 1});
    ASSERT_FALSE(counted.has_value());
    EXPECT_EQ(counted.error().code, ErrorCode::DeviceUnsupported);
    EXPECT_NE(counted.error().detail.find("GL_EXT_float_blend"), std::string::npos);
}

/// Layers of the groups that a run of layers meets, plane by plane.
int inGroups(LayerRange run, const FramePlan& plan) {
    const int group = groupOf(plan.variant);
    int sum = 0;
    for (int front = 0; front < plan.lattice.total; front += plan.layersPerPlane) {
        const int begin = std::max(run.begin - front, 0);
        const int end = std::min(run.end - front, plan.layersPerPlane);
        // A loop's first group begins where the stay does.
        const int first = plan.variant.unroll > 0 ? begin / group * group : begin;
        sum += begin < end ? (end - first + group - 1) / group * group : 0;
    }
    return sum;
}

/// Layers that are evaluated along a ray: of groups, and where their opacity is baked those that
/// the stay's ends cut, one by one.
int evaluated(const LatticeRay& ray, const FramePlan& plan) {
    const LayerRange met = layersOf(ray, plan.lattice.total);
    if (plan.variant.lengths == Lengths::PerRay || plan.variant.unroll == 1 ||
        plan.variant.unroll == 2) {
        return inGroups(met, plan);
    }
    const auto isCut = [&](int layer) {
        return met.begin < met.end && layerWeight(ray, plan.lattice.total, layer) < 1.0;
    };
    const bool first = isCut(met.begin);
    const bool last = met.end - met.begin > 1 && isCut(met.end - 1);
    return first + last + inGroups({met.begin + first, met.end - last}, plan);
}

/// Layers of a pixel's ray, whose ends may lie `slack` of a layer elsewhere: the fewest and the
/// most.
std::pair<int, int> evaluatedWithin(LatticeRay ray, const FramePlan& plan, double slack) {
    std::pair<int, int> within{1 << 30, 0};
    for (const double begins : {-slack, 0.0, slack}) {
        for (const double ends : {-slack, 0.0, slack}) {
            LatticeRay moved = ray;
            moved.entry += begins;
            moved.exit += ends;
            const int layers = evaluated(moved, plan);
            within = {std::min(within.first, layers), std::max(within.second, layers)};
        }
    }
    return within;
}

// Pixel by pixel: the shader's float32 may move the end of a ray's stay over a layer's, no more.
TEST_F(CountersTest, LayersAreThoseOfTheRays) {
    const Scene scene =
        makeScene(constantVolume({24, 24, 24}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    const View view = asymmetricView(scene);
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
        for (const SegmentCase& segment : kSegmentCases) {
            Settings settings = segments(segment.layersPerPlane, segment.form);
            settings.lattice = lattice;
            const FramePlan plan = decide(scene, settings);
            const RayFrame frame =
                makeRayFrame(view, {0, 0, kSize.x, kSize.y}, scene.geometry(), plan.lattice);
            const ViewTarget where{view, 0, {0, 0, kSize.x, kSize.y}};
            ASSERT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
            const auto pixels = renderer().workPerPixel(scene, plan, where);
            ASSERT_TRUE(pixels.has_value());
            double sum = 0.0;
            int undecided = 0;
            for (int i = 0; i < kSize.x * kSize.y; ++i) {
                const glm::dvec2 middle = glm::dvec2(i % kSize.x, i / kSize.x) + 0.5;
                const auto [fewest, most] = evaluatedWithin(rayAt(frame, middle), plan, 1e-3);
                const double counted = double((*pixels)[std::size_t(i)].layersEvaluated);
                EXPECT_LE(fewest, counted) << i << ", " << name(plan.variant);
                EXPECT_GE(most, counted) << i << ", " << name(plan.variant);
                undecided += fewest != most;
                sum += counted;
            }
            EXPECT_LT(undecided, kSize.x * kSize.y / 100);
            const WorkCounters work = count(scene, settings, view);
            EXPECT_EQ(double(work.layersEvaluated), sum);
            EXPECT_EQ(work.volumeFetches, work.layersEvaluated);
            EXPECT_EQ(work.layersSkipped, 0);
            EXPECT_EQ(work.skipFetches, 0);
        }
    }
}

// One plane is a 10-gon around the sphere's silhouette, of 10 tan(pi/10) r^2; inside the volume
// planes cover all.
TEST_F(CountersTest, FragmentsAreThoseOfThePolygons) {
    const Scene scene =
        makeScene(constantVolume({24, 24, 24}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    Settings settings = segments(kAll, SegmentForm::Loop);
    settings.tighten = false;
    const View outside = orbitView(scene, {30.0, 10.0, 3.0}, 50.0, kSize);
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    const double radiusTangent = std::tan(std::asin(1.0 / 3.0));
    const double pixelsPerTangent = kSize.y / 2.0 / outside.frustum.top;
    const double radius = radiusTangent * pixelsPerTangent;
    const double area = 10.0 * std::tan(0.31415926535) * radius * radius;
    EXPECT_NEAR(double(count(scene, settings, outside).fragments), area,
                0.01 * area); // pixels along its rim
    settings = segments(1, SegmentForm::Loop);
    settings.tighten = false;
    View inside = orbitView(scene, {30.0, 10.0, 0.0}, 50.0, kSize);
    inside.nearDepth =
        0.9 * scene.geometry().boundingSphere().radiusMm; // cuts all but the last planes
    const FramePlan plan = decide(scene, settings);
    const double layers = 0.1 * scene.geometry().boundingSphere().radiusMm / plan.lattice.spacingMm;
    const std::int64_t drawn = count(scene, settings, inside).fragments;
    EXPECT_GE(drawn, std::int64_t(kSize.x) * kSize.y);
    EXPECT_LE(drawn, std::int64_t(kSize.x) * kSize.y * std::int64_t(std::ceil(layers) + 1));
}

TEST_F(CountersTest, SkippingEvaluatesLessOfTheSameLayers) {
    const Volume ball = makeVolume({32, 32, 32}, VoxelType::U8, [](glm::ivec3 v) {
        return glm::distance(glm::dvec3(v), glm::dvec3(9.0, 15.0, 20.0)) < 5.0 ? 200.0 : 0.0;
    });
    const TransferFunction tf{
        .points = {{50.0, glm::dvec3(1.0), 0.0}, {200.0, glm::dvec3(1.0), 0.5}}};
    const Scene scene = makeScene(ball, {.tf = tf});
    const View view = asymmetricView(scene);
    if (!caps().floatBlend) {
        GTEST_SKIP() << kCannotCount;
    }
    for (const SegmentCase& segment : kSegmentCases) {
        Settings settings = segments(segment.layersPerPlane, segment.form);
        settings.tighten = false;
        const WorkCounters all = count(scene, settings, view);
        settings.skip = SkipStructure::Proximity;
        const WorkCounters some = count(scene, settings, view);
        EXPECT_EQ(some.fragments, all.fragments);
        EXPECT_EQ(some.layersEvaluated + some.layersSkipped, all.layersEvaluated);
        // Written-out groups are evaluated whole, wherever in them the ball is; a loop's begin at
        // it.
        const bool loops = decide(scene, settings).variant.unroll == 0;
        EXPECT_LT(some.layersEvaluated, all.layersEvaluated / (loops ? 5 : 3));
        EXPECT_GT(some.layersEvaluated, 0);
        EXPECT_GT(some.skipFetches, 0);
    }
}

/// A sample of what gl::StateGuard documents.
struct StateSample {
    std::vector<GLint> values;

    static StateSample take() {
        StateSample sample;
        for (const GLenum name : {GL_CURRENT_PROGRAM,
                                  GL_VERTEX_ARRAY_BINDING,
                                  GL_DRAW_FRAMEBUFFER_BINDING,
                                  GL_READ_FRAMEBUFFER_BINDING,
                                  GL_VIEWPORT,
                                  GL_SCISSOR_BOX,
                                  GL_BLEND_SRC_RGB,
                                  GL_BLEND_DST_ALPHA,
                                  GL_BLEND_EQUATION_RGB,
                                  GL_DEPTH_WRITEMASK,
                                  GL_ARRAY_BUFFER_BINDING,
                                  GL_UNIFORM_BUFFER_BINDING,
                                  GL_ACTIVE_TEXTURE,
                                  GL_TEXTURE_BINDING_2D,
                                  GL_TEXTURE_BINDING_3D,
                                  GL_SAMPLER_BINDING,
                                  GL_UNPACK_ALIGNMENT,
                                  GL_PACK_ROW_LENGTH,
                                  GL_COLOR_WRITEMASK,
                                  GL_BLEND,
                                  GL_DEPTH_TEST,
                                  GL_CULL_FACE,
                                  GL_SCISSOR_TEST,
                                  GL_STENCIL_TEST,
                                  GL_DITHER}) {
            GLint value[4] = {};
            gl::GetIntegerv(name, value);
            sample.values.insert(sample.values.end(), value, value + 4);
        }
        return sample;
    }
};

TEST_F(RendererUpkeepTest, RefusesAPlanForAnotherLook) {
    const Scene scene =
        makeScene(constantVolume({4, 4, 4}, 5), {.tf = uniformTransfer(1.0, glm::dvec3(1.0))});
    Settings settings = segments(8, SegmentForm::Loop);
    EXPECT_TRUE(renderer().prepare(scene, decide(scene, settings), {}).has_value());
    settings.shaded = true;
    const Result<void> lit = renderer().prepare(scene, decide(scene, settings), {});
    ASSERT_FALSE(lit.has_value());
    EXPECT_EQ(lit.error().code, ErrorCode::InvalidArgument);
    settings.shaded = false;
    const Scene computed =
        makeScene(constantVolume({4, 4, 4}, 5),
                  {.tf = uniformTransfer(1.0, glm::dvec3(1.0)), .shading = ShadingParameters{}});
    Settings baked = settings;
    baked.shaded = true;
    EXPECT_TRUE(renderer().prepare(computed, decide(computed, baked), {}).has_value());
    baked.normals = Normals::Baked;
    EXPECT_FALSE(renderer().prepare(computed, decide(computed, baked), {}).has_value());
    settings.space = CompositingSpace::Linear;
    EXPECT_FALSE(renderer().prepare(scene, decide(scene, settings), {}).has_value());
    settings.space = CompositingSpace::Display;
    settings.classification = Classification::Pre;
    EXPECT_FALSE(renderer().prepare(scene, decide(scene, settings), {}).has_value());
}

TEST_F(RendererUpkeepTest, LeavesTheStateAsItWas) {
    Random random(5);
    const Volume volume = wavyVolume(random, {16, 16, 16}, VoxelType::U8);
    const Scene scene = makeScene(
        volume, {.tf = smoothTransfer(random, 255.0, 0.3), .space = CompositingSpace::Linear});
    gl::ColorTargets target;
    ASSERT_TRUE(target.resize(kSize.x, kSize.y, {GL_RGBA8}).has_value());
    target.begin();
    gl::Texture texture = gl::Texture::make("host's", GL_TEXTURE_2D);
    gl::ActiveTexture(GL_TEXTURE2);
    gl::BindTexture(GL_TEXTURE_2D, texture.id());
    gl::ActiveTexture(GL_TEXTURE1);
    gl::BindTexture(GL_TEXTURE_2D, texture.id());
    gl::Viewport(3, 4, 50, 40);
    gl::Scissor(5, 6, 7, 8);
    gl::Enable(GL_SCISSOR_TEST);
    gl::Enable(GL_DEPTH_TEST);
    gl::BlendFunc(GL_ZERO, GL_SRC_COLOR);
    gl::ColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_FALSE);
    gl::PixelStorei(GL_UNPACK_ALIGNMENT, 2);
    const StateSample before = StateSample::take();
    const std::vector<ViewTarget> views = {
        {asymmetricView(scene), target.framebuffer(), {0, 0, kSize.x, kSize.y}}};

    renderer().contextLost(); // so that everything is made anew
    Settings settings = segments(8, SegmentForm::Loop);
    settings.space = CompositingSpace::Linear; // with a layer of our own
    settings.skip = SkipStructure::Proximity;
    const FramePlan plan = decide(scene, settings);
    ASSERT_TRUE(renderer().prepare(scene, plan, views).has_value());
    EXPECT_EQ(StateSample::take().values, before.values) << "prepare";
    ASSERT_TRUE(renderer().draw(scene, plan, views).has_value());
    EXPECT_EQ(StateSample::take().values, before.values) << "draw";
    EXPECT_EQ(renderer().countWork(scene, plan, views).has_value(), caps().floatBlend);
    EXPECT_EQ(StateSample::take().values, before.values) << "countWork";

    Settings open = segments(1, SegmentForm::Auto);
    open.layersPerPlane.reset();
    open.space = CompositingSpace::Linear;
    const Result<std::vector<RatioMeasurement>> measured =
        measureRatios(renderer(), scene, open, caps(), views);
    EXPECT_EQ(StateSample::take().values, before.values) << "measureRatios";
    gl::Disable(GL_SCISSOR_TEST);
    gl::Disable(GL_DEPTH_TEST);
    gl::ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl::ActiveTexture(GL_TEXTURE0);

    ASSERT_TRUE(measured.has_value());
    for (const RatioMeasurement& measurement : *measured) {
        EXPECT_GT(measurement.frameMs, 0.0);
    }
}

/// A clock for measureRatios(): of every ratio, one frame to warm up, and three that take about
/// what is said of it.
class ScriptedClock {
public:
    explicit ScriptedClock(std::vector<double> ms) : ms_(std::move(ms)) {}
    double operator()() {
        const bool ends = calls_ % 2 == 1;
        const std::size_t frame = calls_++ / 2;
        const double warmUp = 1e6;
        const double shares[] = {warmUp, 1.0, 3.0, 0.5}; // whose median is what is said
        now_ += ends ? ms_.at(frame / 4) * shares[frame % 4] : 17.0;
        return now_;
    }

private:
    std::vector<double> ms_;
    std::size_t calls_ = 0;
    double now_ = 0.0;
};

TEST_F(RendererUpkeepTest, RatiosAreMeasuredUntilOneIsHopeless) {
    const Scene scene =
        makeScene(constantVolume({16, 16, 16}, 5), {.tf = uniformTransfer(0.1, glm::dvec3(1.0))});
    Settings open = segments(1, SegmentForm::Auto);
    open.layersPerPlane.reset();
    const std::vector<ViewTarget> views = {{asymmetricView(scene), 0, {0, 0, kSize.x, kSize.y}}};
    const std::vector<Ratio> candidates = ratioCandidates(open, scene.facts());
    ASSERT_GT(candidates.size(), 3U);
    std::vector<double> even(candidates.size(), 4.0);
    even[1] = 2.0;
    std::vector<double> steep = even;
    steep[2] = 15.9; // not quite eight times the best
    steep[3] = 16.1;
    const auto measure = [&](const std::vector<double>& ms) {
        ScriptedClock clock(ms);
        return measureRatios(renderer(), scene, open, caps(), views, std::ref(clock)).value();
    };
    for (const auto& [script, measured] :
         {std::pair{even, candidates.size()}, std::pair{steep, std::size_t{4}}}) {
        const std::vector<RatioMeasurement> rows = measure(script);
        ASSERT_EQ(rows.size(), measured);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            EXPECT_EQ(rows[i].ratio, candidates[i]);
            EXPECT_NEAR(rows[i].frameMs, script[i], 1e-6);
        }
        const Result<FramePlan> chosen = plan(scene.facts(), open, caps(), rows);
        ASSERT_TRUE(chosen.has_value());
        EXPECT_EQ(chosen->layersPerPlane, candidates[1].layersPerPlane);
    }
}

/// Names of a program's samplers, as the driver reports them.
std::vector<std::string> activeSamplers(const ShaderVariant& variant) {
    const Result<ShaderPair> text = shaderText(variant);
    EXPECT_TRUE(text.has_value());
    const Result<gl::Program> program =
        gl::buildProgram(name(variant), text->vertex, text->fragment);
    EXPECT_TRUE(program.has_value()) << (program ? "" : program.error().detail);
    return gl::activeResources(*program).samplers;
}

TEST_F(RendererUpkeepTest, WhatIsOffIsAbsentFromTheProgram) {
    const std::vector<std::string> scalars = {"transferTable", "volumeTexels"};
    const std::vector<std::string> all = {"skipTexels", "transferTable", "volumeTexels"};
    const std::vector<std::string> counted = {"layerBefore", "transferTable", "volumeTexels"};
    const std::vector<std::string> baked = {"volumeTexels"};
    const std::pair<ShaderVariant, std::vector<std::string>> cases[] = {
        {{.unroll = 4}, scalars},
        {{.skip = SkipForm::Balls, .unroll = 4}, all},
        {{.classification = Classification::Pre, .unroll = 4}, baked},
        {{.classification = Classification::Preintegrated}, scalars},
        {{.terminates = true, .fetchesTarget = true, .counts = true}, counted},
    };
    for (const auto& [variant, expected] : cases) {
        EXPECT_EQ(activeSamplers(variant), expected) << name(variant);
        EXPECT_EQ(samplersOf(variant), expected) << name(variant);
    }
}

} // namespace slabcast::test
