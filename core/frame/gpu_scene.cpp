#include "core/frame/gpu_scene.h"

#include <span>

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

Result<void> GpuScene::update(const Scene& scene, const FramePlan& plan, const gl::Caps& caps) {
    const int look = scene.lookGeneration();
    const bool pre = plan.variant.classification == Classification::Pre;
    if (Result<void> done = updateVolume(scene, pre, caps); !done) {
        return done;
    }
    if (!pre && tableLook_ != look) {
        if (Result<void> done = keep(table_, uploadTable(scene.table().texels, caps)); !done) {
            return done;
        }
        tableBytes_ = static_cast<std::int64_t>(scene.table().texels.size()) * 8;
        tableLook_ = look;
    }
    if (plan.variant.skip == SkipStructure::None) {
        skip_.release();
        skipBytes_ = 0;
        skipLook_ = -1;
    } else if (skipLook_ != look) {
        SLABCAST_EXPECTS(scene.cloud() != nullptr, 0);
        const ProximityCloud& cloud = *scene.cloud();
        if (Result<void> done = keep(skip_, uploadBytes3d(cloud.freeLengths, cloud.blocks, caps));
            !done) {
            return done;
        }
        skipBytes_ = static_cast<std::int64_t>(cloud.freeLengths.size());
        skipLook_ = look;
    }
    return {};
}

Result<void> GpuScene::updateVolume(const Scene& scene, bool pre, const gl::Caps& caps) {
    const bool current =
        pre ? classifiedLook_ == scene.lookGeneration() : scalars_ == scene.texelsGeneration();
    if (current) {
        return {};
    }
    volume_.release(); // before the next is allocated: two volumes may not fit
    scalars_ = classifiedLook_ = -1;
    SLABCAST_EXPECTS(!pre || scene.classified() != nullptr, pre);
    Result<void> done = pre ? keep(volume_, uploadClassified(scene.classified()->texels.data(),
                                                             scene.classified()->dims, caps))
                            : keep(volume_, uploadTexels(scene.texels(), caps));
    if (!done) {
        return done;
    }
    const std::size_t perTexel = pre ? 4 : bytesPerTexel(scene.texels().format);
    volumeBytes_ = scene.geometry().voxelCount() * static_cast<std::int64_t>(perTexel);
    classifiedLook_ = pre ? scene.lookGeneration() : -1;
    scalars_ = pre ? -1 : scene.texelsGeneration();
    return {};
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
