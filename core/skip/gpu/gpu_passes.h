#pragma once

#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/skip/octree.h"
#include "core/volume/texels.h"

namespace slabcast {

/// How a texel's code is found on the GPU.
enum class TexelCoding : std::uint8_t { Unorm8, Unorm16, Half, HighLow, Float, Alpha };

TexelCoding codingOf(TexelFormat format);

/// A compute shader's file and defines.
struct BuildPass {
    std::string file;
    std::map<std::string, std::string> defines;

    bool operator<(const BuildPass& other) const {
        return std::tie(file, defines) < std::tie(other.file, other.defines);
    }
};

/// What makes leaves looks at tiles of so many voxels along each edge, by so many invocations.
constexpr int kTileVoxels = 8;
constexpr int kLeavesThreads = 128;

/// Words of a tile's voxels, two before it and two after it, and of the cells between them.
constexpr int leavesSharedBytes() {
    constexpr int kVoxels = kTileVoxels + 4;
    constexpr int kCells = kVoxels - 1;
    return 4 * (kVoxels * kVoxels * kVoxels + kCells * kCells * kCells);
}

/// What leaves hold: `ofCodes` of codes themselves, else of ranges from a table by code. Leaf edges
/// of 1, 2, 4 and 8.
BuildPass leavesPass(TexelCoding coding, NodeContent content, bool ofCodes, int edge, int bits);
BuildPass parentsPass(NodeContent content, int bits);
BuildPass blocksPass();
BuildPass alongXPass(bool ofPartition);
BuildPass chebyshevPass(int axis, bool toBuffer); // y or z
BuildPass mergePass();
BuildPass euclidYPass();
BuildPass euclidZPass();

/// All that are ever asked for, for tests of the shaders' texts.
std::vector<BuildPass> allBuildPasses();

Result<std::string> passText(const BuildPass& pass);

/// Programs of passes, built when they are first asked for.
class BuildPrograms {
public:
    /// In use from now on. Fails: ShaderCompile.
    Result<const gl::Program*> use(const BuildPass& pass);
    void forget();

private:
    std::map<BuildPass, gl::Program> programs_;
};

/// What passes share. A pass reads textures at units from 0 on and writes image 0, or storage
/// buffers.
void bindInput(GLuint unit, GLenum target, const gl::Texture& texture);
void bindOutput(const gl::Texture& texture, GLenum format);
void setUniform(const gl::Program& program, const char* name, int value);
void setUniform(const gl::Program& program, const char* name, glm::ivec3 value);

/// One invocation per texel, and what it has written can be read, and replaced, by those to come.
/// Sets the uniform `texels`.
void runPerTexel(const gl::Program& program, glm::ivec3 texels);
/// Workgroups as many as given.
void runGroups(glm::ivec3 groups);

} // namespace slabcast
