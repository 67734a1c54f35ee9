#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/io_test_support.h"

namespace slabcast::test {

/// Elements of a DICOM file or of one item of a sequence, in explicit little endian. Written by
/// hand, so that they may hold what no library would write.
class DicomElements {
public:
    using Tag = std::uint32_t; // 0x00280010

    DicomElements& text(Tag tag, const char* type, std::string value) {
        value += value.size() % 2 == 0            ? ""
                 : std::string_view(type) == "UI" ? std::string(1, '\0')
                                                  : std::string(" ");
        return raw(tag, type, value);
    }
    DicomElements& word(Tag tag, int value, const char* type = "US") {
        return raw(tag, type, bytesOf(static_cast<std::uint16_t>(value)));
    }
    DicomElements& real(Tag tag, double value) { return raw(tag, "FD", bytesOf(value)); }
    DicomElements& raw(Tag tag, std::string type, std::string value) {
        elements_[tag] = {std::move(type), std::move(value)};
        return *this;
    }
    DicomElements& items(Tag tag, const std::vector<DicomElements>& items) {
        std::string value;
        for (const DicomElements& item : items) {
            const std::string bytes = item.bytes();
            value +=
                tagBytes(0xfffee000) + bytesOf(static_cast<std::uint32_t>(bytes.size())) + bytes;
        }
        return raw(tag, "SQ", value);
    }
    /// Compressed pixels: a fragment a frame.
    DicomElements& fragments(const std::vector<std::string>& all) {
        std::string value = tagBytes(0xfffee000) + bytesOf(std::uint32_t{0});
        for (std::string fragment : all) {
            fragment += fragment.size() % 2 == 0 ? "" : std::string(1, '\0');
            value += tagBytes(0xfffee000) + bytesOf(static_cast<std::uint32_t>(fragment.size())) +
                     fragment;
        }
        value += tagBytes(0xfffee0dd) + bytesOf(std::uint32_t{0});
        return raw(0x7fe00010, "endless", value);
    }
    DicomElements& without(Tag tag) {
        elements_.erase(tag);
        return *this;
    }

    std::string bytes() const {
        std::string all;
        for (const auto& [tag, element] : elements_) {
            const auto& [type, value] = element;
            const auto size = static_cast<std::uint32_t>(value.size());
            if (type == "endless") {
                all += tagBytes(tag) + "OB" + std::string(2, '\0') + bytesOf(0xffffffffu) + value;
            } else if (type == "SQ" || type == "OB" || type == "OW" || type == "OF" ||
                       type == "UN") {
                all += tagBytes(tag) + type + std::string(2, '\0') + bytesOf(size) + value;
            } else {
                all += tagBytes(tag) + type + bytesOf(static_cast<std::uint16_t>(size)) + value;
            }
        }
        return all;
    }

    template <class T>
    static std::string bytesOf(T value) {
        std::string bytes(sizeof(T), '\0');
        std::memcpy(bytes.data(), &value, sizeof(T));
        return bytes;
    }

private:
    static std::string tagBytes(Tag tag) {
        return bytesOf(static_cast<std::uint16_t>(tag >> 16)) +
               bytesOf(static_cast<std::uint16_t>(tag & 0xffff));
    }
    std::map<Tag, std::pair<std::string, std::string>> elements_;
};

/// Numbers with backslashes between.
inline std::string decimals(std::initializer_list<double> numbers) {
    std::string text;
    for (const double number : numbers) {
        std::string digits = std::to_string(number);
        digits.erase(digits.find_last_not_of('0') + 1);
        text += text.empty() ? "" : "\\";
        text += digits.ends_with('.') ? digits + "0" : digits;
    }
    return text;
}

class DicomFilesTest : public IoTest {
protected:
    static constexpr const char* kExplicit = "1.2.840.10008.1.2.1";
    static constexpr const char* kCt = "1.2.840.10008.5.1.4.1.1.2";
    static constexpr const char* kEnhancedMr = "1.2.840.10008.5.1.4.1.1.4.1";
    static constexpr const char* kDose = "1.2.840.10008.5.1.4.1.1.481.2";

