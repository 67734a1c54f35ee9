#include "perf/edit/writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace slabcast {

namespace {

TransferPoint mixed(const TransferPoint& a, const TransferPoint& b, double weight) {
    glm::dvec3 color;
    for (int channel = 0; channel < 3; ++channel) { // lerp() of a value and itself is that value
        color[channel] = std::lerp(a.color[channel], b.color[channel], weight);
    }
    return {a.value, color, std::lerp(a.opacity, b.opacity, weight)};
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

bool operator==(const TransferPoint& a, const TransferPoint& b) {
    return a.value == b.value && a.color == b.color && a.opacity == b.opacity;
}

/// Whether `a` is at `b`'s points what `b` is there.
bool agreesAtPointsOf(const TransferFunction& a, const TransferFunction& b) {
    return std::all_of(b.points.begin(), b.points.end(), [&](const TransferPoint& point) {
        return sideOf(a, point.value, false) == sideOf(b, point.value, false) &&
               sideOf(a, point.value, true) == sideOf(b, point.value, true);
    });
}

/// What is linear between points is alike everywhere if at the points of both.
bool looksAlike(const TransferFunction& a, const TransferFunction& b) {
    return a.opacityUnitMm == b.opacityUnitMm && agreesAtPointsOf(a, b) && agreesAtPointsOf(b, a);
}

/// Opaque in the middle of [low, high], shares of the data's range, and nothing outside.
TransferFunction band(const VolumeStatistics& data, double low, double high, glm::dvec3 color) {
    const ValueRange shown = data.shown();
    const auto at = [&](double share) { return std::lerp(shown.min, shown.max, share); };
    char name[64];
    std::snprintf(name, sizeof name, "band %.2f to %.2f", low, high);
    return {.name = name,
            .points = {{at(low), color, 0.0},
                       {at((low + high) / 2.0), color, 0.5},
                       {at(high), color, 0.0}}};
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

EditWriter::EditWriter(TransferFunction start, const VolumeStatistics& data)
    : data_(data), now_(start), script_{std::move(start), {}} {}

void EditWriter::pause(int frames) {
    rest("pause", frames);
}

void EditWriter::interpolate(const TransferFunction& to, double periods, int frames) {
    const TransferFunction from = now_;
    for (int k = 1; k <= frames; ++k) {
        const double phase = 2.0 * std::numbers::pi * periods * k / frames;
        edit("interpolate", mixed(from, to, (1.0 - std::cos(phase)) / 2.0));
    }
}

void EditWriter::dragOpacity(std::size_t point, double to, int frames) {
    const double from = now_.points[point].opacity;
    for (int k = 1; k <= frames; ++k) {
        TransferFunction tf = now_;
        tf.points[point].opacity = std::lerp(from, to, static_cast<double>(k) / frames);
        edit("opacity", std::move(tf));
    }
}

void EditWriter::jump(TransferFunction to, int frames) {
    edit("jump", std::move(to));
    rest("jump", frames - 1);
}

void EditWriter::random(std::uint32_t seed, int every, int frames) {
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

void EditWriter::edit(const char* step, TransferFunction tf) {
    if (looksAlike(tf, now_)) {
        rest(step, 1);
        return;
    }
    now_ = std::move(tf);
    script_.frames.push_back({step, now_});
}

void EditWriter::rest(const char* step, int frames) {
    script_.frames.insert(script_.frames.end(), frames, {step, std::nullopt});
}

EditScript interpolation(const TransferFunction& a, const TransferFunction& b, int frames) {
    static constexpr VolumeStatistics kAny;
    const int rest = frames / 8;
    const int half = (frames - 2 * rest) / 2;
    EditWriter writer(a, kAny);
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
    EditWriter writer(start, data);
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
