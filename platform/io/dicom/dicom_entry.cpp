// The module's way in: platform/io/dicom_module.h.

#include "platform/io/base/readers.h"
#include "platform/io/dicom_module.h"

namespace slabcast {

namespace {

/// The module has a copy of the library's state of its own: it works on its caller's threads.
template <auto read>
Result<Volume> onThreadsOf(const std::filesystem::path& path, const LoadOptions& options,
                           Executor& threads) {
    setExecutor(&threads);
    return read(path, options);
}

constexpr DicomModule kModule = {DicomModule::kVersion,
                                 {kDicomModuleSizes[0], kDicomModuleSizes[1]},
                                 onThreadsOf<readDicomFile>,
                                 onThreadsOf<readDicomSeries>};

} // namespace

} // namespace slabcast

extern "C" __attribute__((visibility("default"))) const slabcast::DicomModule*
slabcastDicomModule() {
    return &slabcast::kModule;
}
