#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/gl/objects.h"

namespace slabcast::gl {

/// A linked program. Its shaders are gone once it is built.
class Program {
public:
    Program() = default;
    explicit Program(ProgramObject object, double buildMs)
        : object_(std::move(object)), buildMs_(buildMs) {}

    GLuint id() const { return object_.id(); }
    explicit operator bool() const { return static_cast<bool>(object_); }
    void use() const { UseProgram(object_.id()); }

    /// -1 where the program has no such uniform, which GL's Uniform calls ignore. Looked up once
    /// per name.
    GLint uniform(std::string_view name) const;

    /// Compile and link, until the driver answered whether both went well.
    double buildMs() const { return buildMs_; }

    void release();
    void forget();

private:
    ProgramObject object_;
    double buildMs_ = 0.0;
    mutable std::map<std::string, GLint, std::less<>> locations_;
};

/// Fails: ShaderCompile, with the label, the stage and the first lines of the driver's log.
/// Tested by: gl_objects_gl_test.cpp
Result<Program> buildProgram(std::string_view label, std::string_view vertexText,
                             std::string_view fragmentText);
Result<Program> buildComputeProgram(std::string_view label, std::string_view computeText);

/// What a program uses, by the driver's own account.
struct ActiveResources {
    int uniforms = 0;                  // members of uniform blocks and samplers included
    std::vector<std::string> samplers; // in alphabetical order
};

/// Tested by: left_out_gl_test.cpp
ActiveResources activeResources(const Program& program);

} // namespace slabcast::gl
