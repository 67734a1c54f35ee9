#pragma once

// What an application has of its own, as small as can be: a context, GL functions, a volume.

#define GL_GLES_PROTOTYPES 0
#include <GLES3/gl32.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include <slabcast/slabcast.h>

#include "platform/egl/egl_context.h"

/// The value, or the end of the program with the reason why there is none.
template <class T>
T orExit(slabcast::Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().detail.c_str());
        std::exit(1);
    }
    if constexpr (!std::is_void_v<T>) {
        return std::move(*result);
    }
}

#define HOST_GL_FUNCTIONS(X)                                                                       \
    X(GenTextures, GENTEXTURES)                                                                    \
    X(BindTexture, BINDTEXTURE)                                                                    \
    X(TexStorage2D, TEXSTORAGE2D)                                                                  \
    X(TexStorage3D, TEXSTORAGE3D) X(GenFramebuffers, GENFRAMEBUFFERS)                              \
        X(BindFramebuffer, BINDFRAMEBUFFER) X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)          \
            X(FramebufferTextureLayer, FRAMEBUFFERTEXTURELAYER) X(ClearColor, CLEARCOLOR)          \
                X(Clear, CLEAR) X(ReadPixels, READPIXELS)

/// A context without a window, current, and GL's functions as this application calls them.
struct Host {
    slabcast::EglContext context = orExit(slabcast::EglContext::create());
#define HOST_GL_DECLARE(name, type)                                                                \
    PFNGL##type##PROC name = reinterpret_cast<PFNGL##type##PROC>(context.getProc()("gl" #name));
    HOST_GL_FUNCTIONS(HOST_GL_DECLARE)
#undef HOST_GL_DECLARE

    /// A black RGBA8 framebuffer of a texture.
    GLuint framebuffer(int width, int height) const {
        GLuint texture = 0;
        GLuint framebuffer = 0;
        GenTextures(1, &texture);
        BindTexture(GL_TEXTURE_2D, texture);
        TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
        GenFramebuffers(1, &framebuffer);
        BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
        clear(framebuffer);
        return framebuffer;
    }
    void clear(GLuint framebuffer) const {
        BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
        Clear(GL_COLOR_BUFFER_BIT);
    }
    using Pixels = std::vector<std::array<unsigned char, 4>>; // rows from the bottom up
    Pixels read(GLuint framebuffer, int width, int height) const {
        Pixels pixels(std::size_t(width) * height);
        BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        return pixels;
    }
};

/// Voxels of 1 mm: 255 in the middle, falling to 0 at the radius of half the edge.
inline slabcast::Volume ballVolume(int edge) {
    slabcast::Volume volume;
    volume.name = "ball";
    volume.type = slabcast::VoxelType::U8;
    volume.geometry.dims = glm::ivec3(edge);
    volume.voxels = slabcast::VoxelBytes(std::size_t(edge) * edge * edge);
    for (int i = 0; i < edge * edge * edge; ++i) {
        const glm::dvec3 voxel(i % edge, i / edge % edge, i / edge / edge);
        const double radius = glm::length(voxel + 0.5 - edge / 2.0) / (edge / 2.0);
        volume.voxels[i] = std::byte(radius < 1.0 ? int(255.0 * (1.0 - radius)) : 0);
    }
    return volume;
}
