#include "platform/io/dicom/dicom_header.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

std::optional<std::string> textIn(DcmItem* item, const DcmTagKey& tag, bool within) {
    DcmElement* element = nullptr;
    if (!item || item->findAndGetElement(tag, element, within).bad() || !element ||
        !element->isLeaf()) {
        return std::nullopt;
    }
    const std::string text = dicomText(*element);
    return text.empty() ? std::nullopt : std::optional(text);
}

Error notNumbers(const DicomFile& file, const char* keyword, const std::string& text,
                 std::size_t count) {
    return {
        ErrorCode::InvalidGeometry,
        fmt::format("{}: {} is '{}' and should be {}; correct the element or export the file again",
                    file.path.string(), keyword, oneLine(text),
                    count == 1 ? "a number" : fmt::format("{} numbers", count))};
}

} // namespace

DicomHeader::DicomHeader(DcmDataset& data) : data_(data) {
    data_.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared_);
    data_.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame_);
    data_.findAndGetSequenceItem(DCM_DetectorInformationSequence, detector_);
}

std::string DicomHeader::text(const DcmTagKey& tag) const {
    return textIn(&data_, tag, false).value_or("");
}

std::string DicomHeader::text(const DcmTagKey& tag, int frame) const {
    if (std::optional<std::string> own = ofFrame(tag, frame)) {
        return *own;
    }
    if (std::optional<std::string> common = textIn(shared_, tag, true)) {
        return *common;
    }
    return text(tag);
}

std::string DicomHeader::placeText(const DcmTagKey& tag) const {
    const std::string own = text(tag);
    return own.empty() ? textIn(detector_, tag, false).value_or("") : own;
}

std::optional<std::string> DicomHeader::ofFrame(const DcmTagKey& tag, int frame) const {
    const auto index = static_cast<unsigned long>(frame);
    return perFrame_ && index < perFrame_->card() ? textIn(perFrame_->getItem(index), tag, true)
                                                  : std::nullopt;
}

std::optional<std::int64_t> DicomHeader::integer(const DcmTagKey& tag) const {
    const std::optional<double> real = parseReal(text(tag));
    return real ? std::optional(static_cast<std::int64_t>(std::clamp(*real, -1e15, 1e15)))
                : std::nullopt;
}

std::optional<std::vector<double>> numbersIn(const std::string& text) {
    std::vector<double> all;
    for (const std::string_view part : split(text, '\\')) {
        const std::optional<double> number = parseReal(trimmed(part));
        if (!number || !std::isfinite(*number)) {
            return std::nullopt;
        }
        all.push_back(*number);
    }
    return all;
}

void setFault(DicomFile& file, ErrorCode code, const std::string& why) {
    if (!file.fault) {
        file.fault = Error{code, fmt::format("{}: {}", file.path.string(), why)};
    }
}

std::optional<std::vector<double>> take(DicomFile& file, const char* keyword,
                                        const std::string& text, std::size_t count) {
    if (text.empty()) {
        return std::nullopt;
    }
    std::optional<std::vector<double>> all = numbersIn(text);
    if (!all || all->size() != count) {
        if (!file.fault) {
            file.fault = notNumbers(file, keyword, text, count);
        }
        return std::nullopt;
    }
    return all;
}

} // namespace slabcast
