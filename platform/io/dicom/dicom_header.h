#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/io/dicom/dicom_dataset.h"
#include "platform/io/dicom/dicom_file.h"

namespace slabcast {

/// Looks elements up as DICOM layers them: for this frame, for all frames, for the whole file.
/// Borrows the dataset.
class DicomHeader {
public:
    explicit DicomHeader(DcmDataset& data);

    // Texts are as dicomText() gives them; empty where there is nothing.
    std::string text(const DcmTagKey& tag) const;
    std::string text(const DcmTagKey& tag, int frame) const;
    /// That of the whole file, or of the detector of nuclear medicine.
    std::string placeText(const DcmTagKey& tag) const;
    /// What is said of this frame alone.
    std::optional<std::string> ofFrame(const DcmTagKey& tag, int frame) const;

    std::optional<std::int64_t> integer(const DcmTagKey& tag) const;
    bool has(const DcmTagKey& tag) const { return data_.tagExists(tag); }
    DcmDataset& data() const { return data_; }

private:
    DcmDataset& data_;
    DcmItem* shared_ = nullptr;
    DcmItem* detector_ = nullptr;
    DcmSequenceOfItems* perFrame_ = nullptr;
};

/// All values of a text; nothing where one is no finite number.
std::optional<std::vector<double>> numbersIn(const std::string& text);

/// Of a file that has none yet.
void setFault(DicomFile& file, ErrorCode code, const std::string& why);

/// So many numbers, or nothing where the text is empty; a fault where it is something else.
std::optional<std::vector<double>> take(DicomFile& file, const char* keyword,
                                        const std::string& text, std::size_t count);

} // namespace slabcast
