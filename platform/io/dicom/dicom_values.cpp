#include "platform/io/dicom/dicom_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/volume/voxel_dispatch.h"
#include "platform/io/base/readers.h"

namespace slabcast {

namespace {

struct Range {
    double low = 0.0;
    double high = 0.0;
};

/// What the bits of a stored value can hold.
Range storedRange(const DicomFile& file) {
    const double all = std::ldexp(1.0, file.bitsStored);
    return file.isSigned ? Range{-all / 2, all / 2 - 1} : Range{0.0, all - 1};
}

Range valueRange(const DicomImage& image) {
    const DicomFile& file = *image.file;
    if (file.table) {
        const auto [low, high] =
            std::minmax_element(file.table->values.begin(), file.table->values.end());
        return {static_cast<double>(*low), static_cast<double>(*high)};
    }
    const Range stored = storedRange(file);
    const double a = image.frame().slope * stored.low + image.frame().intercept;
    const double b = image.frame().slope * stored.high + image.frame().intercept;
    return {std::min(a, b), std::max(a, b)};
}

bool isPlain(const DicomImage& image) {
    return !image.file->table && image.frame().slope == 1.0 && image.frame().intercept == 0.0;
}

bool isWhole(const DicomImage& image) {
    const double slope = image.frame().slope;
    const double intercept = image.frame().intercept;
    return image.file->cell == DicomCell::Integer &&
           (image.file->table ||
            (slope == std::round(slope) && intercept == std::round(intercept)));
}

VoxelType storedType(const DicomFile& file) {
    if (file.cell != DicomCell::Integer) {
        return file.cell == DicomCell::Float32 ? VoxelType::F32 : VoxelType::F64;
    }
    if (file.bitsAllocated <= 8) {
        return file.isSigned ? VoxelType::I8 : VoxelType::U8;
    }
    if (file.bitsAllocated == 16) {
        return file.isSigned ? VoxelType::I16 : VoxelType::U16;
    }
    return file.isSigned ? VoxelType::I32 : VoxelType::U32;
}

bool holds(VoxelType type, Range range) {
    return visitVoxelType(type, [&]<class T>(std::type_identity<T>) {
        return static_cast<double>(std::numeric_limits<T>::lowest()) <= range.low &&
               range.high <= static_cast<double>(std::numeric_limits<T>::max());
    });
}

struct Types {
    VoxelType first;
    VoxelType widest;
};

/// Sixteen bits and an offset may take 32 by the header, and hardly ever do by the data.
Types typesFor(const DicomImages& images) {
    const VoxelType stored = storedType(*images.front().file);
    const auto isSame = [&](const DicomImage& image) {
        return isPlain(image) && storedType(*image.file) == stored;
    };
    if (std::all_of(images.begin(), images.end(), isSame)) {
        return {stored, stored};
    }
    if (!std::all_of(images.begin(), images.end(), isWhole)) {
        const bool isDouble =
            std::any_of(images.begin(), images.end(), [](const DicomImage& image) {
                return image.file->cell == DicomCell::Float64;
            });
        const VoxelType real = isDouble ? VoxelType::F64 : VoxelType::F32;
        return {real, real};
    }
    Range range = valueRange(images.front());
    int bits = 0;
    for (const DicomImage& image : images) {
        const Range own = valueRange(image);
        range = {std::min(range.low, own.low), std::max(range.high, own.high)};
        bits = std::max(bits, image.file->bitsAllocated);
    }
    VoxelType widest = VoxelType::F64;
    for (const VoxelType type : {VoxelType::I32, VoxelType::U32, VoxelType::I16, VoxelType::U16,
                                 VoxelType::I8, VoxelType::U8}) {
        widest = holds(type, range) ? type : widest;
    }
    const bool isWide = bytesPerVoxel(widest) > static_cast<std::size_t>(bits) / 8;
    if (!isWide || bits < 16) {
        return {widest, widest};
    }
    const bool hasNegative = range.low < 0;
    return {bits == 16 ? (hasNegative ? VoxelType::I16 : VoxelType::U16)
                       : (hasNegative ? VoxelType::I32 : VoxelType::U32),
            widest};
}

/// Takes the stored value out of its cell, where overlays may use the other bits.
template <class Cell>
struct Stored {
    int shift;
    int unused; // bits above the value, once shifted to the top
    bool isSigned;

    explicit Stored(const DicomFile& file)
        : shift(file.highBit + 1 - file.bitsStored), unused(64 - file.bitsStored),
          isSigned(file.isSigned) {}

