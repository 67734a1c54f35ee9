#include "perf/mobile/compile_variants.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/draw/stack_drawer.h"
#include "core/gl/api.h"
#include "core/gl/color_targets.h"
#include "core/plan/shader_axes.h"

namespace slabcast {

namespace {

// What a loop does for layers, in segment/form/loop.glsl.
constexpr std::string_view kBody = "addGroup(";

/// A value that no variant's name shows may differ between variants of one name.
bool isNamed(const AxisInfo& axis) {
    for (std::size_t value = 0; value < axis.count; ++value) {
        if (*axis.values[value].suffix != '\0') {
            return true;
        }
    }
    return axis.count == 1;
}

/// What a frame draws with, of one view and one plane that covers one pixel.
class OnePixel {
public:
    Result<void> create() {
        drawer_.create();
        drawer_.reserve(1);
        ProxyStack stack;
        stack.outlines.push_back({.halfSize = glm::dvec2(1.0)});
        drawer_.stage(0, FrameBlock{}, stack, Frustum{}, true);
        drawer_.upload(1);
        const Result<void> made = target_.resize(1, 1, {GL_RGBA8});
        if (made) {
            target_.begin();
            gl::Finish(); // what the driver compiles for itself is compiled now
        }
        return made;
    }

    Result<void> draw(const ShaderVariant& variant, const ShaderPair& text) const {
        const Result<gl::Program> program =
            gl::buildProgram(labelOf(variant), text.vertex, text.fragment);
        if (!program) {
            return tl::unexpected(program.error());
        }
        StackDrawer::connect(*program);
        const StackShape& shape = drawer_.begin(0);
        drawer_.useVertices();
        program->use();
        drawer_.draw(*program, shape, {0, 1, 1});
        gl::Finish();
        gl::UseProgram(0); // else it outlives its deletion
        return {};
    }

private:
    StackDrawer drawer_;
    gl::ColorTargets target_;
};

} // namespace

std::string labelOf(const ShaderVariant& variant) {
    std::string label = name(variant);
    for (const AxisInfo& axis : kAxes) {
        if (!isNamed(axis)) {
            const std::size_t value = axis.valueOf(variant);
            const char* word = axis.values[value].name;
            label += value == 0 ? "" : std::string(" ") + word;
        }
    }
    return label;
}

Json describe(const ShaderVariant& variant) {
    Json axes = Json::object();
    for (const AxisInfo& axis : kAxes) {
        if (axis.count > 1) {
            axes[axis.name] = axis.values[axis.valueOf(variant)].name;
        }
    }
    return {{"variant", labelOf(variant)}, {"layers", variant.unroll}, {"axes", std::move(axes)}};
}

std::optional<std::string> withoutLoopBody(const std::string& fragmentText) {
    std::string text = fragmentText;
    bool found = false;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::size_t first = text.find_first_not_of(' ', begin);
        if (first < end && text.compare(first, kBody.size(), kBody) == 0) {
            std::fill(text.begin() + static_cast<std::ptrdiff_t>(first),
                      text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
            found = true;
        }
        begin = end + 1;
    }
    return found ? std::optional(std::move(text)) : std::nullopt;
}

namespace {

Result<ShaderPair> textOf(const ShaderVariant& variant, const CompileOptions& options) {
    Result<ShaderPair> text = shaderText(variant, options.measuring);
    if (!text || options.loopBodies) {
        return text;
    }
    std::optional<std::string> empty =
        variant.unroll == 0 ? withoutLoopBody(text->fragment) : std::nullopt;
    if (!empty) {
        return fail(ErrorCode::ShaderCompile,
                    labelOf(variant) + ": no loop whose body is " + std::string(kBody) + "...)");
    }
    text->fragment = std::move(*empty);
    return text;
}

} // namespace

Result<std::string> textKey(const ShaderVariant& variant, const CompileOptions& options) {
    const Result<ShaderPair> text = textOf(variant, options);
    if (!text) {
        return tl::unexpected(text.error());
    }
    std::uint64_t hash = 14695981039346656037ULL; // FNV-1a
    for (const std::string* part : {&text->vertex, &text->fragment}) {
        for (const char c : *part) {
            hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
        }
    }
    std::string digits(16, '0');
    for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, hash >>= 4) {
        *digit = "0123456789abcdef"[hash & 15U];
    }
    return digits;
}

Result<void> compileVariants(std::span<const ShaderVariant> variants, const CompileOptions& options,
                             const CompileListener& listener) {
    OnePixel pixel;
    if (Result<void> created = pixel.create(); !created) {
        return created;
    }
    for (const ShaderVariant& variant : variants) {
        listener(variant, nullptr);
        const Result<ShaderPair> text = textOf(variant, options);
        const Result<void> drawn =
            text ? pixel.draw(variant, *text) : Result<void>(tl::unexpected(text.error()));
        if (!drawn) {
            listener(variant, &drawn.error());
        }
    }
    return {};
}

} // namespace slabcast
