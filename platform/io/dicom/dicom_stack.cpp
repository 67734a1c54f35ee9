#include "platform/io/dicom/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/volume/voxel_dispatch.h"
#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"
#include "platform/io/dicom/dicom_choice.h"

namespace slabcast {

namespace {

constexpr double kStepTolerance = 0.1; // of the usual distance: scanners round positions
constexpr double kSameCosine = 1e-3;
constexpr double kSameSpacing = 1e-3; // of the spacing

std::string missingElement(const DicomFrame& frame) {
    return !frame.positionMm ? "ImagePositionPatient"
           : !frame.axes     ? "ImageOrientationPatient"
                             : "PixelSpacing";
}

bool hasPlace(const DicomFrame& frame) {
    return frame.positionMm && frame.axes;
}

/// In order of their numbers: what the user said by giving a spacing.
void assumePlaces(DicomImages& images, const glm::dvec3& spacing, std::vector<std::string>& notes) {
    std::stable_sort(images.begin(), images.end(), [](const DicomImage& a, const DicomImage& b) {
        const std::optional<double> x = parseReal(a.property("InstanceNumber"));
        const std::optional<double> y = parseReal(b.property("InstanceNumber"));
        if (x && y && *x != *y) {
            return *x < *y;
        }
        const std::string fileA = a.file->path.string();
        const std::string fileB = b.file->path.string();
        return fileA != fileB ? naturallyBefore(fileA, fileB) : a.index < b.index;
    });
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i].positionMm = {0, 0, static_cast<double>(i) * spacing.z};
        images[i].axes = {1, 0, 0, 0, 1, 0};
    }
    notes.emplace_back("ImagePositionPatient is missing; the images were laid in the order of "
                       "their numbers, at the spacing given, at an assumed place");
}

Error withoutPlace(const std::filesystem::path& where, const DicomImages& images,
                   const DicomImage& first) {
    const auto missing = std::count_if(images.begin(), images.end(), [](const DicomImage& image) {
        return !hasPlace(image.frame());
    });
    const std::string element = missingElement(first.frame());
    if (first.file->isOverTime) {
        return {ErrorCode::InvalidGeometry,
                fmt::format("{}: its frames follow each other in time and are no slices: they have "
                            "no place of their own ({}); name a series of slices",
                            where.string(), element)};
    }
    const bool isAll = static_cast<std::size_t>(missing) == images.size();
    return {ErrorCode::InvalidGeometry,
            fmt::format("{}: {} is missing{}, so that neither their place nor their order is "
                        "known; export the series with it{}",
                        where.string(), element,
                        isAll ? fmt::format(" in all {} images", images.size())
                              : fmt::format(" in {} of {} images, as in {}", missing, images.size(),
                                            first.name(where)),
                        isAll ? ", or give --spacing X,Y,Z to take them as slices in the order of "
                                "their numbers"
                              : ", or move these away")};
}

struct Group {
    DicomImage like;
    DicomImages images;
};

using IsSame = std::function<bool(const DicomImage& a, const DicomImage& b)>;

/// The largest first.
std::vector<Group> groupsOf(const DicomImages& images, const IsSame& isSame) {
    std::vector<Group> groups;
    for (const DicomImage& image : images) {
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& candidate) {
            return isSame(candidate.like, image);
        });
        if (group == groups.end()) {
            groups.push_back({image, {}});
            group = std::prev(groups.end());
        }
        group->images.push_back(image);
    }
    std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
        return a.images.size() > b.images.size();
    });
    return groups;
}

