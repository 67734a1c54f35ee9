#include "platform/io/save_nrrd.h"

#include <bit>
#include <fstream>

#include <fmt/format.h>

#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

std::string vectorText(glm::dvec3 v) {
    return fmt::format("({},{},{})", v.x, v.y, v.z);
}

std::string headerText(const Volume& volume) {
    constexpr const char* kModalities[] = {"", "modality:=CT\n", "modality:=MR\n"};
    const VolumeGeometry& geometry = volume.geometry;
    const glm::dmat3 axes(geometry.direction[0] * geometry.spacingMm.x,
                          geometry.direction[1] * geometry.spacingMm.y,
                          geometry.direction[2] * geometry.spacingMm.z);
    return fmt::format("NRRD0005\n"
                       "type: {}\n"
                       "dimension: 3\n"
                       "space: left-posterior-superior\n"
                       "sizes: {} {} {}\n"
                       "space directions: {} {} {}\n"
                       "kinds: domain domain domain\n"
                       "endian: {}\n"
                       "encoding: raw\n"
                       "space origin: {}\n"
                       "{}{}\n",
                       name(volume.type), geometry.dims.x, geometry.dims.y, geometry.dims.z,
                       vectorText(axes[0]), vectorText(axes[1]), vectorText(axes[2]),
                       std::endian::native == std::endian::little ? "little" : "big",
                       vectorText(geometry.originMm),
                       kModalities[static_cast<std::size_t>(volume.modality)],
                       volume.unit.empty() ? "" : fmt::format("unit:={}\n", volume.unit));
}

} // namespace

Result<void> saveNrrd(const std::filesystem::path& path, const Volume& volume) {
    if (volume.rescaleSlope != 1.0 || volume.rescaleIntercept != 0.0) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: NRRD cannot hold a rescaling; apply it to the voxels first",
                                path.string()));
    }
    return writeFileAtomically(path, [&](const std::filesystem::path& temporary) -> Result<void> {
        std::ofstream file(temporary, std::ios::binary);
        file << headerText(volume);
        file.write(reinterpret_cast<const char*>(volume.voxels.data()),
                   static_cast<std::streamsize>(volume.voxels.size()));
        file.close();
        if (!file) {
            return fail(ErrorCode::FileUnwritable,
                        fmt::format("{}: cannot be written in full; check the folder's permissions "
                                    "and the space left",
                                    path.string()));
        }
        return {};
    });
}

} // namespace slabcast
