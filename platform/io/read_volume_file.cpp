#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include "platform/io/file_header.h"
#include "platform/io/itk_volume.h"
#include "platform/io/parse_text.h"
#include "platform/io/readers.h"

namespace slabcast {

namespace {

Modality modalityOf(const FileHeader& header) {
    static const std::map<std::string, Modality> kNames = {{"ct", Modality::Ct},
                                                           {"met_mod_ct", Modality::Ct},
                                                           {"mr", Modality::Mr},
                                                           {"mri", Modality::Mr},
                                                           {"met_mod_mr", Modality::Mr}};
    const auto field = header.fields.find("modality");
    const auto found =
        field == header.fields.end() ? kNames.end() : kNames.find(lowerCase(field->second));
    return found == kNames.end() ? Modality::Unknown : found->second;
}

template <class ImageIo>
Result<Volume> readChecked(const std::filesystem::path& path,
                           Result<FileHeader> (*readHeader)(const std::filesystem::path&)) {
    const Result<FileHeader> header = readHeader(path);
    if (!header) {
        return tl::unexpected(header.error());
    }
    if (const Result<void> sound = check(path, *header); !sound) {
        return tl::unexpected(sound.error());
    }
    Result<Volume> volume = readWithItk(path, *ImageIo::New());
    if (volume) {
        const auto unit = header->fields.find("unit");
        volume->unit = unit == header->fields.end() ? "" : unit->second;
        volume->modality = modalityOf(*header);
    }
    return volume;
}

} // namespace

Result<Volume> readNrrd(const std::filesystem::path& path, const LoadOptions&) {
    return readChecked<itk::NrrdImageIO>(path, readNrrdHeader);
}

Result<Volume> readNifti(const std::filesystem::path& path, const LoadOptions&) {
    return readChecked<itk::NiftiImageIO>(path, readNiftiHeader);
}

Result<Volume> readMetaImage(const std::filesystem::path& path, const LoadOptions&) {
    return readChecked<itk::MetaImageIO>(path, readMetaHeader);
}

} // namespace slabcast
