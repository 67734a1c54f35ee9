#include "perf/edit/bench.h"

#include <algorithm>

#include "core/base/stopwatch.h"
#include "core/draw/warm_up.h"
#include "core/gl/api.h"
#include "perf/frame_times.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

/// Of what the last frame took to draw, for rebuilding: short frames stay short, and have little to
/// gain. A tenth, where such frames vary by a third themselves.
constexpr double kMostOfFrame = 0.1;
constexpr double kLeastMs = 0.1; // or what is begun would never end beside frames of no length

/// Without skipping, and without what it adds.
Settings plain(Settings settings) {
    settings.skip = SkipStructure::None;
    settings.tighten = false;
    return settings;
}

} // namespace

Result<EditBench> EditBench::open(const Stage& stage, const EditDesc& desc,
                                  const FramePlan& decided) {
    Result<Renderer> policys = Renderer::create(stage.device());
    Result<Renderer> others = Renderer::create(stage.device());
    if (!policys || !others) {
        return tl::unexpected(policys ? others.error() : policys.error());
    }
    EditBench bench(stage, desc, std::move(*policys), std::move(*others));
    return bench.makeScenes().and_then([&] { return bench.warmUp(decided); }).map([&] {
        return std::move(bench);
    });
}

Result<void> EditBench::makeScenes() {
    const LiveOptions& live = desc_->live;
    const TransferFunction& start = desc_->script.start;
    naiveSkip_ = live.settled.structure != SkipStructure::None ? live.settled : SkipOptions{};
    Result<Scene> naive = stage_->variation(start, naiveSkip_);
    Result<Scene> edited = stage_->variation(start, live.settled);
    Result<Scene> octree = stage_->variation(start, live.always);
    for (const Result<Scene>* made : {&naive, &edited, &octree}) {
        if (!*made) {
            return tl::unexpected(made->error());
        }
    }
    naive_ = std::move(*naive);
    LiveOptions octreeAlone = live;
    octreeAlone.settled.structure = SkipStructure::None;
    Result<LiveScene> policys = LiveScene::start(std::move(*edited), live);
    Result<LiveScene> octrees = LiveScene::start(std::move(*octree), octreeAlone);
    if (!policys || !octrees) {
        return tl::unexpected(policys ? octrees.error() : policys.error());
    }
    live_ = std::move(*policys);
    octree_ = std::move(*octrees);
    return {};
}

Result<void> EditBench::warmUp(const FramePlan& decided) {
    const ProgressLine progress(stage_->watcher(), "warming up");
    settings_ = desc_->settings;
    settings_.skip.reset(); // by what serves
    settings_.planes.reset();
    settings_.layersPerPlane = decided.layersPerPlane;
    settings_.form = decided.variant.unroll > 0 ? SegmentForm::Unrolled : SegmentForm::Loop;
    const GLenum format = decided.target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    Result<void> done = target_.resize(stage_->desc().size.x, stage_->desc().size.y, {format});
    for (Renderer* renderer : {&policysRenderer_, &othersRenderer_}) {
        done = done.and_then([&] {
            return warmUpForEditing(*renderer, *live_, settings_, stage_->caps(), {},
                                    stage_->views(0.0));
        });
    }
    return done;
}

Result<FramePlan> EditBench::planOf(const Scene& scene, const Settings& settings) const {
    return plan(scene.facts(), settings, stage_->caps(), {});
}

Result<void> EditBench::draw(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                             double turnDegrees) {
    std::vector<ViewTarget> views = stage_->views(turnDegrees);
    for (ViewTarget& view : views) {
        view.framebuffer = target_.framebuffer();
    }
    target_.begin();
    Result<void> drawn = renderer.draw(scene, plan, views);
    gl::Finish();
    return drawn;
}

/// The frame as an application has it: all of it counts. What an application does right before is
/// to draw the last one, and so it is drawn again: after other renderers and counting, caches and
/// threads are cold, which the frame of the octree, being warmed, is not.
Result<void> EditBench::drawLive(const EditFrame& frame, double turnDegrees, EditRow& row) {
    if (lastPlan_) {
        if (Result<void> drawn = draw(policysRenderer_, *live_, *lastPlan_, turnDegrees); !drawn) {
            return drawn;
        }
    }
    Stopwatch watch;
    if (frame.newTransfer) {
        if (Result<void> edited = live_->edit(*frame.newTransfer); !edited) {
            return edited;
        }
    }
    row.editMs = watch.lapMs();
    row.progress =
        live_->work(std::min(desc_->workBudgetMs, std::max(kLeastMs, kMostOfFrame * lastDrawMs_)));
    row.workMs = watch.lapMs();
    const Result<FramePlan> plan = planOf(*live_, settings_);
    Result<void> done = plan ? policysRenderer_.prepare(*live_, *plan, stage_->views(turnDegrees))
                             : tl::unexpected(plan.error());
    row.prepareMs = watch.lapMs();
    done = done.and_then([&] { return draw(policysRenderer_, *live_, *plan, turnDegrees); });
    row.drawMs = lastDrawMs_ = watch.lapMs();
    row.frameMs = row.editMs + row.workMs + row.prepareMs + row.drawMs;
    if (done) {
        row.structure = plan->drawsNothing ? "nothing drawn" : name(plan->skip);
        lastPlan_ = *plan;
    }
    return done;
}

