#include "core/gl/shader_text.h"

#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

namespace slabcast {

namespace {

/// Name in an include line, quoted or through defines; empty where the line is no include.
std::string includedFile(const std::string& line,
                         const std::map<std::string, std::string>& defines) {
    constexpr std::string_view kInclude = "#include ";
    if (line.rfind(kInclude, 0) != 0) {
        return {};
    }
    std::string operand = line.substr(kInclude.size());
    if (operand.front() == '"') {
        return operand.substr(1, operand.rfind('"') - 1);
    }
    for (auto define = defines.find(operand); define != defines.end();
         define = defines.find(operand)) {
        operand = define->second;
    }
    return operand;
}

/// Choices of files are for #include alone; they are no GLSL.
bool isFileChoice(std::string_view define) {
    constexpr std::string_view kEnd = "_FILE";
    return define.size() > kEnd.size() && define.substr(define.size() - kEnd.size()) == kEnd;
}

struct Expansion {
    const std::map<std::string, std::string>& defines;
    std::set<std::string> included;
    std::string text;

    Result<void> append(const std::string& file) {
        const auto& texts = shaderTexts();
        const auto found = texts.find(file);
        if (found == texts.end()) {
            return fail(ErrorCode::ShaderCompile,
                        "no shader file named " + file + ": rebuild the library");
        }
        if (!included.insert(file).second) {
            return {};
        }
        const std::string index = std::to_string(std::distance(texts.begin(), found));
        text += "#line 1 " + index + "\n";
        std::istringstream lines(found->second);
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) {
            const std::string inner = includedFile(line, defines);
            if (inner.empty()) {
                text += line + "\n";
                continue;
            }
            if (Result<void> done = append(inner); !done) {
                return done;
            }
            text += "#line " + std::to_string(number + 1) + " " + index + "\n";
        }
        return {};
    }
};

} // namespace

Result<std::string> expandShader(const std::string& file,
                                 const std::map<std::string, std::string>& defines) {
    Expansion expansion{defines, {}, "#version 320 es\n"};
    for (const auto& [key, value] : defines) {
        if (!isFileChoice(key)) {
            expansion.text += "#define " + key + " " + value + "\n";
        }
    }
    if (Result<void> done = expansion.append(file); !done) {
        return tl::unexpected(done.error());
    }
    return std::move(expansion.text);
}

} // namespace slabcast
