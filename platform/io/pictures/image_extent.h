#pragma once

#include <string_view>

namespace slabcast {

struct ImageExtent {
    bool isWhole = true;
    bool isJpeg = false;
    int highest = 0; // value that can be stored where the type could hold more, 0: the type's
};

/// What decoders do not tell: whether a JPEG or PNG goes on to its end mark, for they fill in grey
/// for what is missing, and only warn (what follows the mark does not matter); and the highest
/// value of a PNG of 1 to 4 bits or a PGM, for they spread values over the whole type. Of another
/// format, or one that is not understood, nothing is said. `bytes`: the whole file's.
/// Tested by: io_images_test.cpp
ImageExtent extentOf(std::string_view bytes);

} // namespace slabcast
