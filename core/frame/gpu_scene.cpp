#include "core/frame/gpu_scene.h"

#include <span>

#include "core/skip/skip_texture.h"
#include "core/volume/volume_texture.h"

namespace slabcast {

namespace {

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
    if (plan.drawsNothing) {
        return {};
    }
    const int look = scene.lookGeneration();
    const bool pre = plan.variant.classification == Classification::Pre;
    return {pre ? look : scene.texelsGeneration(), pre ? 0 : look,
            plan.skip == SkipStructure::None ? 0 : scene.skip().generation};
}

bool GpuScene::serve(const Scene& scene, const FramePlan& plan) const {
    return held_ == needs(scene, plan);
}

Result<void> GpuScene::update(const Scene& scene, const FramePlan& plan, const gl::Caps& caps) {
    const Sources needed = needs(scene, plan);
    if (held_.volume != needed.volume) {
        held_.volume = 0;
        volume_.release(); // before the next is allocated: two volumes may not fit
        volumeBytes_ = 0;
        const bool pre = plan.variant.classification == Classification::Pre;
        if (needed.volume != 0) {
            if (Result<void> done = updateVolume(scene, pre, caps); !done) {
                return done;
            }
        }
        held_.volume = needed.volume;
    }
    if (held_.table != needed.table) {
        held_.table = 0;
        table_.release();
        tableBytes_ = 0;
        if (needed.table != 0) {
            if (Result<void> done = updateTable(scene, caps); !done) {
                return done;
            }
        }
        held_.table = needed.table;
    }
    if (held_.skip != needed.skip) {
        held_.skip = 0;
        skip_.release();
        skipBytes_ = 0;
        skipBytes_ = 0;
        if (needed.skip != 0) {
            const BuiltSkip& skip = scene.skip();
            Result<SkipTexture> made = skip.octree ? uploadOctree(*skip.octree, caps)
                                                   : uploadFreeLengths(*skip.lengths, caps);
            if (!made) {
                return tl::unexpected(made.error());
            }
            skip_ = std::move(made->texture);
            skipBytes_ = made->bytes;
        }
        held_.skip = needed.skip;
    }
    return {};
}

Result<void> GpuScene::updateTable(const Scene& scene, const gl::Caps& caps) {
    if (const PreintegratedTable* square = scene.preintegrated()) {
        tableBytes_ = static_cast<std::int64_t>(square->texels.size()) * 8;
        return keep(table_, uploadSquareTable(square->texels, caps));
    }
    const TransferTable& table = scene.table();
    tableBytes_ = static_cast<std::int64_t>(table.texels.size()) * (table.wide ? 16 : 8);
    return keep(table_, uploadTable(table.texels, table.wide, caps));
}

Result<void> GpuScene::updateVolume(const Scene& scene, bool pre, const gl::Caps& caps) {
    SLABCAST_EXPECTS(!pre || scene.classified() != nullptr, pre);
    const std::size_t perTexel = pre ? 4 : bytesPerTexel(scene.texels().format);
    volumeBytes_ = scene.geometry().voxelCount() * static_cast<std::int64_t>(perTexel);
    return pre ? keep(volume_, uploadClassified(scene.classified()->texels.data(),
                                                scene.classified()->dims, caps))
               : keep(volume_, uploadTexels(scene.texels(), caps));
}

void GpuScene::bind() const {
    const struct {
        GLenum target;
        GLuint id;
    } units[] = {
        {GL_TEXTURE_3D, volume_.id()}, {GL_TEXTURE_2D, table_.id()}, {GL_TEXTURE_3D, skip_.id()}};
    for (GLuint unit = 0; unit < 3; ++unit) {
        gl::ActiveTexture(GL_TEXTURE0 + unit);
        gl::BindTexture(units[unit].target, units[unit].id);
        gl::BindSampler(unit, 0);
    }
}

void GpuScene::forget() {
    for (gl::Texture* texture : {&volume_, &table_, &skip_}) {
        texture->forget();
    }
    *this = GpuScene();
}

} // namespace slabcast
