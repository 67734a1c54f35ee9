#include "platform/io/dicom_module.h"

#include <algorithm>

#include <fmt/format.h>

#include "platform/io/base/open_module.h"
#include "platform/io/base/readers.h"

namespace slabcast {

namespace {

Result<const DicomModule*> openDicomModule() {
    return openModule(SLABCAST_DICOM_MODULE, kDicomModuleEntry)
        .and_then([](void* symbol) -> Result<const DicomModule*> {
            const DicomModule* module = reinterpret_cast<const DicomModule* (*)()>(symbol)();
            const bool ours = module != nullptr && module->version == DicomModule::kVersion &&
                              std::ranges::equal(module->sizes, kDicomModuleSizes);
            return ours ? Result<const DicomModule*>(module) : otherVersion(SLABCAST_DICOM_MODULE);
        });
}

Result<const DicomModule*> dicomModule(const std::filesystem::path& path) {
    static const Result<const DicomModule*> module = openDicomModule();
    if (!module) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: needs DCMTK through a module that cannot be opened ({}); "
                                "install Slabcast and DCMTK again, or name their folders in "
                                "LD_LIBRARY_PATH",
                                path.string(), module.error().detail));
    }
    return module;
}

} // namespace

Result<Volume> readDicomFile(const std::filesystem::path& path, const LoadOptions& options) {
    return dicomModule(path).and_then(
        [&](const DicomModule* module) { return module->readFile(path, options, executor()); });
}

Result<Volume> readDicomSeries(const std::filesystem::path& folder, const LoadOptions& options) {
    return dicomModule(folder).and_then(
        [&](const DicomModule* module) { return module->readSeries(folder, options, executor()); });
}

} // namespace slabcast