    std::int64_t operator()(Cell cell) const {
        const std::uint64_t up = (std::uint64_t{cell} >> shift) << unused;
        return isSigned ? static_cast<std::int64_t>(up) >> unused
                        : static_cast<std::int64_t>(up >> unused);
    }
    /// As if all bits of the cell were the value's.
    std::int64_t wholeCell(Cell cell) const {
        return isSigned ? static_cast<std::int64_t>(static_cast<std::make_signed_t<Cell>>(cell))
                        : static_cast<std::int64_t>(cell);
    }
};

} // namespace

Result<DicomVoxels> DicomVoxels::inside(Volume& volume, const DicomImages& images,
                                        const LoadOptions& options) {
    const Types types = typesFor(images);
    volume.type = types.first;
    const Result<std::int64_t> bytes = checkedByteCount(volume.geometry.dims, volume.type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    if (const Result<void> wanted = admitted(options, volume); !wanted) {
        return tl::unexpected(wanted.error());
    }
    volume.voxels = makeVoxels(options, static_cast<std::size_t>(*bytes));
    return DicomVoxels(volume, types.widest, options);
}

void DicomVoxels::addPadding(std::size_t voxel) {
    if (!padding_.empty() && padding_.back().end == voxel) {
        ++padding_.back().end;
    } else {
        padding_.push_back({voxel, voxel + 1});
    }
}

template <class Cell, class Voxel>
bool DicomVoxels::fits(std::size_t slice, const DicomImage& image, const Cell* cells) {
    const DicomFile& file = *image.file;
    const double slope = image.frame().slope;
    const double intercept = image.frame().intercept;
    const auto count = static_cast<std::size_t>(file.frameCells());
    const std::size_t start = slice * count;
    Voxel* voxels = reinterpret_cast<Voxel*>(volume_->voxels.data()) + start;
    double lowest = lowest_;
    const auto keep = [&](std::size_t i, double value) {
        if constexpr (std::is_integral_v<Voxel>) {
            if (!(value >= static_cast<double>(std::numeric_limits<Voxel>::lowest()) &&
                  value <= static_cast<double>(std::numeric_limits<Voxel>::max()))) {
                return false;
            }
        }
        lowest = std::min(lowest, value);
        voxels[i] = static_cast<Voxel>(value);
        return true;
    };
    if constexpr (std::is_floating_point_v<Cell>) {
        for (std::size_t i = 0; i < count; ++i) {
            keep(i, slope * static_cast<double>(cells[i]) + intercept);
        }
    } else {
        const Stored<Cell> stored(file);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t value = stored(cells[i]);
            if (file.padding) {
                const std::int64_t whole = stored.wholeCell(cells[i]);
                const DicomPadding& padding = *file.padding;
                if ((padding.first <= value && value <= padding.last) ||
                    (padding.first <= whole && whole <= padding.last)) {
                    addPadding(start + i);
                    continue;
                }
            }
            double data = slope * static_cast<double>(value) + intercept;
            if (file.table) {
                const auto last = static_cast<std::int64_t>(file.table->values.size()) - 1;
                data = file.table->values[static_cast<std::size_t>(
                    std::clamp<std::int64_t>(value - file.table->first, 0, last))];
            }
            if (!keep(i, data)) {
                return false;
            }
        }
    }
    lowest_ = lowest;
    return true;
}

template <class Cell>
void DicomVoxels::putCells(std::size_t slice, const DicomImage& image, const Cell* cells) {
    const auto tryPut = [&]() {
        return visitVoxelType(volume_->type, [&]<class Voxel>(std::type_identity<Voxel>) {
            return fits<Cell, Voxel>(slice, image, cells);
        });
    };
    const std::size_t runs = padding_.size();
    const Run last = runs > 0 ? padding_.back() : Run{0, 0};
    if (!tryPut()) {
        padding_.resize(runs);
        if (runs > 0) {
            padding_.back() = last;
        }
        widen(slice);
        tryPut();
    }
}

void DicomVoxels::put(std::size_t slice, const DicomImage& image,
                      const std::vector<std::byte>& cells) {
    const DicomFile& file = *image.file;
    if (file.padding) {
        paddingText_ = file.padding->text;
    }
    const std::byte* data = cells.data();
    if (file.cell == DicomCell::Float32) {
        putCells(slice, image, reinterpret_cast<const float*>(data));
    } else if (file.cell == DicomCell::Float64) {
        putCells(slice, image, reinterpret_cast<const double*>(data));
    } else if (file.bitsAllocated <= 8) {
        putCells(slice, image, reinterpret_cast<const std::uint8_t*>(data));
    } else if (file.bitsAllocated == 16) {
        putCells(slice, image, reinterpret_cast<const std::uint16_t*>(data));
    } else {
        putCells(slice, image, reinterpret_cast<const std::uint32_t*>(data));
    }
}

void DicomVoxels::widen(std::size_t slices) {
    Volume wide;
    wide.type = widest_;
    wide.voxels = makeVoxels(*options_, static_cast<std::size_t>(volume_->geometry.voxelCount()) *
                                            bytesPerVoxel(widest_));
    const auto done = static_cast<std::size_t>(volume_->geometry.dims.x) *
                      static_cast<std::size_t>(volume_->geometry.dims.y) * slices;
    visitVoxels(*volume_, [&](auto narrow) {
        visitVoxels(wide, [&](auto target) {
            using Voxel = typename decltype(target)::value_type;
            std::transform(narrow.begin(), narrow.begin() + static_cast<std::ptrdiff_t>(done),
                           target.begin(), [](auto value) { return static_cast<Voxel>(value); });
        });
    });
    volume_->type = wide.type;
    volume_->voxels = std::move(wide.voxels);
}

void DicomVoxels::fillPadding() {
    if (padding_.empty() || !std::isfinite(lowest_)) {
        return;
    }
    std::size_t count = 0;
    visitVoxels(*volume_, [&](auto voxels) {
        using Voxel = typename decltype(voxels)::value_type;
        for (const Run& run : padding_) {
            std::fill(voxels.begin() + static_cast<std::ptrdiff_t>(run.begin),
                      voxels.begin() + static_cast<std::ptrdiff_t>(run.end),
                      static_cast<Voxel>(lowest_));
            count += run.end - run.begin;
        }
    });
    volume_->notes.push_back(
        fmt::format("{} voxels of padding ({}) were set to the lowest value, {}", count,
                    paddingText_, lowest_));
}

} // namespace slabcast
