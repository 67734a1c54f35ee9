#include "platform/io/dicom/dicom_choice.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

constexpr std::size_t kMostListed = 6;
const char* const kNumberOfImage = "InstanceNumber";

using Place = DicomImages; // all images there
using Places = std::vector<Place>;

bool isSameValue(std::string_view a, std::string_view b) {
    const std::optional<double> x = parseReal(trimmed(a));
    const std::optional<double> y = parseReal(trimmed(b));
    return x && y ? *x == *y : trimmed(a) == trimmed(b);
}

bool matches(const DicomImage& image, const Selection& wanted) {
    const std::string own = image.property(wanted.key);
    if (own.empty()) {
        return false;
    }
    const std::vector<std::string_view> parts = split(own, '\\');
    return isSameValue(own, wanted.value) ||
           std::any_of(parts.begin(), parts.end(),
                       [&](std::string_view part) { return isSameValue(part, wanted.value); });
}

/// Numbers by size, then texts.
bool isBefore(const std::string& a, const std::string& b) {
    const std::optional<double> x = parseReal(a);
    const std::optional<double> y = parseReal(b);
    return x && y                           ? *x < *y
           : x.has_value() != y.has_value() ? x.has_value()
                                            : naturallyBefore(a, b);
}

std::vector<std::string> valuesOf(const DicomImages& images, const std::string& key) {
    std::vector<std::string> values;
    for (const DicomImage& image : images) {
        const std::string value = image.property(key);
        if (!value.empty() && std::find(values.begin(), values.end(), value) == values.end()) {
            values.push_back(value);
        }
    }
    std::sort(values.begin(), values.end(), isBefore);
    return values;
}

std::string listed(const std::vector<std::string>& values) {
    std::string list;
    for (std::size_t i = 0; i < std::min(values.size(), kMostListed); ++i) {
        list += i == 0 ? "" : ", ";
        list += values[i];
    }
    return values.size() > kMostListed ? list + ", ..." : list;
}

/// As it is to be typed; nothing where the value cannot be.
std::optional<std::string> option(const std::vector<Selection>& selections) {
    std::string words;
    bool isPlain = true;
    for (const Selection& selection : selections) {
        if (selection.value.find_first_of(",='\"\n") != std::string::npos) {
            return std::nullopt;
        }
        words += words.empty() ? "" : ",";
        words += fmt::format("{}={}", selection.key, selection.value);
        isPlain = isPlain && selection.value.find_first_of(" \\$*;&|<>()") == std::string::npos;
    }
    return isPlain ? fmt::format("--select {}", words) : fmt::format("--select '{}'", words);
}

double tolerance(const DicomImages& images) {
    constexpr double kShareOfPixel = 0.02; // positions are rounded
    const glm::dvec2 spacing = images.front().spacingMm;
    return kShareOfPixel * std::min(spacing.x, spacing.y);
}

Places placesOf(DicomImages images) {
    std::stable_sort(images.begin(), images.end(), [](const DicomImage& a, const DicomImage& b) {
        return a.alongMm < b.alongMm;
    });
    const double near = tolerance(images);
    Places places;
    for (DicomImage& image : images) {
        if (places.empty() || image.alongMm - places.back().front().alongMm > near) {
            places.emplace_back();
        }
        places.back().push_back(image);
    }
    return places;
}

bool differs(const Places& places, const std::string& key) {
    return std::any_of(places.begin(), places.end(), [&](const Place& place) {
        return std::any_of(place.begin(), place.end(), [&](const DicomImage& image) {
            return image.property(key) != place.front().property(key);
        });
    });
}

/// How many images of each place these leave; 0 where places have different counts, or one has
/// none.
std::size_t leftAtEach(const Places& places, const std::vector<Selection>& selections) {
    std::size_t left = 0;
    for (const Place& place : places) {
        const auto count = static_cast<std::size_t>(
            std::count_if(place.begin(), place.end(), [&](const DicomImage& image) {
                return std::all_of(selections.begin(), selections.end(),
                                   [&](const Selection& wanted) { return matches(image, wanted); });
            }));
        if (count == 0 || (left != 0 && left != count)) {
            return 0;
        }
        left = count;
    }
    return left;
}

