#include "core/gl/program.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/base/stopwatch.h"

namespace slabcast::gl {

namespace {

class Shader : public Object<Shader> {
public:
    Shader(GLenum stage, std::string_view text) : Object(CreateShader(stage), true) {
        const GLchar* data = text.data();
        const auto length = static_cast<GLint>(text.size());
        ShaderSource(id(), 1, &data, &length);
        CompileShader(id());
    }
    static void destroy(GLuint id) { DeleteShader(id); }
};

struct StageText {
    GLenum stage;
    const char* name;
    std::string_view text;
};

/// The log's first lines as one: drivers repeat themselves after them.
std::string firstLines(const std::string& log) {
    constexpr int kLines = 3;
    std::string joined;
    int lines = 0;
    for (std::size_t begin = 0; begin < log.size() && lines < kLines;) {
        const std::size_t end = std::min(log.find('\n', begin), log.size());
        const std::string line = log.substr(begin, end - begin);
        if (line.find_first_not_of(" \t\r") != std::string::npos) {
            joined += (lines++ == 0 ? "" : "; ") + line;
        }
        begin = end + 1;
    }
    return joined.empty() ? "the driver gives no reason" : joined;
}

std::string infoLog(GLuint id, PFNGLGETSHADERIVPROC getParameter,
                    PFNGLGETSHADERINFOLOGPROC getLog) {
    GLint size = 0;
    getParameter(id, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
    GLsizei written = 0;
    getLog(id, static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    return log;
}

tl::unexpected<Error> buildFailure(std::string_view label, std::string_view step,
                                   const std::string& log) {
    return fail(ErrorCode::ShaderCompile, "program \"" + std::string(label) + "\", " +
                                              std::string(step) + ": " + firstLines(log));
}

Result<Program> build(std::string_view label, std::span<const StageText> stages) {
    const Stopwatch watch;
    ProgramObject program = ProgramObject::make(label);
    std::vector<Shader> shaders;
    shaders.reserve(stages.size());
    // All compile before the first is asked: drivers that compile on threads of their own overlap
    // them.
    for (const StageText& stage : stages) {
        AttachShader(program.id(), shaders.emplace_back(stage.stage, stage.text).id());
    }
    for (std::size_t i = 0; i < stages.size(); ++i) {
        GLint compiled = GL_FALSE;
        GetShaderiv(shaders[i].id(), GL_COMPILE_STATUS, &compiled);
        if (compiled != GL_TRUE) {
            return buildFailure(label, stages[i].name,
                                infoLog(shaders[i].id(), GetShaderiv, GetShaderInfoLog));
        }
    }
    LinkProgram(program.id());
    GLint linked = GL_FALSE;
    GetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        return buildFailure(label, "linking",
                            infoLog(program.id(), GetProgramiv, GetProgramInfoLog));
    }
    for (const Shader& shader : shaders) {
        DetachShader(program.id(), shader.id());
    }
    return Program(std::move(program), watch.ms());
}

} // namespace

GLint Program::uniform(std::string_view name) const {
    const auto known = locations_.find(name);
    if (known != locations_.end()) {
        return known->second;
    }
    const std::string text(name);
    const GLint location = GetUniformLocation(id(), text.c_str());
    locations_.emplace(text, location);
    return location;
}

void Program::release() {
    object_.release();
    locations_.clear();
}

void Program::forget() {
    object_.forget();
    locations_.clear();
}

Result<Program> buildProgram(std::string_view label, std::string_view vertexText,
                             std::string_view fragmentText) {
    const StageText stages[] = {{GL_VERTEX_SHADER, "vertex shader", vertexText},
                                {GL_FRAGMENT_SHADER, "fragment shader", fragmentText}};
    return build(label, stages);
}

Result<Program> buildComputeProgram(std::string_view label, std::string_view computeText) {
    const StageText stages[] = {{GL_COMPUTE_SHADER, "compute shader", computeText}};
    return build(label, stages);
}

ActiveResources activeResources(const Program& program) {
    constexpr std::array kSamplers = {GL_SAMPLER_2D, GL_SAMPLER_3D, GL_UNSIGNED_INT_SAMPLER_3D};
    GLint longest = 0;
    ActiveResources active;
    GetProgramiv(program.id(), GL_ACTIVE_UNIFORMS, &active.uniforms);
    GetProgramiv(program.id(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLint i = 0; i < active.uniforms; ++i) {
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        GetActiveUniform(program.id(), static_cast<GLuint>(i), longest, &length, &size, &type,
                         name.data());
        if (std::find(kSamplers.begin(), kSamplers.end(), type) != kSamplers.end()) {
            active.samplers.push_back(name.substr(0, static_cast<std::size_t>(length)));
        }
    }
    std::sort(active.samplers.begin(), active.samplers.end());
    return active;
}

} // namespace slabcast::gl
