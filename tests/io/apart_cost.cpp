// What reading apart costs over reading here, and at what memory. usage: apart_cost ROUNDS FILE
// [RAW-LAYOUT] Both in turn; prints milliseconds (median, least, most), their difference, and the
// most memory that a process took.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sys/resource.h>

#include "platform/io/load_volume.h"

using namespace slabcast;

namespace {

double readMs(const char* file, LoadOptions options, ReadIn process) {
    options.process = process;
    const auto begin = std::chrono::steady_clock::now();
    const Result<Volume> volume = loadVolume(file, options);
    unsigned sum = 0; // as whoever uses them would, every page is looked at
    for (std::size_t i = 0; volume && i < volume->voxels.size(); i += 4096) {
        sum += static_cast<unsigned>(volume->voxels[i]);
    }
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
    if (!volume) {
        std::fprintf(stderr, "%s\n", volume.error().detail.c_str());
        std::exit(1);
    }
    return sum == 0xFFFFFFFFU ? -1.0 : ms.count();
}

double median(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double peakMib(int who) {
    rusage usage{};
    getrusage(who, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: apart_cost ROUNDS FILE [RAW-LAYOUT]\n", stderr);
        return 2;
    }
    LoadOptions options;
    if (argc > 3) {
        options.raw = parseRawLayout(argv[3]).value();
    }
    std::vector<double> apart;
    std::vector<double> here;
    std::vector<double> more;
    readMs(argv[2], options, ReadIn::OwnProcess); // once, for the file to be in memory
    const double peakApart = peakMib(RUSAGE_SELF);
    const double peakReader = peakMib(RUSAGE_CHILDREN);
    for (int round = 0; round < std::atoi(argv[1]); ++round) {
        apart.push_back(readMs(argv[2], options, ReadIn::OwnProcess));
        here.push_back(readMs(argv[2], options, ReadIn::ThisProcess));
        more.push_back(apart.back() - here.back());
    }
    for (auto [name, values] : {std::pair("apart", &apart), {"here", &here}, {"more", &more}}) {
        const double middle = median(*values);
        std::printf("%-6s %8.1f ms (%.1f to %.1f)\n", name, middle, values->front(),
                    values->back());
    }
    std::printf("peak   %8.1f MiB apart, its reader %.1f, %.1f here\n", peakApart, peakReader,
                peakMib(RUSAGE_SELF));
    return 0;
}