/// Keys by which images at a place differ; their mere number only where nothing else does.
std::vector<DicomKey> differingKeys(const Places& places) {
    std::vector<DicomKey> keys;
    for (const DicomKey& key : dicomKeys()) {
        const bool isNumber = std::string_view(key.keyword) == kNumberOfImage;
        if ((!isNumber || keys.empty()) && differs(places, key.keyword)) {
            keys.push_back(key);
        }
    }
    return keys;
}

const Place& fullest(const Places& places) {
    return *std::max_element(places.begin(), places.end(),
                             [](const Place& a, const Place& b) { return a.size() < b.size(); });
}

/// One property, or two, that leave `count` images at each place. Times are left to --time.
std::optional<std::string> leaving(std::size_t count, const Places& places,
                                   const std::vector<DicomKey>& keys) {
    std::vector<Selection> candidates;
    for (const DicomKey& key : keys) {
        for (const std::string& value : valuesOf(fullest(places), key.keyword)) {
            if (!key.isTime && candidates.size() < 64) {
                candidates.push_back({key.keyword, value});
            }
        }
    }
    for (const Selection& one : candidates) {
        if (leftAtEach(places, {one}) == count) {
            if (const auto words = option({one})) {
                return words;
            }
        }
    }
    for (const Selection& one : candidates) {
        for (const Selection& two : candidates) {
            if (one.key != two.key && leftAtEach(places, {one, two}) == count) {
                if (const auto words = option({one, two})) {
                    return words;
                }
            }
        }
    }
    return std::nullopt;
}

/// By the first time that all images at every place differ in; nothing where there is none.
std::optional<std::string> timeKey(const Places& places) {
    for (const DicomKey& key : dicomKeys()) {
        const bool tells = std::all_of(places.begin(), places.end(), [&](const Place& place) {
            std::set<std::string> values;
            for (const DicomImage& image : place) {
                const std::string value = image.property(key.keyword);
                if (value.empty() || !values.insert(value).second) {
                    return false;
                }
            }
            return true;
        });
        if (key.isTime && tells && differs(places, key.keyword)) {
            return key.keyword;
        }
    }
    return std::nullopt;
}

/// In order of `key`, else of the files and of the frames in them.
void sortInTime(Place& place, const std::optional<std::string>& key) {
    std::stable_sort(place.begin(), place.end(), [&](const DicomImage& a, const DicomImage& b) {
        if (key) {
            return isBefore(a.property(*key), b.property(*key));
        }
        const std::string fileA = a.file->path.string();
        const std::string fileB = b.file->path.string();
        return fileA != fileB ? naturallyBefore(fileA, fileB) : a.index < b.index;
    });
}

std::size_t countAtEach(const Places& places) {
    return leftAtEach(places, {});
}

/// Whether each file holds one image of every place.
bool holdsAVolumeEach(const Places& places) {
    if (places.size() < 2 || countAtEach(places) < 2) {
        return false;
    }
    const auto filesOf = [](const Place& place) {
        std::set<const DicomFile*> files;
        for (const DicomImage& image : place) {
            files.insert(image.file);
        }
        return files;
    };
    const std::set<const DicomFile*> first = filesOf(places.front());
    return std::all_of(places.begin(), places.end(), [&](const Place& place) {
        return filesOf(place) == first && first.size() == place.size();
    });
}

std::string howMany(const std::filesystem::path& where, const Places& places) {
    const std::size_t count = countAtEach(places);
    const Place& most = fullest(places);
    if (holdsAVolumeEach(places)) {
        return fmt::format("{} files hold a whole volume each ({} and {}{})", count,
                           most[0].file->path.filename().string(),
                           most[1].file->path.filename().string(), count > 2 ? ", ..." : "");
    }
    if (count > 1) {
        return fmt::format("{} images lie at each of {} places", count, places.size());
    }
    const auto shared = std::count_if(places.begin(), places.end(),
                                      [](const Place& place) { return place.size() > 1; });
    return fmt::format("{} images lie at one place ({} and {}), and several at {} of {} places",
                       most.size(), most[0].name(where), most[1].name(where), shared,
                       places.size());
}

