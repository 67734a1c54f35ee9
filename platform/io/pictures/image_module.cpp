#include "platform/io/pictures/image_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

Result<const ImageModule*> openImageModule(const char* fileName) {
    void* handle = dlopen(fileName, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        return fail(ErrorCode::FileUnreadable,
                    oneLine(dlerror())); // begins with the name of what is missing
    }
    const auto entry = reinterpret_cast<const ImageModule* (*)()>(dlsym(handle, kImageModuleEntry));
    const ImageModule* module = entry != nullptr ? entry() : nullptr;
    if (module == nullptr || module->version != ImageModule::kVersion) {
        return fail(ErrorCode::FileUnreadable, fmt::format("{}: is of another version", fileName));
    }
    return module;
}

Result<const ImageModule*> imageModule(const std::filesystem::path& path, ErrorCode failure) {
    static const Result<const ImageModule*> module = openImageModule(SLABCAST_IMAGE_MODULE);
    if (!module) {
        return fail(
            failure,
            fmt::format(
                "{}: needs OpenImageIO through a module that cannot be opened ({}); install "
                "Slabcast and OpenImageIO again, or name their folders in LD_LIBRARY_PATH",
                path.string(), module.error().detail));
    }
    return module;
}

} // namespace slabcast
