#include "platform/cli/edit_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/core.h>

#include "platform/io/json_checks.h"
#include "platform/io/transfer_json.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr JsonRange kFrameCount = {1, 100000};

TransferPoint mixed(const TransferPoint& a, const TransferPoint& b, double weight) {
    return {a.value, glm::mix(a.color, b.color, weight), std::lerp(a.opacity, b.opacity, weight)};
}

/// What the TF is at a value, of two points there the first or the second.
TransferPoint sideOf(const TransferFunction& tf, double value, bool second) {
    const auto [first, end] = std::equal_range(
        tf.points.begin(), tf.points.end(), TransferPoint{.value = value},
        [](const TransferPoint& a, const TransferPoint& b) { return a.value < b.value; });
    if (first != end) {
        return second ? *(end - 1) : *first;
    }
    const TransferSample sample = evaluate(tf, value);
    return {value, sample.color, sample.opacity};
}

bool isStep(const TransferFunction& tf, double value) {
    return std::count_if(tf.points.begin(), tf.points.end(),
                         [=](const TransferPoint& p) { return p.value == value; }) > 1;
}

/// The same material by another unit of length.
TransferFunction inUnit(TransferFunction tf, double opacityUnitMm) {
    if (tf.opacityUnitMm != opacityUnitMm) {
        for (TransferPoint& point : tf.points) {
            point.opacity = 1.0 - std::pow(1.0 - point.opacity, opacityUnitMm / tf.opacityUnitMm);
        }
        tf.opacityUnitMm = opacityUnitMm;
    }
    return tf;
}

/// Opaque in the middle of [low, high], shares of the data's range, and nothing outside.
TransferFunction band(const VolumeStatistics& data, double low, double high, glm::dvec3 color) {
    const auto at = [&](double share) { return std::lerp(data.min, data.max, share); };
    return {.name = fmt::format("band {:.2f} to {:.2f}", low, high),
            .points = {{at(low), color, 0.0},
                       {at((low + high) / 2.0), color, 0.5},
                       {at(high), color, 0.0}}};
}

/// A script in the making: steps add frames and leave a TF.
class Writer {
public:
    Writer(TransferFunction start, const VolumeStatistics& data)
        : data_(data), now_(start), script_{std::move(start), {}} {}

    void pause(int frames) { rest("pause", frames); }

    void interpolate(const TransferFunction& to, double periods, int frames) {
        const TransferFunction from = now_;
        for (int k = 1; k <= frames; ++k) {
            const double phase = 2.0 * std::numbers::pi * periods * k / frames;
            edit("interpolate", mixed(from, to, (1.0 - std::cos(phase)) / 2.0));
        }
    }

    void dragOpacity(std::size_t point, double to, int frames) {
        const double from = now_.points[point].opacity;
        for (int k = 1; k <= frames; ++k) {
            TransferFunction tf = now_;
            tf.points[point].opacity = std::lerp(from, to, static_cast<double>(k) / frames);
            edit("opacity", std::move(tf));
        }
    }

    void jump(TransferFunction to, int frames) {
        edit("jump", std::move(to));
        rest("jump", frames - 1);
    }

    void random(std::uint32_t seed, int every, int frames) {
        std::mt19937 engine(seed);
        const auto unit = [&] { return std::ldexp(static_cast<double>(engine()), -32); };
        for (int k = 0; k < frames; ++k) {
            if (k % every != 0) {
                rest("random", 1);
                continue;
            }
            const double low = 0.95 * unit();
            const double high = low + 0.01 + (1.0 - low) * unit() / 2.0;
            const double red = unit();
            const double green = unit();
            edit("random", band(data_, low, high, {red, green, unit()}));
        }
    }

    const TransferFunction& now() const { return now_; }
    EditScript take() { return std::move(script_); }

private:
    void edit(const char* step, TransferFunction tf) {
        now_ = std::move(tf);
        script_.frames.push_back({step, now_});
    }
    void rest(const char* step, int frames) {
        script_.frames.insert(script_.frames.end(), frames, {step, std::nullopt});
    }

    const VolumeStatistics& data_;
    TransferFunction now_;
    EditScript script_;
};