std::string whatDiffers(const Places& places, const std::vector<DicomKey>& keys) {
    DicomImages all;
    for (const Place& place : places) {
        if (place.size() > 1) {
            all.insert(all.end(), place.begin(), place.end());
        }
    }
    std::string list;
    for (std::size_t i = 0; i < std::min(keys.size(), kMostListed); ++i) {
        list += fmt::format("{}{} is {}", i == 0 ? "" : "; ", keys[i].keyword,
                            listed(valuesOf(all, keys[i].keyword)));
    }
    return list.empty() ? "no property tells them apart" : list;
}

std::string remedy(const Places& places, const std::vector<DicomKey>& keys) {
    if (const auto select = leaving(1, places, keys)) {
        return fmt::format("choose with {}", *select);
    }
    const std::size_t count = countAtEach(places);
    const std::optional<std::string> time = timeKey(places);
    const bool isOverTime = time && *time != kNumberOfImage;
    for (std::size_t each = 2; !isOverTime && each < count; ++each) {
        if (const auto select = leaving(each, places, keys)) {
            return fmt::format("choose with {} and --time N, 0 to {}", *select, each - 1);
        }
    }
    if (count > 1) {
        return fmt::format("choose with --time N, 0 to {} in the order of {}", count - 1,
                           time ? *time : "the files and their frames");
    }
    if (time && isOverTime) {
        return "choose a time with --time 0, 1, ..., or move what is there twice away";
    }
    return "one is there twice or belongs to another volume: move it away";
}

} // namespace

Result<DicomImages> selectImages(const std::filesystem::path& where, const DicomImages& images,
                                 const LoadOptions& options) {
    DicomImages left = images;
    for (const Selection& wanted : options.select) {
        const std::vector<std::string> values = valuesOf(left, wanted.key);
        std::erase_if(left, [&](const DicomImage& image) { return !matches(image, wanted); });
        if (left.empty()) {
            const std::string there =
                values.empty() ? "none has this property; name another with --select"
                               : fmt::format("--select may name one of: {}", listed(values));
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: no image with {}={}; {}", where.string(), wanted.key,
                                    wanted.value, there));
        }
    }
    return left;
}

Result<DicomImages> onePerPlace(const std::filesystem::path& where, DicomImages images,
                                const LoadOptions& options) {
    Places places = placesOf(std::move(images));
    const std::size_t most = fullest(places).size();
    if (places.size() == 1 && most > 1) {
        return fail(ErrorCode::InvalidGeometry,
                    fmt::format("{}: all {} images lie at one place, as over time or of one slice, "
                                "and a volume needs several places; name a series of slices",
                                where.string(), most));
    }
    if (most > 1 && !options.time) {
        const std::vector<DicomKey> keys = differingKeys(places);
        return fail(ErrorCode::AmbiguousSeries,
                    fmt::format("{}: {}: {}; {}", where.string(), howMany(where, places),
                                whatDiffers(places, keys), remedy(places, keys)));
    }
    const std::optional<std::string> key = timeKey(places);
    const auto time = static_cast<std::size_t>(options.time.value_or(0));
    const std::size_t count = countAtEach(places);
    DicomImages chosen;
    if (count == 0 && key) { // not all times everywhere
        DicomImages all;
        for (const Place& place : places) {
            all.insert(all.end(), place.begin(), place.end());
        }
        const std::vector<std::string> times = valuesOf(all, *key);
        std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                     [&](const DicomImage& image) {
                         return time < times.size() && image.property(*key) == times[time];
                     });
    } else {
        for (Place& place : places) {
            sortInTime(place, key);
            if (time < place.size()) {
                chosen.push_back(place[time]);
            }
        }
    }
    if (chosen.empty()) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: there is no time {}; {}", where.string(), time,
                                most == 1 ? "one image lies at each place: leave --time out"
                                          : fmt::format("--time may be 0 to {}", most - 1)));
    }
    return chosen;
}

std::optional<std::string> selectionOf(const DicomImages& wanted, const DicomImages& others) {
    for (const DicomKey& key : dicomKeys()) {
        const Selection selection{key.keyword, wanted.front().property(key.keyword)};
        const auto fits = [&](const DicomImage& image) { return matches(image, selection); };
        if (!key.isTime && !selection.value.empty() &&
            std::all_of(wanted.begin(), wanted.end(), fits) &&
            std::none_of(others.begin(), others.end(), fits)) {
            return option({selection});
        }
    }
    return std::nullopt;
}

} // namespace slabcast
