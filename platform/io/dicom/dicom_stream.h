#pragma once

#include <dcmtk/config/osconfig.h> // before all else of DCMTK

#include <filesystem>
#include <fstream>

#include <dcmtk/dcmdata/dcistrma.h>

namespace slabcast {

/// A file as DCMTK reads it, which was opened to look for DICOM's mark first: once for both. What
/// DCMTK leaves in the file for later it opens again, itself.
class DicomStream : public DcmInputStream {
public:
    explicit DicomStream(const std::filesystem::path& path);

    /// Behind the preamble.
    bool hasMark() const { return producer_.hasMark; }

    DcmInputStreamFactory* newFactory() const override;

private:
    struct Producer : DcmProducer {
        explicit Producer(const std::filesystem::path& path);
        OFBool good() const override { return condition.good(); }
        OFCondition status() const override { return condition; }
        OFBool eos() override { return avail() == 0; }
        offile_off_t avail() override;
        offile_off_t read(void* buffer, offile_off_t length) override;
        offile_off_t skip(offile_off_t length) override;
        void putback(offile_off_t count) override;

        std::ifstream file;
        offile_off_t size = 0;
        offile_off_t at = 0;
        bool hasMark = false;
        OFCondition condition = EC_Normal;
    };

    Producer producer_;
    std::filesystem::path path_;
};

} // namespace slabcast
