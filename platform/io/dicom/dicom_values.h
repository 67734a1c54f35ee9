#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"
#include "platform/io/dicom/dicom_image.h"

namespace slabcast {

/// Turns stored values into data values, slice by slice, in the volume's own buffer. The type is
/// the stored one where nothing is rescaled; else the smallest integer that holds the values where
/// slopes and intercepts are whole, and float where they are not. Photometric interpretation is a
/// matter of display and changes nothing. Tested by: io_dicom_values_test.cpp
class DicomVoxels {
public:
    /// `volume` has its geometry and gets its type and room for the voxels; all images are of its
    /// size. All must outlive it. Fails: SizeOverflow.
    static Result<DicomVoxels> inside(Volume& volume, const DicomImages& images,
                                      const LoadOptions& options);

    /// Cells as DicomPixels gives them. Where the values outgrow the type, the slices before are
    /// widened, once.
    void put(std::size_t slice, const DicomImage& image, const std::vector<std::byte>& cells);

    /// When all slices are there: what was padding becomes the lowest real value. With a note.
    void fillPadding();

private:
    struct Run {
        std::size_t begin;
        std::size_t end;
    };

    DicomVoxels(Volume& volume, VoxelType widest, const LoadOptions& options)
        : volume_(&volume), widest_(widest), options_(&options) {}
    template <class Cell>
    void putCells(std::size_t slice, const DicomImage& image, const Cell* cells);
    template <class Cell, class Voxel>
    bool fits(std::size_t slice, const DicomImage& image, const Cell* cells);
    void widen(std::size_t slices);
    void addPadding(std::size_t voxel);

    Volume* volume_;
    VoxelType widest_; // holds whatever can be stored
    const LoadOptions* options_;
    double lowest_ = std::numeric_limits<double>::infinity();
    std::vector<Run> padding_;
    std::string paddingText_;
};

} // namespace slabcast