/// Reads a script's entries; complaints name them.
struct Reader {
    const std::string& sourceName;
    const TransferByName& byName;

    Checked<TransferFunction> transfer(const json& object, const std::string& at,
                                       const char* key) const {
        const std::string path = inside(at, key);
        const auto found = object.find(key);
        if (found == object.end()) {
            return complain(path, "is missing: give a preset, a file or a transfer function");
        }
        const Result<TransferFunction> tf = found->is_string()
                                                ? byName(found->get<std::string>())
                                                : parseTransferFunction(found->dump(), path);
        if (tf) {
            return *tf;
        }
        return found->is_string() ? complain(path, tf.error().detail)
                                  : complain("", tf.error().detail);
    }

    Checked<double> numberOr(const json& step, const std::string& at, const char* key,
                             JsonRange range, double missing) const {
        return step.contains(key) ? numberAt(step, at, key, range) : missing;
    }

    Checked<int> integerOr(const json& step, const std::string& at, const char* key,
                           JsonRange range, int missing) const {
        return step.contains(key) ? integerAt(step, at, key, range) : missing;
    }
};

using AddStep = Checked<void> (*)(Writer&, const Reader&, const json&, const std::string& at,
                                  int frames);

Checked<void> addPause(Writer& writer, const Reader&, const json& step, const std::string& at,
                       int frames) {
    return checkKeys(step, at, {"kind", "frames"}).map([&] { writer.pause(frames); });
}

Checked<void> addInterpolation(Writer& writer, const Reader& reader, const json& step,
                               const std::string& at, int frames) {
    double periods = 1.0;
    return checkKeys(step, at, {"kind", "frames", "to", "periods"})
        .and_then([&] {
            return reader.numberOr(step, at, "periods", {0.5, 1000.0}, 1.0);
        })
        .and_then([&](double given) {
            periods = given;
            return reader.transfer(step, at, "to");
        })
        .map([&](const TransferFunction& to) { writer.interpolate(to, periods, frames); });
}

Checked<void> addOpacity(Writer& writer, const Reader&, const json& step, const std::string& at,
                         int frames) {
    const auto last = static_cast<double>(writer.now().points.size()) - 1.0;
    int point = 0;
    return checkKeys(step, at, {"kind", "frames", "point", "to"})
        .and_then([&] {
            return integerAt(step, at, "point", {0, last});
        })
        .and_then([&](int given) {
            point = given;
            return numberAt(step, at, "to", kUnitInterval);
        })
        .map([&](double to) { writer.dragOpacity(static_cast<std::size_t>(point), to, frames); });
}

Checked<void> addJump(Writer& writer, const Reader& reader, const json& step, const std::string& at,
                      int frames) {
    return checkKeys(step, at, {"kind", "frames", "to"})
        .and_then([&] { return reader.transfer(step, at, "to"); })
        .map([&](const TransferFunction& to) { writer.jump(to, frames); });
}

Checked<void> addRandom(Writer& writer, const Reader& reader, const json& step,
                        const std::string& at, int frames) {
    int seed = 1;
    return checkKeys(step, at, {"kind", "frames", "seed", "every"})
        .and_then([&] {
            return reader.integerOr(step, at, "seed", {0, 2147483647}, 1);
        })
        .and_then([&](int given) {
            seed = given;
            return reader.integerOr(step, at, "every", kFrameCount, 1);
        })
        .map([&](int every) { writer.random(static_cast<std::uint32_t>(seed), every, frames); });
}

constexpr std::pair<const char*, AddStep> kKinds[] = {{"pause", addPause},
                                                      {"interpolate", addInterpolation},
                                                      {"opacity", addOpacity},
                                                      {"jump", addJump},
                                                      {"random", addRandom}};