/// `what(odd, usual)` says how they differ.
Result<void>
checkSame(const std::filesystem::path& where, const DicomImages& images, const IsSame& isSame,
          const std::function<std::string(const DicomImage& odd, const DicomImage& usual)>& what) {
    const std::vector<Group> groups = groupsOf(images, isSame);
    if (groups.size() == 1) {
        return {};
    }
    const Group& usual = groups[0];
    DicomImages odd;
    for (std::size_t i = 1; i < groups.size(); ++i) {
        odd.insert(odd.end(), groups[i].images.begin(), groups[i].images.end());
    }
    const DicomImage& first = groups.back().images.front();
    const std::optional<std::string> select = selectionOf(usual.images, odd);
    const bool ownFile = first.file != usual.like.file;
    const std::string remedy = ownFile && select ? "move it away, or take " + *select
                               : ownFile         ? "move it away"
                               : select          ? "take " + *select
                                                 : "export them as files of their own";
    return fail(ErrorCode::InvalidGeometry,
                fmt::format("{}: the images do not form one volume: {}{} has {}; {}",
                            where.string(), first.name(where),
                            odd.size() > 1 ? fmt::format(", like {} more,", odd.size() - 1) : "",
                            what(first, usual.like), remedy));
}

glm::dvec3 normalOf(const DicomImage& image) {
    return glm::cross(image.axes[0], image.axes[1]);
}

/// Of an even count the lower one: where two steps stand against each other, the larger is odd.
double lowerMedian(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool isNear(double a, double b) {
    return std::abs(a - b) <= kStepTolerance * std::min(a, b);
}

struct Steps {
    std::vector<double> along;
    std::vector<glm::dvec3> aside; // in the plane, per mm along
};

Steps stepsOf(const DicomImages& images) {
    const glm::dvec3 normal = normalOf(images.front());
    Steps steps;
    for (std::size_t i = 1; i < images.size(); ++i) {
        const glm::dvec3 step = images[i].positionMm - images[i - 1].positionMm;
        const double along = glm::dot(step, normal);
        steps.along.push_back(along);
        steps.aside.push_back((step - along * normal) / along);
    }
    return steps;
}

/// A tilted gantry moves every slice aside by the same share.
Result<void> checkOnLine(const std::filesystem::path& where, const DicomImages& images,
                         const Steps& steps) {
    glm::dvec3 usual{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> all;
        for (const glm::dvec3& aside : steps.aside) {
            all.push_back(aside[axis]);
        }
        usual[axis] = lowerMedian(all);
    }
    if (steps.along.size() == 2) { // neither is usual: take the straighter one
        usual = glm::length(steps.aside[0]) <= glm::length(steps.aside[1]) ? steps.aside[0]
                                                                           : steps.aside[1];
    }
    const glm::dvec2 spacing = images.front().spacingMm;
    for (std::size_t i = 0; i < steps.along.size(); ++i) {
        const double off = glm::length(steps.aside[i] - usual) * steps.along[i];
        const double allowed =
            std::max(kStepTolerance * steps.along[i], 0.1 * std::min(spacing.x, spacing.y));
        if (!(off <= allowed)) {
            return fail(ErrorCode::InvalidGeometry,
                        fmt::format("{}: from {} on, slices lie {:.4g} mm aside of the line that "
                                    "the others before lie on: they are of another block; move one "
                                    "of the blocks away",
                                    where.string(), images[i + 1].name(where), off));
        }
    }
    return {};
}

/// "4 mm up to 003.dcm, 7 mm from there on": where there are a few runs of even steps. Else empty.
std::string changesOf(const std::filesystem::path& where, const DicomImages& images,
                      const std::vector<double>& along) {
    struct Run {
        double step;
        std::size_t last; // of its steps
        std::size_t count;
    };
    std::vector<Run> runs;
    for (std::size_t i = 0; i < along.size(); ++i) {
        if (!runs.empty() && isNear(runs.back().step, along[i])) {
            runs.back().last = i;
            ++runs.back().count;
        } else {
            runs.push_back({along[i], i, 1});
        }
    }
    constexpr std::size_t kFew = 3;
    if (runs.size() > kFew ||
        std::any_of(runs.begin(), runs.end(), [](const Run& run) { return run.count < 2; })) {
        return "";
    }
    std::string text;
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
        text +=
            fmt::format("{:.4g} mm up to {}, ", runs[i].step, images[runs[i].last + 1].name(where));
    }
    return text + fmt::format("{:.4g} mm from there on", runs.back().step);
}

