#pragma once

#include <map>

#include "core/base/error.h"
#include "core/gl/program.h"
#include "core/plan/shader_variant.h"

namespace slabcast {

/// The variants that were compiled, connected to the drawer's blocks and samplers; all are kept.
class ProgramCache {
public:
    explicit ProgramCache(const MeasuringText& measuring = {}) : measuring_(measuring) {}

    /// Compiles where that was not done yet. Fails: ShaderCompile.
    Result<const gl::Program*> need(const ShaderVariant& variant);
    /// Nothing where it was not compiled.
    const gl::Program* find(const ShaderVariant& variant) const;
    void forget();

private:
    MeasuringText measuring_; // of all texts
    std::map<ShaderVariant, gl::Program> programs_;
};

} // namespace slabcast
