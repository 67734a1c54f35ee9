#include "platform/io/pictures/image_source.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/pictures/tiff_directory.h"

namespace slabcast {

namespace {

/// What printers and screens have; a pixel of 0.1 or 0.127 mm is none of them.
bool isOfPrint(double dotsPerInch) {
    constexpr std::array kUsual = {72.0,  75.0,  90.0,  96.0,  120.0, 144.0, 150.0,
                                   240.0, 300.0, 350.0, 360.0, 600.0, 720.0, 1200.0};
    return std::any_of(kUsual.begin(), kUsual.end(),
                       [&](double usual) { return std::abs(dotsPerInch - usual) < usual * 0.001; });
}

} // namespace

ImageLengths lengthsFrom(const double (&resolution)[2], int unit) {
    const double x = resolution[0];
    const double y = resolution[1];
    const bool isStated =
        std::isfinite(x) && std::isfinite(y) && x > 0.0 && y > 0.0 && (unit == 2 || unit == 3);
    if (!isStated) {
        return {.note = "states no voxel size: 1 x 1 x 1 mm is assumed; --spacing X,Y,Z gives it"};
    }
    const double share = unit == 3 ? 2.54 : 1.0;
    if (unit == 2 || isOfPrint(x * share) || isOfPrint(y * share)) {
        return {.note = fmt::format("states no voxel size but a resolution of {:.5g} x {:.5g} dots "
                                    "per inch, as for print: 1 x 1 x 1 mm is assumed; --spacing "
                                    "X,Y,Z gives it",
                                    x * share, y * share)};
    }
    constexpr double kLargestMm = 1.001; // larger ones are no pixels of a scanner
    if (10.0 / x > kLargestMm || 10.0 / y > kLargestMm) {
        return {.note = fmt::format("states no voxel size but a resolution of {:.5g} x {:.5g} dots "
                                    "per cm: 1 x 1 x 1 mm is assumed; --spacing X,Y,Z gives it",
                                    x, y)};
    }
    return {.mm = {10.0 / x, 10.0 / y, 1.0},
            .note = "states no distance of slices: 1 mm is assumed; --spacing X,Y,Z gives it"};
}

Result<ImageChoice> choiceIn(const std::filesystem::path& path, const LoadOptions& options) {
    ImageChoice choice;
    for (const Selection& selection : options.select) {
        const std::optional<std::int64_t> channel = parseInteger(selection.value);
        if (lowerCase(selection.key) != "channel" || !channel) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: images differ by their channel, not by {} = {}; say "
                                    "--select channel=N, from 1",
                                    path.string(), selection.key, selection.value));
        }
        choice.channel = *channel - 1;
    }
    if (options.time) {
        choice.time = *options.time;
    }
    return choice;
}

Result<std::int64_t> chosenChannel(const std::filesystem::path& path, const ImageChoice& choice,
                                   std::int64_t count, bool isColour) {
    if (choice.channel && (*choice.channel < 0 || *choice.channel >= count)) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: has no channel {}; --select channel=N takes 1 to {}",
                                path.string(), *choice.channel + 1, count));
    }
    if (!choice.channel && count > 1) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: has {} channels, and a volume has one; {}take one with "
                                "--select channel=N, from 1 to {}",
                                path.string(), count,
                                isColour ? "convert the images to grey without alpha, or " : "",
                                count));
    }
    return choice.channel.value_or(0);
}

Result<std::unique_ptr<ImageSource>> openImage(const std::filesystem::path& path,
                                               const LoadOptions& options) {
    return choiceIn(path, options).and_then([&](const ImageChoice& choice) {
        std::ifstream file(path, std::ios::binary);
        return isTiff(file) ? openTiff(path, std::move(file), choice)
                            : openOtherImage(path, std::move(file), choice);
    });
}

} // namespace slabcast