std::string unevenness(const std::filesystem::path& where, const DicomImages& images,
                       const std::vector<double>& along) {
    const std::string changes = changesOf(where, images, along);
    if (!changes.empty()) {
        return "the distance between slices changes: " + changes;
    }
    const double usual = lowerMedian(along);
    const auto odd =
        std::find_if(along.begin(), along.end(), [&](double step) { return !isNear(step, usual); });
    const auto i = static_cast<std::size_t>(odd - along.begin());
    const double times = std::round(*odd / usual);
    const bool isMissing = times >= 2 && std::abs(*odd - times * usual) <= kStepTolerance * usual;
    return fmt::format("between {} and {} lie {:.4g} mm where {:.4g} mm are usual{}",
                       images[i].name(where), images[i + 1].name(where), *odd, usual,
                       !isMissing   ? ""
                       : times == 2 ? ": a slice is missing"
                                    : fmt::format(": {:.0f} slices are missing", times - 1));
}

template <class Voxel>
Voxel mixed(Voxel a, Voxel b, double share) {
    const double value =
        static_cast<double>(a) + share * (static_cast<double>(b) - static_cast<double>(a));
    return static_cast<Voxel>(std::is_integral_v<Voxel> ? std::round(value) : value);
}

} // namespace

Result<void> placeImages(const std::filesystem::path& where, DicomImages& images,
                         const LoadOptions& options, std::vector<std::string>& notes) {
    const auto placed = [](const DicomImage& image) { return hasPlace(image.frame()); };
    const auto lost = std::find_if_not(images.begin(), images.end(), placed);
    if (lost != images.end()) {
        if (!options.spacingMm || std::any_of(images.begin(), images.end(), placed)) {
            return tl::unexpected(withoutPlace(where, images, *lost));
        }
        assumePlaces(images, *options.spacingMm, notes);
    } else {
        for (DicomImage& image : images) {
            image.positionMm = *image.frame().positionMm;
            image.axes = *image.frame().axes;
        }
    }
    for (DicomImage& image : images) {
        if (!image.frame().spacingMm && !options.spacingMm) {
            const std::string& why = image.file->spacingFault;
            return fail(ErrorCode::InvalidGeometry,
                        fmt::format("{}: {}; correct the element, or give --spacing X,Y,Z",
                                    image.file->path.string(),
                                    why.empty() ? "PixelSpacing is missing" : why));
        }
        image.spacingMm =
            options.spacingMm ? glm::dvec2(*options.spacingMm) : *image.frame().spacingMm;
    }
    return {};
}

Result<void> checkSameSize(const std::filesystem::path& where, const DicomImages& images) {
    return checkSame(
        where, images,
        [](const DicomImage& a, const DicomImage& b) {
            return a.file->rows == b.file->rows && a.file->columns == b.file->columns;
        },
        [](const DicomImage& odd, const DicomImage& usual) {
            return fmt::format("{} x {} pixels where most have {} x {}", odd.file->columns,
                               odd.file->rows, usual.file->columns, usual.file->rows);
        });
}

Result<void> checkSamePlane(const std::filesystem::path& where, const DicomImages& images) {
    const Result<void> turned = checkSame(
        where, images,
        [](const DicomImage& a, const DicomImage& b) {
            return glm::length(a.axes[0] - b.axes[0]) + glm::length(a.axes[1] - b.axes[1]) <=
                   kSameCosine;
        },
        [](const DicomImage&, const DicomImage&) {
            return std::string("another orientation than most");
        });
    if (!turned) {
        return turned;
    }
    return checkSame(
        where, images,
        [](const DicomImage& a, const DicomImage& b) {
            return glm::length(a.spacingMm - b.spacingMm) <=
                   kSameSpacing * glm::length(a.spacingMm);
        },
        [](const DicomImage& odd, const DicomImage& usual) {
            return fmt::format("pixels of {:.5g} x {:.5g} mm where most have {:.5g} x {:.5g} mm",
                               odd.spacingMm.x, odd.spacingMm.y, usual.spacingMm.x,
                               usual.spacingMm.y);
        });
}

void setAlongNormal(DicomImages& images) {
    const glm::dvec3 normal = normalOf(images.front());
    for (DicomImage& image : images) {
        image.alongMm = glm::dot(normal, image.positionMm);
    }
}

