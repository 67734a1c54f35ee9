// Whole files, broken in many ways, through the program that reads files apart: whatever they do to
// a library, the answer is a volume or one line. usage: fuzz_files RUNS SEED FOLDER-FOR-FINDINGS
// FILE-OR-FOLDER... Prints what came of them. Files that broke their reader, or kept it from
// getting on, are findings: kept, and counted in the exit status.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "platform/io/load_volume.h"

namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A few bytes turned, cut, doubled or moved; more often near the beginning, where headers are.
std::string broken(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t end) { return end == 0 ? 0 : random() % end; };
    const auto place = [&] {
        return below(random() % 3 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 1024));
    };
    for (unsigned left = 1 + random() % 4; left > 0 && !bytes.empty(); --left) {
        const std::size_t at = place();
        const std::size_t length = std::min<std::size_t>(1 + below(16), bytes.size() - at);
        switch (random() % 7) {
        case 0:
            bytes[at] = static_cast<char>(random());
            break;
        case 1:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
            break;
        case 2:
            bytes.resize(below(bytes.size()));
            break;
        case 3:
            bytes.erase(at, length);
            break;
        case 4:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 5:
            std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                        random() % 2 ? '\xFF' : '\0');
            break;
        default:
            bytes[at] = static_cast<char>('0' + random() % 10);
            break; // of a text
        }
    }
    return bytes;
}

/// A copy of the file, or of the folder with one file of it broken.
fs::path copyBroken(const fs::path& seed, const fs::path& folder, std::mt19937& random) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const fs::path copy = folder / seed.filename();
    fs::copy(seed, copy, fs::copy_options::recursive);
    std::vector<fs::path> files = {copy};
    if (fs::is_directory(copy)) {
        files.clear();
        for (const auto& entry : fs::recursive_directory_iterator(copy)) {
            if (entry.is_regular_file()) {
                files.push_back(entry.path());
            }
        }
        std::sort(files.begin(), files.end());
    }
    const fs::path& victim = files[random() % files.size()];
    const std::string bytes = broken(contentOf(victim), random);
    std::ofstream(victim, std::ios::binary | std::ios::trunc) << bytes;
    return copy;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fputs("usage: fuzz_files RUNS SEED FOLDER-FOR-FINDINGS FILE-OR-FOLDER...\n", stderr);
        return 2;
    }
    const long runs = std::atol(argv[1]);
    std::mt19937 random(static_cast<unsigned>(std::atol(argv[2])));
    const fs::path findings = argv[3];
    const std::vector<fs::path> seeds(argv + 4, argv + argc);
    fs::create_directories(findings);
    slabcast::LoadOptions options;
    options.limits.stuckSeconds = 5.0;
    options.limits.memoryBytes = std::int64_t{1} << 30;
    const auto isRead = [&](const fs::path& seed) {
        return slabcast::loadVolume(seed, options).has_value();
    };
    if (std::none_of(seeds.begin(), seeds.end(), isRead)) { // or the program, or a module, is missing
        std::fputs("none of the seeds is read as it is: a run would say nothing\n", stderr);
        return 2;
    }
    std::map<std::string, long> came;
    for (long run = 0; run < runs; ++run) {
        const fs::path file = copyBroken(seeds[static_cast<std::size_t>(run) % seeds.size()],
                                         findings / "now", random);
        const auto volume = slabcast::loadVolume(file, options);
        const std::string detail = volume ? "" : volume.error().detail;
        const bool broke = detail.find("its reader") != std::string::npos ||
                           detail.find("no further in") != std::string::npos;
        const bool lines = detail.find('\n') != std::string::npos;
        ++came[broke ? "broke its reader" : lines ? "several lines" : volume ? "read" : "refused"];
        if (broke || lines) {
            fs::rename(findings / "now", findings / std::to_string(run));
            std::printf("%ld: %s\n", run, detail.c_str());
        }
    }
    for (const auto& [what, count] : came) {
        std::printf("%s: %ld of %ld\n", what.c_str(), count, runs);
    }
    return came["several lines"] > 0 ? 1 : 0;
}
