#include "core/plan/known_gpus.h"

#include <string>

#include <gtest/gtest.h>

#include "core/plan/frame_plan.h"
#include "perf/model/reference_work.h"

namespace slabcast {
namespace {

const GpuRates* ratesOf(const KnownGpu& known) {
    for (const GpuRates& gpu : gpuRates()) {
        if (std::string(gpu.renderer) == known.renderer) {
            return &gpu;
        }
    }
    return nullptr;
}

TEST(KnownGpus, HoldWhatTheModelFindsBest) {
    EXPECT_EQ(std::size(kKnownGpus), gpuRates().size());
    for (const KnownGpu& known : kKnownGpus) {
        const GpuRates* gpu = ratesOf(known);
        ASSERT_NE(gpu, nullptr) << known.title;
        EXPECT_EQ(known.layersSkipping, bestLayersPerPlane(*gpu, ReferenceScene::Skull))
            << known.title;
        EXPECT_EQ(known.layersPlain, bestLayersPerPlane(*gpu, ReferenceScene::Full)) << known.title;
    }
}

TEST(KnownGpus, AreFoundByHowTheirRendererBegins) {
    EXPECT_STREQ(findKnownGpu("Adreno (TM) 740v3")->title, "Adreno 740");
    EXPECT_EQ(findKnownGpu("llvmpipe (LLVM 15.0.6, 256 bits)"), nullptr);
    EXPECT_EQ(findKnownGpu(""), nullptr);
}

FramePlan planOn(const char* renderer, const Settings& settings, double occupied = 0.2,
                 std::span<const RatioMeasurement> measured = {}) {
    const SceneFacts facts{.sphere = {glm::dvec3(0.0), 222.0},
                           .skip = {.structure = SkipStructure::Proximity},
                           .occupiedFraction = occupied,
                           .maxExtinctionPerMm = 1.0};
    gl::Caps caps;
    caps.renderer = renderer;
    return plan(facts, settings, caps, measured).value();
}

std::string whyOf(const FramePlan& plan) {
    for (const ReasonText& reason : explained(plan)) {
        if (reason.what.starts_with("ratio ")) {
            return reason.why;
        }
    }
    return "";
}

TEST(KnownGpus, AutoTakesTheModelsRatioAndSaysSo) {
    for (const KnownGpu& known : kKnownGpus) {
        const auto expected = [](int layers, const FramePlan& plan) {
            return layers == 0 ? plan.lattice.total : layers;
        };
        const FramePlan skipping = planOn(known.renderer, {});
        EXPECT_EQ(skipping.layersPerPlane, expected(known.layersSkipping, skipping));
        EXPECT_NE(whyOf(skipping).find(std::string("a model's best on ") + known.title),
                  std::string::npos);
        const FramePlan plain = planOn(known.renderer, {.skip = SkipStructure::None});
        EXPECT_EQ(plain.layersPerPlane, expected(known.layersPlain, plain));
        const FramePlan full = planOn(known.renderer, {}, 1.0);
        EXPECT_EQ(full.layersPerPlane, expected(known.layersPlain, full));
    }
}

TEST(KnownGpus, WhatIsAskedForOrMeasuredGoesBefore) {
    EXPECT_EQ(planOn("Mali-G71", {.layersPerPlane = 5}).layersPerPlane, 5);
    const RatioMeasurement measured[] = {{{222, 2, SegmentForm::Loop}, 1.0}};
    EXPECT_EQ(planOn("Mali-G71", {}, 0.2, measured).layersPerPlane, 2);
}

} // namespace
} // namespace slabcast