    std::filesystem::path writeDicom(const std::string& name, const DicomElements& elements,
                                     const std::string& syntax = kExplicit) const {
        std::filesystem::create_directories(at(name).parent_path());
        DicomElements meta;
        meta.raw(0x00020001, "OB", std::string("\0\1", 2))
            .text(0x00020002, "UI", kCt)
            .text(0x00020003, "UI", "1.2.3.4")
            .text(0x00020010, "UI", syntax);
        const std::string bytes = meta.bytes();
        DicomElements length;
        length.raw(0x00020000, "UL",
                   DicomElements::bytesOf(static_cast<std::uint32_t>(bytes.size())));
        return write(name,
                     std::string(128, '\0') + "DICM" + length.bytes() + bytes + elements.bytes());
    }

    /// What every image has: 16 bits of `codes`, one frame or several; pixels of 0.5 x 2 mm.
    static DicomElements image(const std::string& pixels, int frames = 1) {
        DicomElements elements;
        elements.text(0x00080016, "UI", kCt)
            .text(0x00080018, "UI", "1.2.3.4.5")
            .text(0x00080060, "CS", "CT")
            .text(0x0020000d, "UI", "1.2.3")
            .text(0x0020000e, "UI", "1.2.3.1")
            .word(0x00280002, 1)
            .text(0x00280004, "CS", "MONOCHROME2")
            .word(0x00280010, kDims.y)
            .word(0x00280011, kDims.x)
            .text(0x00280030, "DS", decimals({2, 0.5}))
            .word(0x00280100, 16)
            .word(0x00280101, 16)
            .word(0x00280102, 15)
            .word(0x00280103, 1)
            .raw(0x7fe00010, "OW", pixels);
        if (frames > 1) {
            elements.text(0x00280008, "IS", std::to_string(frames));
        }
        return elements;
    }

    static DicomElements& place(DicomElements& elements, glm::dvec3 at,
                                const std::string& axes = "1\\0\\0\\0\\1\\0") {
        return elements.text(0x00200032, "DS", decimals({at.x, at.y, at.z}))
            .text(0x00200037, "DS", axes);
    }

    /// The z-th slice of the codes, 3 mm above the one before.
    static DicomElements slice(int z) {
        const std::string all = codes<std::int16_t>();
        const std::size_t size = all.size() / kDims.z;
        DicomElements elements = image(all.substr(size * static_cast<std::size_t>(z), size));
        place(elements, {10, -20, 30 + 3.0 * z});
        return elements.text(0x00200013, "IS", std::to_string(z + 1));
    }

    /// All three, each after `change`.
    template <class Change>
    void writeSlices(const Change& change, const std::string& prefix = "") const {
        for (int z = 0; z < kDims.z; ++z) {
            DicomElements elements = slice(z);
            change(elements, z);
            writeDicom(prefix + std::to_string(z) + ".dcm", elements);
        }
    }

    /// Frames with their places in functional groups.
    static DicomElements enhanced(const std::string& pixels, const std::vector<double>& z,
                                  std::vector<DicomElements> groups = {}) {
        groups.resize(z.size());
        for (std::size_t i = 0; i < z.size(); ++i) {
            DicomElements position;
            position.text(0x00200032, "DS", decimals({10, -20, z[i]}));
            groups[i].items(0x00209113, {position});
        }
        DicomElements measures;
        measures.text(0x00280030, "DS", decimals({2, 0.5}));
        DicomElements orientation;
        orientation.text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
        DicomElements shared;
        shared.items(0x00289110, {measures}).items(0x00209116, {orientation});
        return image(pixels, static_cast<int>(z.size()))
            .without(0x00280030)
            .text(0x00080016, "UI", kEnhancedMr)
            .text(0x00080060, "CS", "MR")
            .items(0x52009229, {shared})
            .items(0x52009230, groups);
    }
};

template <class T>
std::string bytesOf(const std::vector<T>& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

} // namespace slabcast::test
