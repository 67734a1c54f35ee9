// Every parser of ours, fed by libFuzzer: tests/fuzz/fuzz.sh. What is parsed must stand what
// follows it, and what has a text form must come back from it.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "perf/error/error_table_json.h"
#include "platform/cli/edit_script.h"
#include "platform/io/apart/wire.h"
#include "platform/io/load_volume.h"
#include "platform/io/volumes/file_header.h"
#include "platform/json/transfer_json.h"

namespace slabcast {
namespace {

void holds(bool condition) {
    if (!condition) {
        std::abort();
    }
}

/// An error is one line of text.
template <class T>
void sound(const Result<T>& result) {
    holds(result || (!result.error().detail.empty() &&
                     result.error().detail.find('\n') == std::string::npos));
}

void rawLayout(std::string_view text) {
    const Result<RawLayout> layout = parseRawLayout(text);
    sound(layout);
    if (layout) {
        const Result<RawLayout> again = parseRawLayout(textOf(*layout));
        holds(again && again->dims == layout->dims && again->spacingMm == layout->spacingMm &&
              again->type == layout->type && again->bigEndian == layout->bigEndian);
    }
}

void selections(std::string_view text) {
    sound(parseSelections(text));
}

/// Of values from 0 to 255.
TransferSubject subject() {
    static const VolumeStatistics statistics = [] {
        VolumeStatistics even;
        even.max = 255.0;
        even.mean = 127.0;
        return even;
    }();
    return {statistics, ""};
}

void transfer(std::string_view text) {
    sound(parseTransferFunction(text, "fuzzed", subject()));
}

void editScript(std::string_view text) {
    const auto byName = [](const std::string&) { // sound, as what presets and files give
        const TransferPoint none{.value = 0.0}, half{.value = 100.0, .opacity = 0.5};
        return Result<TransferFunction>(TransferFunction{.points = {none, half}});
    };
    sound(parseEditScript(text, "fuzzed", byName, subject()));
}

void errorTable(std::string_view text) {
    sound(parseErrorTable(text));
}

void header(const Result<FileHeader>& parsed) {
    sound(parsed);
    if (parsed) {
        sound(check("/nowhere/fuzzed", *parsed));
    }
}

void nrrdHeader(std::string_view text) {
    header(parseNrrdHeader(text, "/nowhere/fuzzed.nrrd"));
}

void metaHeader(std::string_view text) {
    header(parseMetaHeader(text, "/nowhere/fuzzed.mha"));
}

void niftiHeader(std::string_view bytes) {
    header(parseNiftiHeader(bytes, "/nowhere/fuzzed.nii", false));
    header(parseNiftiHeader(bytes, "/nowhere/fuzzed.nii.gz", true));
}

void packets(std::string_view bytes) {
    if (!apart::kindOf(bytes)) {
        return;
    }
    apart::decodeRequest(bytes);
    apart::decodeProgress(bytes);
    apart::decodeFailed(bytes);
    const auto done = apart::decodeVolume(bytes);
    if (done) { // what is taken from another process is checked as a file is
        sound(validated(*done));
    }
}

struct Target {
    std::string_view name;
    void (*feed)(std::string_view input);
};

constexpr Target kTargets[] = {
    {"raw_layout", rawLayout},   {"selections", selections},    {"transfer", transfer},
    {"edit_script", editScript}, {"error_table", errorTable},   {"nrrd_header", nrrdHeader},
    {"meta_header", metaHeader}, {"nifti_header", niftiHeader}, {"packets", packets}};

const Target& chosen() {
    static const Target& target = []() -> const Target& {
        const char* name = std::getenv("SLABCAST_FUZZ");
        for (const Target& candidate : kTargets) {
            if (name != nullptr && candidate.name == name) {
                return candidate;
            }
        }
        std::abort(); // fuzz.sh names one
    }();
    return target;
}

} // namespace
} // namespace slabcast

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    slabcast::chosen().feed({reinterpret_cast<const char*>(data), size});
    return 0;
}
