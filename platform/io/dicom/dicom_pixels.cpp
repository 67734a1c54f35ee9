#include "platform/io/dicom/dicom_pixels.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dccodec.h>
#include <dcmtk/dcmdata/dcfcache.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <fmt/format.h>

#include "platform/io/dicom/dicom_dataset.h"
#include "platform/io/dicom/dicom_jpeg2000.h"

namespace slabcast {

namespace {

std::size_t cellBytes(const DicomFile& file) {
    return static_cast<std::size_t>(std::max(file.bitsAllocated, 8) / 8);
}

void swapEach(std::byte* bytes, std::size_t count, std::size_t width) {
    for (std::size_t i = 0; i + width <= count; i += width) {
        std::reverse(bytes + i, bytes + i + width);
    }
}

bool isJpeg2000(E_TransferSyntax syntax) {
    return syntax == EXS_JPEG2000 || syntax == EXS_JPEG2000LosslessOnly;
}

bool isJpeg(E_TransferSyntax syntax) {
    return syntax >= EXS_JPEGProcess1 && syntax <= EXS_JPEGProcess14SV1;
}

/// Of a JPEG stream, from its frame header (marker SOF); 0 where none is found.
int bitsOfJpeg(const Uint8* bytes, std::size_t count) {
    for (std::size_t i = 2; i + 4 < count && bytes[i] == 0xff;) {
        const int marker = bytes[i + 1];
        const bool isFrame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (isFrame) {
            return bytes[i + 4];
        }
        i += 2 + static_cast<std::size_t>(bytes[i + 2] << 8 | bytes[i + 3]);
    }
    return 0;
}

} // namespace

struct DicomPixels::Opened {
    const DicomFile* file = nullptr;
    DicomDataset dataset;
    DcmElement* element = nullptr;
    E_TransferSyntax syntax = EXS_Unknown;
    DcmPixelSequence* fragments = nullptr; // of compressed pixels
    DcmFileCache cache;
    Uint32 nextFragment = 0;

    tl::unexpected<Error> broken(ErrorCode code, int frame, const std::string& why) const {
        return fail(code,
                    fmt::format("{}: {}{}; fetch the file again", file->path.string(),
                                file->frames.size() > 1 ? fmt::format("frame {}: ", frame + 1) : "",
                                why));
    }

    Result<void> readPlain(int frame, std::vector<std::byte>& cells) {
        const auto bits = static_cast<std::uint64_t>(file->frameCells()) *
                          static_cast<std::uint64_t>(file->bitsAllocated);
        const std::uint64_t firstBit = bits * static_cast<std::uint64_t>(frame);
        std::uint64_t begin = firstBit / 8;
        std::uint64_t end = (firstBit + bits + 7) / 8;
        const bool isBigEndian = DcmXfer(syntax).getByteOrder() == EBO_BigEndian;
        // Bytes that were written as words, the other way round.
        const bool inWords = isBigEndian && file->bitsAllocated <= 8 && element->getVR() == EVR_OW;
        if (inWords) {
            begin -= begin % 2;
            end += end % 2;
        }
        std::vector<std::byte> bytes(end - begin);
        const OFCondition read = element->getPartialValue(bytes.data(), static_cast<Uint32>(begin),
                                                          static_cast<Uint32>(bytes.size()), &cache,
                                                          DcmXfer(syntax).getByteOrder());
        if (read.bad()) {
            return broken(ErrorCode::FileTruncated, frame, "ends before its pixels do");
        }
        if (inWords) {
            swapEach(bytes.data(), bytes.size(), 2);
        } else if (isBigEndian == (std::endian::native == std::endian::little)) {
            swapEach(bytes.data(), bytes.size(), cellBytes(*file));
        }
        if (file->bitsAllocated == 1) {
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const std::uint64_t bit = firstBit - 8 * begin + i;
                cells[i] = (bytes[bit / 8] >> (bit % 8)) & std::byte{1};
            }
            return {};
        }
        std::memcpy(cells.data(), bytes.data() + (firstBit / 8 - begin), cells.size());
        return {};
    }

    /// The bytes of one frame's fragments, one behind the other.
    std::vector<std::byte> joined(int frame) const {
        const auto frames = static_cast<Sint32>(file->frames.size());
        const auto last = static_cast<Uint32>(fragments->card());
        Uint32 begin = 1;
        Uint32 end = last;
        if (frames > 1 &&
            DcmCodec::determineStartFragment(static_cast<Uint32>(frame), frames, fragments, begin)
                .bad()) {
            return {};
        }
        if (frame + 1 < frames &&
            DcmCodec::determineStartFragment(static_cast<Uint32>(frame + 1), frames, fragments, end)
                .bad()) {
            return {};
        }
        std::vector<std::byte> all;
        for (Uint32 i = begin; i < end; ++i) {
            DcmPixelItem* item = nullptr;
            Uint8* bytes = nullptr;
            if (fragments->getItem(item, i).good() && item->getUint8Array(bytes).good() && bytes) {
                const auto* data = reinterpret_cast<const std::byte*>(bytes);
                all.insert(all.end(), data, data + item->getLength());
            }
        }
        return all;
    }