Checked<void> addStep(Writer& writer, const Reader& reader, const json& step,
                      const std::string& at) {
    if (!step.is_object()) {
        return complain(at, fmt::format("is {}, expected an object", step.type_name()));
    }
    const Checked<std::string> kind = textAt(step, at, "kind");
    if (!kind) {
        return tl::unexpected(kind.error());
    }
    std::string known;
    for (const auto& [name, add] : kKinds) {
        if (*kind == name) {
            return integerAt(step, at, "frames", kFrameCount).and_then([&, add = add](int frames) {
                return add(writer, reader, step, at, frames);
            });
        }
        known += known.empty() ? name : fmt::format(", {}", name);
    }
    return complain(inside(at, "kind"), fmt::format("'{}' is none of {}", *kind, known));
}

Checked<EditScript> read(const json& document, const Reader& reader, const VolumeStatistics& data) {
    if (Checked<void> keys = checkKeys(document, "", {"start", "steps"}); !keys) {
        return tl::unexpected(keys.error());
    }
    Checked<TransferFunction> start = reader.transfer(document, "", "start");
    if (!start) {
        return tl::unexpected(start.error());
    }
    const auto steps = document.find("steps");
    if (steps == document.end() || !steps->is_array() || steps->empty()) {
        return complain("steps", "expected a list of at least one step");
    }
    Writer writer(std::move(*start), data);
    for (std::size_t k = 0; k < steps->size(); ++k) {
        const std::string at = fmt::format("steps[{}]", k);
        if (Checked<void> added = addStep(writer, reader, (*steps)[k], at); !added) {
            return tl::unexpected(added.error());
        }
    }
    return writer.take();
}

} // namespace

TransferFunction mixed(const TransferFunction& a, const TransferFunction& b, double weight) {
    const TransferFunction other = inUnit(b, a.opacityUnitMm);
    std::vector<double> values;
    for (const TransferFunction* tf : {&a, &other}) {
        for (const TransferPoint& point : tf->points) {
            values.push_back(point.value);
        }
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    TransferFunction tf{.name = "interpolated", .unit = a.unit, .opacityUnitMm = a.opacityUnitMm};
    for (const double value : values) {
        for (const bool second : {false, true}) {
            if (!second || isStep(a, value) || isStep(other, value)) {
                tf.points.push_back(
                    mixed(sideOf(a, value, second), sideOf(other, value, second), weight));
            }
        }
    }
    return tf;
}

Result<EditScript> parseEditScript(std::string_view text, const std::string& sourceName,
                                   const TransferByName& byName, const VolumeStatistics& data) {
    return parseJson(text, sourceName, ErrorCode::InvalidArgument)
        .and_then([&](const json& document) -> Result<EditScript> {
            Checked<EditScript> script = read(document, {sourceName, byName}, data);
            if (!script) {
                return fail(ErrorCode::InvalidArgument,
                            fmt::format("{}: {}", sourceName, said(script.error())));
            }
            return std::move(*script);
        });
}

EditScript interpolation(const TransferFunction& a, const TransferFunction& b, int frames) {
    static constexpr VolumeStatistics kAny;
    const int rest = frames / 8;
    const int half = (frames - 2 * rest) / 2;
    Writer writer(a, kAny);
    writer.interpolate(b, 0.5, half);
    writer.pause(rest);
    writer.interpolate(a, 0.5, frames - 2 * rest - half);
    writer.pause(rest);
    return writer.take();
}

EditScript usualScript(const TransferFunction& start, const VolumeStatistics& data, int frames) {
    const int part = std::max(1, frames / 10);
    const auto strongest = std::max_element(
        start.points.begin(), start.points.end(),
        [](const TransferPoint& a, const TransferPoint& b) { return a.opacity < b.opacity; });
    Writer writer(start, data);
    writer.interpolate(band(data, 0.1, 0.5, {0.4, 0.8, 1.0}), 1.0, 2 * part);
    writer.pause(part);
    writer.jump(start, part);
    writer.dragOpacity(static_cast<std::size_t>(strongest - start.points.begin()),
                       strongest->opacity / 10.0, part);
    writer.jump(band(data, 0.3, 0.4, {1.0, 0.6, 0.3}), part);
    writer.jump(band(data, 0.6, 0.7, {0.3, 1.0, 0.6}), part);
    writer.random(1, 1, part);
    writer.pause(std::max(1, frames - 8 * part));
    return writer.take();
}

} // namespace slabcast
