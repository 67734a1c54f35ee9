#include "platform/io/dicom/dicom_jpeg2000.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <openjpeg.h>

namespace slabcast {

namespace {

struct Source {
    std::span<const std::byte> bytes;
    std::size_t next = 0;
};

OPJ_SIZE_T readSome(void* to, OPJ_SIZE_T count, void* user) {
    Source& source = *static_cast<Source*>(user);
    const std::size_t there = std::min(count, source.bytes.size() - source.next);
    if (there == 0) {
        return static_cast<OPJ_SIZE_T>(-1); // the end, in OpenJPEG's words
    }
    std::memcpy(to, source.bytes.data() + source.next, there);
    source.next += there;
    return there;
}

OPJ_OFF_T skipSome(OPJ_OFF_T count, void* user) {
    Source& source = *static_cast<Source*>(user);
    const auto left = static_cast<OPJ_OFF_T>(source.bytes.size() - source.next);
    const OPJ_OFF_T step = std::clamp<OPJ_OFF_T>(count, 0, left);
    source.next += static_cast<std::size_t>(step);
    return step;
}

OPJ_BOOL seekTo(OPJ_OFF_T place, void* user) {
    Source& source = *static_cast<Source*>(user);
    if (place < 0 || static_cast<std::size_t>(place) > source.bytes.size()) {
        return OPJ_FALSE;
    }
    source.next = static_cast<std::size_t>(place);
    return OPJ_TRUE;
}

tl::unexpected<Error> because(std::string cause) {
    return fail(ErrorCode::FileUnreadable, std::move(cause));
}

} // namespace

Result<std::vector<std::int32_t>> decodeJpeg2000(std::span<const std::byte> bytes, int columns,
                                                 int rows) {
    constexpr std::byte kFirstOfCodestream{0xff}; // else wrapped in the boxes of a .jp2 file
    if (bytes.empty()) {
        return because("no data");
    }
    Source source{bytes};
    const std::unique_ptr<opj_codec_t, void (*)(opj_codec_t*)> codec(
        opj_create_decompress(bytes[0] == kFirstOfCodestream ? OPJ_CODEC_J2K : OPJ_CODEC_JP2),
        opj_destroy_codec);
    const std::unique_ptr<opj_stream_t, void (*)(opj_stream_t*)> stream(
        opj_stream_default_create(OPJ_TRUE), opj_stream_destroy);
    opj_stream_set_read_function(stream.get(), readSome);
    opj_stream_set_skip_function(stream.get(), skipSome);
    opj_stream_set_seek_function(stream.get(), seekTo);
    opj_stream_set_user_data(stream.get(), &source, nullptr);
    opj_stream_set_user_data_length(stream.get(), bytes.size());

    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    opj_image_t* opened = nullptr;
    if (!opj_setup_decoder(codec.get(), &parameters) ||
        !opj_read_header(stream.get(), codec.get(), &opened)) {
        opj_image_destroy(opened);
        return because("its JPEG 2000 header is damaged");
    }
    const std::unique_ptr<opj_image_t, void (*)(opj_image_t*)> image(opened, opj_image_destroy);
    if (image->numcomps != 1 || image->x1 - image->x0 != static_cast<OPJ_UINT32>(columns) ||
        image->y1 - image->y0 != static_cast<OPJ_UINT32>(rows)) {
        return because(fmt::format("JPEG 2000 of {} x {} in {} colours where the header says {} x "
                                   "{} grey",
                                   image->x1 - image->x0, image->y1 - image->y0, image->numcomps,
                                   columns, rows));
    }
    if (!opj_decode(codec.get(), stream.get(), image.get()) ||
        !opj_end_decompress(codec.get(), stream.get()) || !image->comps[0].data) {
        return because("its JPEG 2000 data are damaged or cut off");
    }
    const opj_image_comp_t& grey = image->comps[0];
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (std::size_t{grey.w} * grey.h != count) {
        return because("its JPEG 2000 data are of another size than its header");
    }
    return std::vector<std::int32_t>(grey.data, grey.data + count);
}

} // namespace slabcast
