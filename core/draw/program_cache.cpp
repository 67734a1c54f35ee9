#include "core/draw/program_cache.h"

#include "core/draw/stack_drawer.h"

namespace slabcast {

Result<const gl::Program*> ProgramCache::need(const ShaderVariant& variant) {
    if (const gl::Program* known = find(variant)) {
        return known;
    }
    const Result<ShaderPair> text = shaderText(variant, measuring_);
    if (!text) {
        return tl::unexpected(text.error());
    }
    return gl::buildProgram(name(variant), text->vertex, text->fragment)
        .map([&](gl::Program&& built) -> const gl::Program* {
            StackDrawer::connect(built);
            return &programs_.emplace(variant, std::move(built)).first->second;
        });
}

const gl::Program* ProgramCache::find(const ShaderVariant& variant) const {
    const auto found = programs_.find(variant);
    return found == programs_.end() ? nullptr : &found->second;
}

void ProgramCache::forget() {
    for (auto& [variant, program] : programs_) {
        program.forget();
    }
    programs_.clear();
}

} // namespace slabcast