Result<void> EditBench::drawOctree(const EditFrame& frame, double turnDegrees, EditRow& row) {
    Settings settings = settings_;
    settings.skip = octree_->scene().skip().options.structure;
    Result<void> done;
    if (frame.newTransfer) {
        done = octree_->edit(*frame.newTransfer);
    }
    const Result<FramePlan> plan = planOf(*octree_, settings);
    done = plan ? done.and_then([&] {
        return othersRenderer_.prepare(*octree_, *plan, stage_->views(turnDegrees));
    })
                : tl::unexpected(plan.error());
    std::vector<double> times;
    for (int k = -1; k < desc_->octreeFrames && done; ++k) { // -1 warms up
        Stopwatch watch;
        done = draw(othersRenderer_, *octree_, *plan, turnDegrees);
        if (k >= 0) {
            times.push_back(watch.lapMs());
        }
    }
    const FrameTimes summary = summarise(std::move(times));
    row.octreeMs = summary.median;
    row.octreeWorstMs = summary.max;
    return done;
}

/// Builds all anew where there is an edit, and only draws where there is none.
Result<void> EditBench::drawNaive(const EditFrame& frame, double turnDegrees, EditRow& row) {
    Renderer& renderer = othersRenderer_;
    const auto prepared = [&] {
        return planOf(naive_, settings_).and_then([&](FramePlan plan) {
            return renderer.prepare(naive_, plan, stage_->views(turnDegrees)).map([&] {
                return plan;
            });
        });
    };
    Result<FramePlan> plan = prepared(); // its textures, which the octree's took turns with
    if (plan) {
        if (Result<void> warm = draw(renderer, naive_, *plan, turnDegrees); !warm) {
            return warm;
        }
    }
    Stopwatch watch;
    if (frame.newTransfer && plan) {
        Look look = naive_.look();
        look.tf = *frame.newTransfer;
        Needs needs = *naive_.provided();
        needs.skip = naiveSkip_;
        plan = naive_.setLook(std::move(look))
                   .and_then([&] { return naive_.provide(needs); })
                   .and_then(prepared);
    }
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    Result<void> done = draw(renderer, naive_, *plan, turnDegrees);
    row.naiveMs = watch.lapMs();
    return done;
}

/// With the naive policy's scene, which knows of no edits.
Result<void> EditBench::compare(double turnDegrees, const std::vector<glm::vec4>& picture,
                                EditRow& row) {
    const Result<FramePlan> plan = planOf(naive_, plain(settings_));
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    return othersRenderer_.prepare(naive_, *plan, stage_->views(turnDegrees))
        .and_then([&] { return draw(othersRenderer_, naive_, *plan, turnDegrees); })
        .map([&] { row.equal = target_.read() == picture; });
}

Result<EditRow> EditBench::replay(const EditFrame& frame, double turnDegrees) {
    EditRow row{.step = frame.step, .edited = frame.newTransfer.has_value()};
    std::vector<glm::vec4> picture;
    Result<void> done = drawLive(frame, turnDegrees, row);
    if (done && desc_->verify) {
        picture = target_.read();
    }
    done = done.and_then([&] { return drawOctree(frame, turnDegrees, row); }).and_then([&] {
        return drawNaive(frame, turnDegrees, row);
    });
    if (done && desc_->verify) {
        done = compare(turnDegrees, picture, row);
    }
    if (!done) {
        return tl::unexpected(done.error());
    }
    if (const Result<FramePlan> plan = planOf(*live_, settings_); plan) {
        row.counters = policysRenderer_.countWork(*live_, *plan, stage_->views(turnDegrees));
    }
    return row;
}

EditBuilds EditBench::builds() const {
    const LiveSkip& live = live_->live();
    const auto built = [](const BuiltSkip& skip, double ms) {
        return EditBuild{skip.options.structure, skip.options.blockEdgeVoxels, ms, gpuBytes(skip)};
    };
    EditBuilds builds{.always = built(live.always(), live.startMs()),
                      .naiveMs = naive_.skip().buildMs};
    if (live.settled().exists()) {
        builds.settled = built(live.settled(), live.rebuildMs());
    }
    return builds;
}

} // namespace slabcast
