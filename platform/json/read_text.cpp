#include "platform/json/read_text.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace slabcast {

Result<std::string> readText(const std::string& path, const std::string& what) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail(ErrorCode::FileNotFound, path + ": no such " + what + "; check the path");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path, ignored)) {
        return fail(ErrorCode::FileUnreadable,
                    path + ": cannot be read; check that it is a file and its permissions");
    }
    return std::string{std::istreambuf_iterator<char>(file), {}};
}

} // namespace slabcast
