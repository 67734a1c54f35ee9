#pragma once

#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>

#include "core/gl/objects.h"

/// The value, or the end of the program with the reason why there is none.
template <class T>
T orExit(slabcast::Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "consumer: %s\n", result.error().detail.c_str());
        std::exit(1);
    }
    if constexpr (!std::is_void_v<T>) {
        return std::move(*result);
    }
}

/// A black RGBA8 framebuffer, bound, as an application would have one of its own.
struct OwnTarget {
    slabcast::gl::Framebuffer framebuffer = slabcast::gl::Framebuffer::make("target");
    slabcast::gl::Texture colour = slabcast::gl::Texture::make("colour", GL_TEXTURE_2D);

    explicit OwnTarget(int edge) {
        namespace gl = slabcast::gl;
        gl::BindTexture(GL_TEXTURE_2D, colour.id());
        gl::TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, edge, edge);
        gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
        gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.id(),
                                 0);
        gl::Clear(GL_COLOR_BUFFER_BIT);
    }
};