Result<DicomStack> stackImages(const std::filesystem::path& where, const DicomImages& images,
                               const LoadOptions& options) {
    const Steps steps = stepsOf(images);
    if (const Result<void> onLine = checkOnLine(where, images, steps); !onLine) {
        return tl::unexpected(onLine.error());
    }
    DicomStack stack;
    const double usual = lowerMedian(steps.along);
    stack.isEven = std::all_of(steps.along.begin(), steps.along.end(), [&](double step) {
        return std::abs(step - usual) <= kStepTolerance * usual;
    });
    if (!stack.isEven && !options.resampleUneven) {
        return fail(ErrorCode::InvalidGeometry,
                    fmt::format("{}: {}; give --resample to bring them to even distances, or "
                                "export the series again",
                                where.string(), unevenness(where, images, steps.along)));
    }
    const DicomImage& first = images.front();
    const glm::dvec3 path = images.back().positionMm - first.positionMm;
    const double length = glm::length(path);
    const glm::dvec3 third = path / length;
    VolumeGeometry& geometry = stack.geometry;
    geometry.dims = {first.file->columns, first.file->rows, static_cast<int>(images.size())};
    geometry.spacingMm =
        glm::dvec3(first.spacingMm, length / static_cast<double>(images.size() - 1));
    geometry.originMm = first.positionMm;
    geometry.direction = glm::dmat3(first.axes[0], first.axes[1], third);
    const double perMm = length / (images.back().alongMm - first.alongMm);
    for (const DicomImage& image : images) {
        stack.distancesMm.push_back((image.alongMm - first.alongMm) * perMm);
    }
    return stack;
}

Result<Volume> resampledEvenly(const std::filesystem::path& where, Volume volume,
                               const DicomStack& stack, const LoadOptions& options) {
    const std::vector<double>& at = stack.distancesMm;
    double step = at.back();
    for (std::size_t i = 1; i < at.size(); ++i) {
        step = std::min(step, at[i] - at[i - 1]);
    }
    constexpr double kMostSlices = 1 << 16;
    const double count = std::floor(at.back() / step + kStepTolerance) + 1;
    const auto slices = static_cast<int>(std::min(count, kMostSlices));
    const VoxelBytes voxels = std::move(volume.voxels);
    volume.voxels = {};
    Volume even = std::move(volume);
    even.geometry.dims.z = slices;
    even.geometry.spacingMm.z = step;
    const Result<std::int64_t> bytes = checkedByteCount(even.geometry.dims, even.type);
    if (!bytes || count > kMostSlices) {
        return fail(ErrorCode::SizeOverflow,
                    fmt::format("{}: at the smallest distance, {:.4g} mm, there would be {:.0f} "
                                "slices; export the series again",
                                where.string(), step, count));
    }
    even.voxels = makeVoxels(options, static_cast<std::size_t>(*bytes));
    const std::size_t area = static_cast<std::size_t>(even.geometry.dims.x) *
                             static_cast<std::size_t>(even.geometry.dims.y);
    visitVoxels(even, [&](auto target) {
        using Voxel = typename decltype(target)::value_type;
        const auto* source = reinterpret_cast<const Voxel*>(voxels.data());
        parallelFor(slices, 1, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t z = begin; z < end; ++z) {
                const double mm = std::min(static_cast<double>(z) * step, at.back());
                const auto above = std::upper_bound(at.begin(), at.end(), mm);
                const auto high =
                    std::min(static_cast<std::size_t>(above - at.begin()), at.size() - 1);
                const std::size_t low = high - 1;
                const double share = (mm - at[low]) / (at[high] - at[low]);
                for (std::size_t i = 0; i < area; ++i) {
                    target[static_cast<std::size_t>(z) * area + i] =
                        mixed(source[low * area + i], source[high * area + i], share);
                }
            }
        });
    });
    even.notes.push_back(
        fmt::format("{} slices at uneven distances were brought to {} at {:.5g} mm "
                    "by linear interpolation",
                    at.size(), slices, step));
    return even;
}

} // namespace slabcast
