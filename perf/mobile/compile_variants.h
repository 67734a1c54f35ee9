#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/plan/shader_variant.h"
#include "perf/json.h"

namespace slabcast {

/// What tells a variant from all others: its name, then what the name leaves out, as
/// "post+balls/unroll16 shells". Tested by: compile_variants_test.cpp
std::string labelOf(const ShaderVariant& variant);

/// Its label, its value on every axis and the layers that are written out, 0 of a loop.
Json describe(const ShaderVariant& variant);

/// A fragment shader of the loop form whose loop composites nothing: what it costs to set a segment
/// up and to go round. Nothing of a text in which no line of its own calls addGroup().
/// Tested by: compile_variants_test.cpp
std::optional<std::string> withoutLoopBody(const std::string& fragmentText);

struct CompileOptions {
    MeasuringText measuring;
    bool loopBodies = true; // else withoutLoopBody()
};

/// Of the text that is compiled, as sixteen hexadecimal digits: the same digits, the same cost.
/// Fails: as shaderText(), and where a loop's body is not found. Tested by:
/// compile_variants_test.cpp
Result<std::string> textKey(const ShaderVariant& variant, const CompileOptions& options);

/// Of a variant that is about to be compiled; and of the failure, where there was one.
using CompileListener = std::function<void(const ShaderVariant& variant, const Error* failure)>;

/// Links each variant and draws one pixel with it: drivers put compiling off until then. Whoever
/// hears the driver knows what it speaks of by `listener`, which is called before each variant and
/// again where it fails; the others follow all the same. Thread: a context is current,
/// gl::loadApi() was called. Leaves the GL state changed. Fails: DeviceOutOfMemory (no target to
/// draw into). Tested by: compile_variants_gl_test.cpp
Result<void> compileVariants(std::span<const ShaderVariant> variants, const CompileOptions& options,
                             const CompileListener& listener);

} // namespace slabcast