    Result<void> readJpeg2000(int frame, std::vector<std::byte>& cells) const {
        const std::vector<std::byte> stream = joined(frame);
        const Result<std::vector<std::int32_t>> samples =
            decodeJpeg2000(stream, file->columns, file->rows);
        if (!samples) {
            return broken(samples.error().code, frame, samples.error().detail);
        }
        const std::size_t width = cellBytes(*file);
        for (std::size_t i = 0; i < samples->size(); ++i) {
            const auto sample = static_cast<std::uint32_t>((*samples)[i]);
            const auto byte = static_cast<std::uint8_t>(sample);
            const auto word = static_cast<std::uint16_t>(sample);
            std::byte* cell = cells.data() + i * width;
            std::memcpy(cell,
                        width == 1   ? static_cast<const void*>(&byte)
                        : width == 2 ? static_cast<const void*>(&word)
                                     : &sample,
                        width);
        }
        return {};
    }

    /// Whether 16 bits are allocated and the stream has 8: it is decoded to one byte each.
    bool isNarrowJpeg(int frame) const {
        if (!isJpeg(syntax) || file->bitsAllocated != 16) {
            return false;
        }
        Uint32 start = 1;
        const auto frames = static_cast<Sint32>(file->frames.size());
        DcmPixelItem* item = nullptr;
        Uint8* bytes = nullptr;
        if (frames > 1 &&
            DcmCodec::determineStartFragment(static_cast<Uint32>(frame), frames, fragments, start)
                .bad()) {
            return false;
        }
        if (fragments->getItem(item, start).bad() || item->getUint8Array(bytes).bad() || !bytes) {
            return false;
        }
        const int bits = bitsOfJpeg(bytes, item->getLength());
        return bits > 0 && bits <= 8;
    }

    Result<void> readCompressed(int frame, std::vector<std::byte>& cells) {
        auto& pixels = static_cast<DcmPixelData&>(*element);
        std::vector<std::byte> decoded(cells.size() + cells.size() % 2);
        OFString colours;
        const OFCondition read = pixels.getUncompressedFrame(
            &dataset.data(), static_cast<Uint32>(frame), nextFragment, decoded.data(),
            static_cast<Uint32>(decoded.size()), colours, &cache);
        if (read.bad()) {
            return broken(ErrorCode::FileUnreadable, frame,
                          fmt::format("its pixels ({}) are damaged or cut off",
                                      DcmXfer(syntax).getXferName()));
        }
        if (isNarrowJpeg(frame)) {
            for (std::size_t i = 0; i < cells.size() / 2; ++i) {
                const auto wide = std::to_integer<std::uint16_t>(decoded[i]);
                std::memcpy(cells.data() + 2 * i, &wide, 2);
            }
            return {};
        }
        std::memcpy(cells.data(), decoded.data(), cells.size());
        return {};
    }
};

DicomPixels::DicomPixels(std::unique_ptr<Opened> opened) : opened_(std::move(opened)) {}
DicomPixels::~DicomPixels() = default;
DicomPixels::DicomPixels(DicomPixels&& other) noexcept = default;
DicomPixels& DicomPixels::operator=(DicomPixels&& other) noexcept = default;

Result<DicomPixels> DicomPixels::open(const DicomFile& file) {
    SLABCAST_EXPECTS(file.dataset && file.dataset->format, static_cast<double>(file.frames.size()));
    auto opened = std::make_unique<Opened>();
    opened->file = &file;
    opened->dataset = std::move(*file.dataset);
    opened->element = pixelElement(opened->dataset.data());
    opened->syntax = opened->dataset.data().getOriginalXfer();
    if (!opened->element) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: changed while it was read; try again", file.path.string()));
    }
    const DcmXfer syntax(opened->syntax);
    auto* pixels = dynamic_cast<DcmPixelData*>(opened->element);
    if (syntax.isEncapsulated()) {
        const bool known = isJpeg2000(opened->syntax) ||
                           DcmCodecList::canChangeCoding(opened->syntax, EXS_LittleEndianExplicit);
        if (!known || !pixels ||
            pixels->getEncapsulatedRepresentation(opened->syntax, nullptr, opened->fragments)
                .bad() ||
            !opened->fragments) {
            return fail(ErrorCode::UnsupportedType,
                        fmt::format("{}: its pixels are compressed as {} ({}), which is not read; "
                                    "export the series uncompressed",
                                    file.path.string(), syntax.getXferName(), syntax.getXferID()));
        }
    }
    return DicomPixels(std::move(opened));
}

Result<void> DicomPixels::read(int frame, std::vector<std::byte>& cells) try {
    cells.resize(static_cast<std::size_t>(opened_->file->frameCells()) * cellBytes(*opened_->file));
    return !opened_->fragments           ? opened_->readPlain(frame, cells)
           : isJpeg2000(opened_->syntax) ? opened_->readJpeg2000(frame, cells)
                                         : opened_->readCompressed(frame, cells);
} catch (const std::exception& exception) {
    return opened_->broken(ErrorCode::FileUnreadable, frame,
                           fmt::format("its pixels cannot be read ({})", exception.what()));
}

} // namespace slabcast
