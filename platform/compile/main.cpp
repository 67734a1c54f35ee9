#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "core/gl/api.h"
#include "core/gl/debug.h"
#include "perf/mobile/compile_variants.h"
#include "perf/mobile/reachable_variants.h"
#include "platform/egl/egl_context.h"

// Compiles segment shaders, each behind a line of JSON on stderr that says which: the compilers
// that perf/mobile runs it under write their statistics there.

namespace {

using namespace slabcast;

constexpr const char* kUsage =
    "usage: slabcast-compile [--only REGEX] [--choices 1|2|3|all] [--empty-loops] [--half GROUPS] "
    "[--list]\n"
    "Compiles the segment shaders that plans reach, by the driver at hand, and draws a pixel with\n"
    "each. Behind a line {\"variant\": ...} on stderr stands what the driver says of it.\n"
    "  --only REGEX    those whose label it is found in; --list shows labels\n"
    "  --labels        those whose labels stand on stdin, a line each, in this order\n"
    "  --choices N     plans of settings that differ from the default in N choices [2]; all: "
    "every\n"
    "                  variant there is\n"
    "  --empty-loops   loops alone, without what they do for layers\n"
    "  --half GROUPS   results of these groups in 16 bits (kHalf... of shader_variant.h)\n"
    "  --list          on stdout a key of each text, and its label; nothing is compiled\n";

struct Request {
    CompileOptions compile;
    std::optional<std::regex> only;
    int choices = 2; // 0: all
    bool labels = false;
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
        if (flag == "--labels") {
            request.labels = true;
        } else if (flag == "--list") {
            request.list = true;
        } else if (flag == "--empty-loops") {
            request.compile.loopBodies = false;
        } else if (flag == "--choices" && value == std::string_view("all")) {
            request.choices = 0;
            ++k;
        } else if (flag == "--only" && *value != '\0') {
            request.only = std::regex(argv[++k]);
        } else if (const auto number = numberOf(value, flag == "--half" ? kHalfAll : 3);
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
    std::map<std::string, ShaderVariant> byLabel;
    std::vector<ShaderVariant> variants;
    for (const ShaderVariant& variant :
         request.choices == 0 ? validVariants() : reachableVariants(request.choices)) {
        const std::string label = labelOf(variant);
        const bool fits = !request.only || std::regex_search(label, *request.only);
        if (!variant.counts && fits && (request.compile.loopBodies || variant.unroll == 0)) {
            byLabel.emplace(label, variant);
            variants.push_back(variant);
        }
    }
    if (request.labels) {
        variants.clear();
        for (std::string label; std::getline(std::cin, label);) {
            const auto found = byLabel.find(label);
            if (found == byLabel.end()) {
                std::fprintf(stderr, "{\"variant\": %s, \"failed\": \"no plan reaches it\"}\n",
                             Json(label).dump().c_str());
            } else {
                variants.push_back(found->second);
            }
        }
    }
    return variants;
}

Result<void> compile(const Request& request, const std::vector<ShaderVariant>& variants) {
    const Result<EglContext> context = EglContext::create({.debug = true});
    if (!context) {
        return tl::unexpected(context.error());
    }
    if (Result<void> loaded = gl::loadApi(context->getProc()); !loaded) {
        return loaded;
    }
    const gl::DebugOutput heard([](const gl::DebugMessage& message) {
        std::fprintf(stderr, "%s\n", Json({{"driver", message.text}}).dump().c_str());
    });
    // Drivers that work in a thread of their own say nothing to who wants it in the call itself.
    gl::Disable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
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
        std::fputs(
            "slabcast-compile: no variant's label is among those asked for; --list shows them\n",
            stderr);
        return 2;
    }
    if (request->list) {
        for (const ShaderVariant& variant : variants) {
            const Result<std::string> key = textKey(variant, request->compile);
            std::printf("%s %s\n", key ? key->c_str() : "-", labelOf(variant).c_str());
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
