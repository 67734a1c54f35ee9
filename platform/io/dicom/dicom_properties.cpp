#include "platform/io/dicom/dicom_properties.h"

#include <array>

namespace slabcast {

namespace {

struct Key {
    DicomKey key;
    DcmTagKey tag;
};

const std::array kKeys = {
    Key{{"EchoTime", false}, {0x0018, 0x0081}},
    Key{{"EffectiveEchoTime", false}, {0x0018, 0x9082}},
    Key{{"EchoNumbers", false}, {0x0018, 0x0086}},
    Key{{"DiffusionBValue", false}, {0x0018, 0x9087}},
    Key{{"DiffusionGradientOrientation", false}, {0x0018, 0x9089}},
    Key{{"DiffusionDirectionality", false}, {0x0018, 0x9075}},
    Key{{"InversionTime", false}, {0x0018, 0x0082}},
    Key{{"InversionTimes", false}, {0x0018, 0x9079}},
    Key{{"FlipAngle", false}, {0x0018, 0x1314}},
    Key{{"RepetitionTime", false}, {0x0018, 0x0080}},
    Key{{"KVP", false}, {0x0018, 0x0060}},
    Key{{"ConvolutionKernel", false}, {0x0018, 0x1210}},
    Key{{"ComplexImageComponent", false}, {0x0008, 0x9208}},
    Key{{"FrameType", false}, {0x0008, 0x9007}},
    Key{{"ImageType", false}, {0x0008, 0x0008}},
    Key{{"StackID", false}, {0x0020, 0x9056}},
    Key{{"ReferencedSegmentNumber", false}, {0x0062, 0x000b}},
    Key{{"SeriesDescription", false}, {0x0008, 0x103e}},
    Key{{"TemporalPositionIndex", true}, {0x0020, 0x9128}},
    Key{{"TemporalPositionIdentifier", true}, {0x0020, 0x0100}},
    Key{{"TriggerTime", true}, {0x0018, 0x1060}},
    Key{{"NominalCardiacTriggerDelayTime", true}, {0x0020, 0x9153}},
    Key{{"NominalPercentageOfCardiacPhase", true}, {0x0020, 0x9241}},
    Key{{"FrameReferenceTime", true}, {0x0054, 0x1300}},
    Key{{"FrameReferenceDateTime", true}, {0x0018, 0x9151}},
    Key{{"FrameAcquisitionDateTime", true}, {0x0018, 0x9074}},
    Key{{"AcquisitionDateTime", true}, {0x0008, 0x002a}},
    Key{{"AcquisitionTime", true}, {0x0008, 0x0032}},
    Key{{"ContentTime", true}, {0x0008, 0x0033}},
    Key{{"AcquisitionNumber", true}, {0x0020, 0x0012}},
    Key{{"InstanceNumber", true}, {0x0020, 0x0013}},
};

} // namespace

std::span<const DicomKey> dicomKeys() {
    static const std::vector<DicomKey> keys = [] {
        std::vector<DicomKey> all;
        for (const Key& key : kKeys) {
            all.push_back(key.key);
        }
        return all;
    }();
    return keys;
}

void setProperties(DicomFile& file, const DicomHeader& header,
                   const std::vector<std::string>& moreKeys) {
    std::vector<std::pair<std::string, DcmTagKey>> wanted;
    for (const Key& key : kKeys) {
        wanted.emplace_back(key.key.keyword, key.tag);
    }
    for (const std::string& keyword : moreKeys) {
        readDictionary();
        DcmTag tag;
        if (DcmTag::findTagFromName(keyword.c_str(), tag).good()) {
            wanted.emplace_back(keyword, tag);
        }
    }
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        for (const auto& [keyword, tag] : wanted) {
            const std::string text = header.text(tag, static_cast<int>(i));
            if (!text.empty()) {
                file.frames[i].properties[keyword] = text;
            }
        }
    }
}

} // namespace slabcast
