#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "core/gl/api.h"

namespace slabcast::gl {

/// A GL name with one owner. Kind::destroy is the GL call that deletes it.
template <class Kind>
class Object {
public:
    Object() = default;
    Object(Object&& other) noexcept
        : id_(std::exchange(other.id_, 0)), owned_(std::exchange(other.owned_, false)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(owned_, other.owned_);
        return *this;
    }
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    ~Object() { release(); }

    GLuint id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

    /// Deletes the object now, unless it is borrowed.
    void release() {
        if (owned_ && id_ != 0) {
            Kind::destroy(id_);
        }
        forget();
    }

    /// Drops the name without a GL call: for a context that is lost.
    void forget() {
        id_ = 0;
        owned_ = false;
    }

protected:
    Object(GLuint id, bool owned) : id_(id), owned_(owned) {}

private:
    GLuint id_ = 0;
    bool owned_ = false;
};

/// Objects are made here and labelled at birth, so that debuggers and driver messages name them. GL
/// creates an object when its name is first bound; make() binds and restores what was bound.
/// Contract: the API is loaded. Tested by: gl_objects_gl_test.cpp
class Buffer : public Object<Buffer> {
public:
    static Buffer make(std::string_view label);
    static void destroy(GLuint id) { DeleteBuffers(1, &id); }

private:
    using Object::Object;
};

class Texture : public Object<Texture> {
public:
    /// The target is fixed for life: GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY or GL_TEXTURE_3D.
    static Texture make(std::string_view label, GLenum target);
    /// A texture that someone else owns (a window system, OpenXR): never deleted from here.
    static Texture borrow(GLuint id) { return {id, false}; }
    static void destroy(GLuint id) { DeleteTextures(1, &id); }

private:
    using Object::Object;
};

class Framebuffer : public Object<Framebuffer> {
public:
    static Framebuffer make(std::string_view label);
    static void destroy(GLuint id) { DeleteFramebuffers(1, &id); }

private:
    using Object::Object;
};

class VertexArray : public Object<VertexArray> {
public:
    static VertexArray make(std::string_view label);
    static void destroy(GLuint id) { DeleteVertexArrays(1, &id); }

private:
    using Object::Object;
};

class Sampler : public Object<Sampler> {
public:
    static Sampler make(std::string_view label);
    static void destroy(GLuint id) { DeleteSamplers(1, &id); }

private:
    using Object::Object;
};

class ProgramObject : public Object<ProgramObject> {
public:
    static ProgramObject make(std::string_view label);
    static void destroy(GLuint id) { DeleteProgram(id); }

private:
    using Object::Object;
};

/// glObjectLabel with a length, cut to what GL takes.
void label(GLenum identifier, GLuint id, std::string_view text);

} // namespace slabcast::gl
