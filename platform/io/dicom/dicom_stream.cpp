#include "platform/io/dicom/dicom_stream.h"

#include <algorithm>
#include <string_view>

#include <dcmtk/dcmdata/dcerror.h>
#include <dcmtk/dcmdata/dcistrmf.h>

namespace slabcast {

// The base does not look at the producer while it is made.
DicomStream::DicomStream(const std::filesystem::path& path)
    : DcmInputStream(&producer_), producer_(path), path_(path) {}

DcmInputStreamFactory* DicomStream::newFactory() const {
    const bool isPlain = currentProducer() == &producer_; // else the rest comes deflated
    return isPlain ? new DcmInputFileStreamFactory(OFFilename(path_.c_str()), tell()) : nullptr;
}

DicomStream::Producer::Producer(const std::filesystem::path& path)
    : file(path, std::ios::binary | std::ios::ate) {
    constexpr offile_off_t kPreambleBytes = 128; // DICOM PS3.10, section 7.1
    if (!file.is_open()) {
        condition = EC_InvalidFilename;
        return;
    }
    size = static_cast<offile_off_t>(file.tellg());
    char mark[4];
    at = std::min(kPreambleBytes, size);
    file.seekg(at);
    hasMark = read(mark, 4) == 4 && std::string_view(mark, 4) == "DICM";
    putback(at);
}

offile_off_t DicomStream::Producer::avail() {
    return size - at;
}

offile_off_t DicomStream::Producer::read(void* buffer, offile_off_t length) {
    const offile_off_t asked = std::min(length, avail());
    if (condition.bad() || asked <= 0) {
        return 0;
    }
    file.read(static_cast<char*>(buffer), asked);
    const auto got = static_cast<offile_off_t>(file.gcount());
    if (got < asked) {
        condition = EC_InvalidStream;
    }
    at += got;
    return got;
}

offile_off_t DicomStream::Producer::skip(offile_off_t length) {
    const offile_off_t skipped = std::clamp<offile_off_t>(length, 0, avail());
    at += skipped;
    file.seekg(at);
    return skipped;
}

void DicomStream::Producer::putback(offile_off_t count) {
    if (count < 0 || count > at) {
        condition = EC_PutbackFailed;
        return;
    }
    at -= count;
    file.clear();
    file.seekg(at);
}

} // namespace slabcast
