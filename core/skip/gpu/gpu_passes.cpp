#include "core/skip/gpu/gpu_passes.h"

#include <array>
#include <utility>

#include "core/gl/shader_text.h"

namespace slabcast {

namespace {

struct CodingText {
    const char* file;
    const char* channel; // of normalised texels
    const char* most;    // code
};

// In the order of TexelCoding.
constexpr CodingText kCodings[] = {
    {"build/code_unorm.glsl", "r", "255.0"}, {"build/code_unorm.glsl", "r", "65535.0"},
    {"build/code_half.glsl", "", ""},        {"build/code_high_low.glsl", "", ""},
    {"build/code_float.glsl", "", ""},       {"build/code_unorm.glsl", "a", "255.0"},
};

constexpr const char* nodeFormat(int bits) {
    return bits <= 32 ? "r32ui" : bits == 64 ? "rgba16ui" : "rgba32ui";
}

std::string text(int number) {
    return std::to_string(number);
}

int groupsFor(int items, int perGroup) {
    return (items + perGroup - 1) / perGroup;
}

} // namespace

TexelCoding codingOf(TexelFormat format) {
    constexpr std::array kOfFormat{TexelCoding::Unorm8, TexelCoding::Unorm16, TexelCoding::Half,
                                   TexelCoding::HighLow, TexelCoding::Float};
    return kOfFormat[static_cast<std::size_t>(format)];
}

BuildPass leavesPass(TexelCoding coding, NodeContent content, bool ofCodes, int edge, int bits) {
    const CodingText& code = kCodings[static_cast<std::size_t>(coding)];
    BuildPass pass{"build/leaves.comp",
                   {{"CODE_FILE", code.file},
                    {"CONTENT", text(static_cast<int>(content))},
                    {"OF_CODES", text(ofCodes)},
                    {"TILE_VOXELS", text(kTileVoxels)},
                    {"THREADS", text(kLeavesThreads)},
                    {"EDGE", text(edge)},
                    {"BITS", text(bits)},
                    {"NODE_FORMAT", nodeFormat(bits)}}};
    if (*code.channel != '\0') {
        pass.defines["CODE_CHANNEL"] = code.channel;
        pass.defines["CODE_MOST"] = code.most;
    }
    return pass;
}

BuildPass parentsPass(NodeContent content, int bits) {
    return {"build/parents.comp",
            {{"CONTENT", text(static_cast<int>(content))},
             {"BITS", text(bits)},
             {"NODE_FORMAT", nodeFormat(bits)}}};
}

BuildPass blocksPass() {
    return {"build/blocks.comp", {}};
}

BuildPass alongXPass(bool ofPartition) {
    return {"build/along_x.comp", {{"OF_PARTITION", text(ofPartition)}}};
}

BuildPass chebyshevPass(int axis, bool toBuffer) {
    return {"build/chebyshev.comp", {{"AXIS", text(axis)}, {"TO_BUFFER", text(toBuffer)}}};
}

BuildPass mergePass() {
    return {"build/merge.comp", {}};
}

BuildPass euclidYPass() {
    return {"build/euclid_y.comp", {}};
}

BuildPass euclidZPass() {
    return {"build/euclid_z.comp", {}};
}

std::vector<BuildPass> allBuildPasses() {
    std::vector<BuildPass> passes = {blocksPass(),
                                     alongXPass(false),
                                     alongXPass(true),
                                     chebyshevPass(1, false),
                                     chebyshevPass(2, false),
                                     chebyshevPass(2, true),
                                     mergePass(),
                                     euclidYPass(),
                                     euclidZPass()};
    struct Kind {
        NodeContent content;
        bool ofCodes;
        int bits;
    };
    constexpr Kind kKinds[] = {
        {NodeContent::Occupied, false, 8}, {NodeContent::Range, true, 32},
        {NodeContent::Range, false, 32},   {NodeContent::Bits, false, 8},
        {NodeContent::Bits, false, 16},    {NodeContent::Bits, false, 32},
        {NodeContent::Bits, false, 64},    {NodeContent::Bits, false, 128},
    };
    for (const auto& [content, ofCodes, bits] : kKinds) {
        if (ofCodes || content != NodeContent::Range) {
            passes.push_back(parentsPass(content, bits));
        }
        for (const TexelCoding coding :
             {TexelCoding::Unorm8, TexelCoding::Unorm16, TexelCoding::Half, TexelCoding::HighLow,
              TexelCoding::Float, TexelCoding::Alpha}) {
            for (const int edge : {1, 2, 4, 8}) {
                passes.push_back(leavesPass(coding, content, ofCodes, edge, bits));
            }
        }
    }
    return passes;
}

Result<std::string> passText(const BuildPass& pass) {
    return expandShader(pass.file, pass.defines);
}

Result<const gl::Program*> BuildPrograms::use(const BuildPass& pass) {
    auto found = programs_.find(pass);
    if (found == programs_.end()) {
        Result<gl::Program> program = passText(pass).and_then(
            [&](const std::string& whole) { return gl::buildComputeProgram(pass.file, whole); });
        if (!program) {
            return tl::unexpected(program.error());
        }
        found = programs_.emplace(pass, std::move(*program)).first;
    }
    found->second.use();
    return &found->second;
}

void BuildPrograms::forget() {
    for (auto& [pass, program] : programs_) {
        program.forget();
    }
    programs_.clear();
}

void bindInput(GLuint unit, GLenum target, const gl::Texture& texture) {
    gl::ActiveTexture(GL_TEXTURE0 + unit);
    gl::BindTexture(target, texture.id());
    gl::BindSampler(unit, 0);
    gl::ActiveTexture(GL_TEXTURE0);
}

void bindOutput(const gl::Texture& texture, GLenum format) {
    gl::BindImageTexture(0, texture.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, format);
}

void setUniform(const gl::Program& program, const char* name, int value) {
    gl::Uniform1i(program.uniform(name), value);
}

void setUniform(const gl::Program& program, const char* name, glm::ivec3 value) {
    gl::Uniform3i(program.uniform(name), value.x, value.y, value.z);
}

void runPerTexel(const gl::Program& program, glm::ivec3 texels) {
    setUniform(program, "texels", texels);
    runGroups({groupsFor(texels.x, 4), groupsFor(texels.y, 8), groupsFor(texels.z, 4)});
}

void runGroups(glm::ivec3 groups) {
    gl::DispatchCompute(GLuint(groups.x), GLuint(groups.y), GLuint(groups.z));
    // The image barrier also keeps a later pass from writing what an earlier one still reads; that
    // of updates, an upload into what was built here.
    gl::MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                      GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

} // namespace slabcast
