#include "platform/io/base/open_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

Result<void*> openModule(const char* fileName, const char* symbol) {
    void* handle = dlopen(fileName, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        return fail(ErrorCode::FileUnreadable,
                    oneLine(dlerror())); // begins with the name of what is missing
    }
    void* found = dlsym(handle, symbol);
    return found != nullptr ? Result<void*>(found) : otherVersion(fileName);
}

tl::unexpected<Error> otherVersion(const char* fileName) {
    return fail(ErrorCode::FileUnreadable, fmt::format("{}: is of another version", fileName));
}

} // namespace slabcast
