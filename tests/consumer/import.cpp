// Loads a volume with the installed importers: what they link privately must have been found.
#include <cstdio>

#include "platform/io/load_volume.h"

int main(int argc, char** argv) {
    const auto volume = slabcast::loadVolume(argc > 1 ? argv[1] : "");
    if (!volume) {
        std::fprintf(stderr, "import: %s\n", volume.error().detail.c_str());
        return 1;
    }
    std::printf("import: %s, last value %g\n", volume->name.c_str(),
                volume->valueAt(volume->geometry.dims - 1));
}
