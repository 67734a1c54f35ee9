#include "core/scene/gpu_scene.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "core/plan/shader_resources.h"
#include "core/scene/volume_texture.h"

namespace slabcast {

namespace {

/// A grid in the making takes one, and what serves leaves one.
constexpr std::size_t kMostSpares = 2;
constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
/// Uploaded at a time: the driver's copies stay small beside the structure.
constexpr std::int64_t kStagingBytes = 16 << 20;

int normalsOf(const Scene& scene) {
    return scene.normals() != nullptr ? scene.normalsGeneration() : 0;
}

/// Keeps the texture, or hands on what went wrong.
Result<void> keep(gl::Texture& slot, Result<gl::Texture> made) {
    if (!made) {
        return tl::unexpected(made.error());
    }
    slot = std::move(*made);
    return {};
}

} // namespace

GpuScene::Sources GpuScene::needs(const Scene& scene, const FramePlan& plan) {
    if (plan.drawsNothing) { // for now, where the TF may be another one in the next frame
        const bool stays = scene.live() != nullptr;
        return {stays ? scene.texelsGeneration() : 0, 0, stays ? normalsOf(scene) : 0, {}};
    }
    const int look = scene.lookGeneration();
    const bool pre = plan.variant.classification == Classification::Pre;
    const bool post = plan.variant.classification == Classification::Post;
    const bool baked = post && plan.variant.lengths == Lengths::Baked;
    return {pre ? look : scene.texelsGeneration(),
            pre ? 0 : look,
            plan.variant.normals == Normals::Baked ? scene.normalsGeneration() : 0,
            {plan.variant.table == TableRead::Filtered, baked ? plan.lattice.spacingMm : 0.0}};
}

GpuScene::NeededSkips GpuScene::neededSkips(const Scene& scene, const FramePlan& plan) {
    if (const LiveSkip* live = scene.live()) {
        return {&live->always(), &live->settled(), &live->incoming()};
    }
    const bool skips = plan.skip != SkipStructure::None && !plan.drawsNothing;
    return {skips ? &scene.skip() : nullptr};
}

bool GpuScene::isNeeded(const HeldSkip& one, const NeededSkips& needed) const {
    return std::any_of(needed.begin(), needed.end(), [&](const BuiltSkip* skip) {
        return skip != nullptr && skip->exists() && skip->generation == one.generation;
    });
}

/// Whether the textures are those, whole, and no others.
bool GpuScene::hold(const NeededSkips& needed, bool live) const {
    const bool noneMissing = std::all_of(needed.begin(), needed.end(), [&](const BuiltSkip* skip) {
        const HeldSkip* one = skip == nullptr || !skip->exists() ? nullptr : held(*skip);
        return skip == nullptr || !skip->exists() || (one != nullptr && one->whole());
    });
    const bool noneOld = std::all_of(skips_.begin(), skips_.end(),
                                     [&](const HeldSkip& one) { return isNeeded(one, needed); });
    return noneMissing && noneOld && (live || spares_.empty());
}

const GpuScene::HeldSkip* GpuScene::held(const BuiltSkip& skip) const {
    const auto found = std::find_if(skips_.begin(), skips_.end(), [&](const HeldSkip& one) {
        return one.generation == skip.generation;
    });
    return found == skips_.end() ? nullptr : &*found;
}

GpuScene::HeldSkip* GpuScene::held(const BuiltSkip& skip) {
    return const_cast<HeldSkip*>(std::as_const(*this).held(skip));
}

bool GpuScene::serve(const Scene& scene, const FramePlan& plan) const {
    const bool skips = plan.skip != SkipStructure::None && !plan.drawsNothing;
    const HeldSkip* skip = held(scene.skip());
    return held_ == needs(scene, plan) && (!skips || (skip != nullptr && skip->whole()));
}

Result<void> GpuScene::update(const Scene& scene, const FramePlan& plan, const gl::Caps& caps,
                              gl::StateScope& state) {
    const Sources needed = needs(scene, plan);
    const bool pre = plan.variant.classification == Classification::Pre;
    return updateVolume(scene, pre, needed.volume, caps, state)
        .and_then([&] { return updateNormals(scene, needed.normals, caps, state); })
        .and_then([&] { return updateTable(scene, needed, caps, state); })
        .and_then([&] { return updateSkips(scene, plan, caps, state); });
}

Result<void> GpuScene::updateSkips(const Scene& scene, const FramePlan& plan, const gl::Caps& caps,
                                   gl::StateScope& state) {
    const bool live = scene.live() != nullptr;
    const NeededSkips needed = neededSkips(scene, plan);
    if (hold(needed, live)) {
        return {};
    }
    state.touch();
    const auto firstOld = std::partition(
        skips_.begin(), skips_.end(), [&](const HeldSkip& one) { return isNeeded(one, needed); });
    std::vector<HeldSkip> old(std::make_move_iterator(firstOld),
                              std::make_move_iterator(skips_.end()));
    skips_.erase(firstOld, skips_.end());
    if (!live) { // before the next is allocated: two may not fit
        old.clear();
        spares_.clear();
    }
    for (const BuiltSkip* skip : needed) {
        if (skip == nullptr || !skip->exists()) {
            continue;
        }
        const bool canWait = live && skip == &scene.live()->incoming();
        Result<void> done = skip->octree
                                ? needOctree(*skip, caps)
                                : needGrid(*skip, canWait ? kUploadBytesPerFrame : kAll, caps);
        if (!done) {
            return done;
        }
    }
    for (HeldSkip& one : old) { // not before: the last frame may still be drawn with it
        if (one.blocks.z > 0) {
            spares_.push_back(std::move(one));
        }
    }
    spares_.erase(spares_.begin(), spares_.end() - std::min(spares_.size(), kMostSpares));
    return {};
}

Result<void> GpuScene::needOctree(const BuiltSkip& skip, const gl::Caps& caps) {
    if (held(skip) != nullptr) {
        return {};
    }
    return uploadOctree(*skip.octree, caps).map([&](SkipTexture&& made) {
        skips_.push_back({skip.generation, std::move(made)});
    });
}

Result<GpuScene::HeldSkip> GpuScene::emptyGrid(glm::ivec3 blocks, const gl::Caps& caps) {
    const auto spare = std::find_if(spares_.begin(), spares_.end(),
                                    [=](const HeldSkip& one) { return one.blocks == blocks; });
    if (spare != spares_.end()) {
        HeldSkip one = std::move(*spare);
        spares_.erase(spare);
        one.slices = 0;
        return one;
    }
    return allocateFreeLengths(blocks, caps).map([&](SkipTexture&& made) {
        return HeldSkip{0, std::move(made), blocks};
    });
}

Result<void> GpuScene::needGrid(const BuiltSkip& skip, std::int64_t mostBytes,
                                const gl::Caps& caps) {
    const FreeLengths& grid = *skip.lengths;
    HeldSkip* one = held(skip);
    if (one == nullptr) {
        Result<HeldSkip> empty = emptyGrid(grid.blocks, caps);
        if (!empty) {
            return tl::unexpected(empty.error());
        }
        one = &skips_.emplace_back(std::move(*empty));
        one->generation = skip.generation;
    }
    while (!one->whole() && mostBytes > 0) {
        const int slices = slicesWithin(std::min(mostBytes, kStagingBytes), grid.blocks);
        const int end = std::min(one->slices + slices, grid.blocks.z);
        if (Result<void> done = uploadSlices(one->texture, grid, one->slices, end); !done) {
            return done;
        }
        one->slices = end;
        mostBytes -= kStagingBytes;
    }
    return {};
}

Result<void> GpuScene::updateTable(const Scene& scene, const Sources& needed, const gl::Caps& caps,
                                   gl::StateScope& state) {
    if (held_.table == needed.table && held_.tableContent == needed.tableContent) {
        return {};
    }
    held_.table = 0;
    held_.tableContent = needed.tableContent;
    if (needed.table == 0) {
        if (scene.live() == nullptr) { // else the next TF needs one
            table_.release();
        }
        return {};
    }
    state.touch();
    return table_.fill(scene, needed.tableContent, caps).map([&] { held_.table = needed.table; });
}

Result<void> GpuScene::updateVolume(const Scene& scene, bool pre, int generation,
                                    const gl::Caps& caps, gl::StateScope& state) {
    if (held_.volume == generation) {
        return {};
    }
    state.touch();
    held_.volume = 0;
    volume_.release(); // before the next is allocated: two volumes may not fit
    volumeBytes_ = 0;
    if (generation == 0) {
        return {};
    }
    SLABCAST_EXPECTS(!pre || scene.classified() != nullptr, pre);
    if (!pre && scene.texels().data.empty()) {
        return fail(ErrorCode::InvalidArgument,
                    "the volume's texture must be made, and the scene has let go of its texels "
                    "(Scene::releaseTexels()): create it again from the volume");
    }
    Result<void> done = pre ? keep(volume_, uploadClassified(scene.classified()->texels.data(),
                                                             scene.classified()->dims, caps))
                            : keep(volume_, uploadTexels(scene.texels(), caps));
    if (done) {
        const std::size_t perTexel = pre ? 4 : bytesPerTexel(scene.texels().format);
        volumeBytes_ = scene.geometry().voxelCount() * static_cast<std::int64_t>(perTexel);
        held_.volume = generation;
    }
    return done;
}

Result<void> GpuScene::updateNormals(const Scene& scene, int generation, const gl::Caps& caps,
                                     gl::StateScope& state) {
    if (held_.normals == generation) {
        return {};
    }
    state.touch();
    held_.normals = 0;
    normals_.release(); // before the next are allocated: two may not fit
    normalsBytes_ = 0;
    if (generation == 0) {
        return {};
    }
    SLABCAST_EXPECTS(scene.normals() != nullptr, generation);
    return keep(normals_, uploadNormals(*scene.normals(), caps)).map([&] {
        normalsBytes_ = scene.geometry().voxelCount() * normalsLayout().bytesPerTexel;
        held_.normals = generation;
    });
}

Result<GLuint> GpuScene::volumeTexture(const Scene& scene, bool pre, const gl::Caps& caps,
                                       gl::StateScope& state) {
    const int generation = pre ? scene.lookGeneration() : scene.texelsGeneration();
    return updateVolume(scene, pre, generation, caps, state).map([&] { return volume_.id(); });
}

void GpuScene::adopt(const BuiltSkip& skip, SkipTexture texture) {
    skips_.clear();
    HeldSkip& one = skips_.emplace_back(HeldSkip{skip.generation, std::move(texture)});
    if (skip.lengths) {
        one.blocks = skip.lengths->blocks;
        one.slices = one.blocks.z;
    }
}

std::int64_t GpuScene::skipBytes() const {
    std::int64_t bytes = 0;
    for (const std::vector<HeldSkip>* kept : {&skips_, &spares_}) {
        for (const HeldSkip& one : *kept) {
            bytes += one.texture.bytes;
        }
    }
    return bytes;
}

void GpuScene::bind(const BuiltSkip& skip) const {
    const HeldSkip* skipTexture = held(skip);
    const struct {
        Sampler sampler;
        GLenum target;
        GLuint id;
    } textures[] = {{Sampler::Table, GL_TEXTURE_2D, table_.id()},
                    {Sampler::Skip, GL_TEXTURE_3D,
                     skipTexture != nullptr ? skipTexture->texture.texture.id() : 0},
                    {Sampler::Normals, GL_TEXTURE_3D, normals_.id()},
                    {Sampler::Volume, GL_TEXTURE_3D, volume_.id()}};
    static_assert(unitOf(Sampler::Volume) == 0); // the last: passes after this bind to unit 0
    for (const auto& one : textures) {
        if (one.id != 0) {
            const GLuint unit = unitOf(one.sampler);
            gl::ActiveTexture(GL_TEXTURE0 + unit);
            gl::BindTexture(one.target, one.id);
            gl::BindSampler(unit, 0);
        }
    }
}

void GpuScene::forget() {
    volume_.forget();
    normals_.forget();
    table_.forget();
    for (HeldSkip& one : skips_) {
        one.texture.texture.forget();
    }
    for (HeldSkip& one : spares_) {
        one.texture.texture.forget();
    }
    *this = GpuScene();
}

} // namespace slabcast
