#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "core/gl/api.h"
#include "perf/mobile/compile_variants.h"
#include "perf/mobile/reachable_variants.h"
#include "platform/egl/egl_context.h"

// Compiles segment shaders, each behind a line of JSON on stderr that says which: the compilers
// that perf/mobile runs it under write their statistics there.

namespace {

using namespace slabcast;

constexpr const char* kUsage =
    "usage: slabcast-compile [--only REGEX] [--choices 1|2] [--empty-loops] [--half GROUPS] "
    "[--list]\n"
    "Compiles the segment shaders that plans reach, by the driver at hand, and draws a pixel with\n"
    "each. Behind a line {\"variant\": ...} on stderr stands what the driver says of it.\n"
    "  --only REGEX    those whose label it is found in; --list shows labels\n"
    "  --choices N     settings that differ from the default in N choices [2]\n"
    "  --empty-loops   loops alone, without what they do for layers\n"
    "  --half GROUPS   results of these groups in 16 bits (kHalf... of shader_variant.h)\n"
    "  --list          labels on stdout, and nothing compiled\n";

struct Request {
    CompileOptions compile;
    std::optional<std::regex> only;
    int choices = 2;
    bool list = false;
};

std::optional<int> numberOf(const char* word, int most) {
    char* end = nullptr;
    const long value = std::strtol(word, &end, 10);
    return *word != '\0' && *end == '\0' && value >= 1 && value <= most
               ? std::optional(static_cast<int>(value))
               : std::nullopt;
}

/// Nothing of words that are not understood.
std::optional<Request> parse(int argc, char** argv) try {
    Request request;
    for (int k = 1; k < argc; ++k) {
        const std::string flag = argv[k];
        const char* const value = k + 1 < argc ? argv[k + 1] : "";
        if (flag == "--list") {
            request.list = true;
        } else if (flag == "--empty-loops") {
            request.compile.loopBodies = false;
        } else if (flag == "--only" && *value != '\0') {
            request.only = std::regex(argv[++k]);
        } else if (const auto number = numberOf(value, flag == "--half" ? kHalfAll : 2);
                   number && (flag == "--choices" || flag == "--half")) {
            (flag == "--half" ? request.compile.measuring.halfGroups : request.choices) = *number;
            ++k;
        } else {
            return std::nullopt;
        }
    }
    return request;
} catch (const std::regex_error&) {
    return std::nullopt;
}

/// Those that draw; programs that count work are nobody's frame.
std::vector<ShaderVariant> chosen(const Request& request) {
    std::vector<ShaderVariant> variants;
    for (const ShaderVariant& variant : reachableVariants(request.choices)) {
        const bool compiledAnyway = request.compile.loopBodies || variant.unroll == 0;
        if (!variant.counts && compiledAnyway &&
            (!request.only || std::regex_search(labelOf(variant), *request.only))) {
            variants.push_back(variant);
        }
    }
    return variants;
}

Result<void> compile(const Request& request, const std::vector<ShaderVariant>& variants) {
    const Result<EglContext> context = EglContext::create();
    if (!context) {
        return tl::unexpected(context.error());
    }
    if (Result<void> loaded = gl::loadApi(context->getProc()); !loaded) {
        return loaded;
    }
    const auto say = [](const ShaderVariant& variant, const Error* failure) {
        Json line = describe(variant);
        if (failure != nullptr) {
            line["failed"] = failure->detail;
        }
        std::fprintf(stderr, "%s\n", line.dump().c_str());
    };
    const Result<void> compiled = compileVariants(variants, request.compile, say);
    std::fprintf(stderr, "{\"end\": true}\n");
    return compiled;
}

int run(int argc, char** argv) {
    const std::optional<Request> request = parse(argc, argv);
    if (!request) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const std::vector<ShaderVariant> variants = chosen(*request);
    if (variants.empty()) {
        std::fputs("slabcast-compile: no variant's label fits --only; --list shows them\n", stderr);
        return 2;
    }
    if (request->list) {
        for (const ShaderVariant& variant : variants) {
            std::printf("%s\n", labelOf(variant).c_str());
        }
        return std::fflush(stdout) == 0 ? 0 : 1;
    }
    const Result<void> compiled = compile(*request, variants);
    if (!compiled) {
        std::fprintf(stderr, "slabcast-compile: %s\n", compiled.error().detail.c_str());
    }
    return compiled ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) try {
    return run(argc, argv);
} catch (const std::exception& defect) {
    std::fprintf(stderr, "slabcast-compile: a defect of this program (%s)\n", defect.what());
    return 1;
}
