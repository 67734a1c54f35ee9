#include "platform/io/pictures/image_jpeg.h"

#include <csetjmp>
#include <cstdio>

// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>

#include <jerror.h>

namespace slabcast {

namespace {

struct Report {
    jpeg_error_mgr manager; // first: the library hands its address out
    std::jmp_buf escape;
    bool isDamaged;
};

[[noreturn]] void leave(j_common_ptr info) {
    std::longjmp(reinterpret_cast<Report*>(info->err)->escape, 1);
}

void stayQuiet(j_common_ptr) {}

/// Below 0: a warning. Some of them leave all pixels as they are.
void note(j_common_ptr info, int level) {
    switch (info->err->msg_code) {
    case JWRN_ADOBE_XFORM:
    case JWRN_BOGUS_ICC:
    case JWRN_BOGUS_PROGRESSION:
    case JWRN_JFIF_MAJOR:
        break;
    default:
        if (level < 0) {
            reinterpret_cast<Report*>(info->err)->isDamaged = true;
        }
    }
}

/// Nothing in here may need to be destroyed: the library leaves by a jump.
bool decode(jpeg_decompress_struct& info, Report& report, std::string_view file, int width,
            int height, std::byte* pixels) {
    if (setjmp(report.escape) != 0) {
        return false;
    }
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(file.data()),
                 static_cast<unsigned long>(file.size()));
    jpeg_read_header(&info, TRUE);
    if (info.image_width != static_cast<JDIMENSION>(width) ||
        info.image_height != static_cast<JDIMENSION>(height) || info.num_components != 1) {
        return false;
    }
    info.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&info);
    while (info.output_scanline < info.output_height && !report.isDamaged) {
        JSAMPROW row = reinterpret_cast<JSAMPROW>(pixels) +
                       static_cast<std::size_t>(info.output_scanline) * info.output_width;
        jpeg_read_scanlines(&info, &row, 1);
    }
    if (!report.isDamaged) {
        jpeg_finish_decompress(&info);
    }
    return !report.isDamaged;
}

} // namespace

bool readGreyJpeg(std::string_view file, int width, int height, std::byte* pixels) {
    Report report = {};
    jpeg_decompress_struct info = {};
    info.err = jpeg_std_error(&report.manager);
    report.manager.error_exit = leave;
    report.manager.emit_message = note;
    report.manager.output_message = stayQuiet;
    const bool isRead = decode(info, report, file, width, height, pixels);
    jpeg_destroy_decompress(&info);
    return isRead;
}

} // namespace slabcast
