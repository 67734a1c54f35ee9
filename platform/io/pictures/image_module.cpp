#include "platform/io/pictures/image_module.h"

#include <fmt/format.h>

#include "platform/io/base/open_module.h"

namespace slabcast {

Result<const ImageModule*> openImageModule(const char* fileName) {
    return openModule(fileName, kImageModuleEntry)
        .and_then([&](void* symbol) -> Result<const ImageModule*> {
            const ImageModule* module = reinterpret_cast<const ImageModule* (*)()>(symbol)();
            const bool ours = module != nullptr && module->version == ImageModule::kVersion;
            return ours ? Result<const ImageModule*>(module) : otherVersion(fileName);
        });
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
