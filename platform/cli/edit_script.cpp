#include "platform/cli/edit_script.h"

#include <fmt/core.h>

#include "platform/json/json_checks.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr JsonRange kFrameCount = {1, 100000};

/// Reads a script's entries; complaints name them.
struct Reader {
    const std::string& sourceName;
    const TransferByName& byName;
    const TransferSubject& subject;

    Checked<TransferFunction> transfer(const json& object, const std::string& at,
                                       const char* key) const {
        const std::string path = inside(at, key);
        const auto found = object.find(key);
        if (found == object.end()) {
            return complain(path, "is missing: give a preset, a file or a transfer function");
        }
        const Result<TransferFunction> tf =
            found->is_string() ? byName(found->get<std::string>())
                               : parseTransferFunction(found->dump(), path, subject);
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

using AddStep = Checked<void> (*)(EditWriter&, const Reader&, const json&, const std::string& at,
                                  int frames);

Checked<void> addPause(EditWriter& writer, const Reader&, const json& step, const std::string& at,
                       int frames) {
    return checkKeys(step, at, {"kind", "frames"}).map([&] { writer.pause(frames); });
}

Checked<void> addInterpolation(EditWriter& writer, const Reader& reader, const json& step,
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

Checked<void> addOpacity(EditWriter& writer, const Reader&, const json& step, const std::string& at,
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

Checked<void> addJump(EditWriter& writer, const Reader& reader, const json& step,
                      const std::string& at, int frames) {
    return checkKeys(step, at, {"kind", "frames", "to"})
        .and_then([&] { return reader.transfer(step, at, "to"); })
        .map([&](const TransferFunction& to) { writer.jump(to, frames); });
}

Checked<void> addRandom(EditWriter& writer, const Reader& reader, const json& step,
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

Checked<void> addStep(EditWriter& writer, const Reader& reader, const json& step,
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

Checked<EditScript> read(const json& document, const Reader& reader) {
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
    EditWriter writer(std::move(*start), reader.subject.statistics);
    for (std::size_t k = 0; k < steps->size(); ++k) {
        const std::string at = fmt::format("steps[{}]", k);
        if (Checked<void> added = addStep(writer, reader, (*steps)[k], at); !added) {
            return tl::unexpected(added.error());
        }
    }
    return writer.take();
}

} // namespace

Result<EditScript> parseEditScript(std::string_view text, const std::string& sourceName,
                                   const TransferByName& byName, const TransferSubject& subject) {
    return parseJson(text, sourceName, ErrorCode::FileUnreadable)
        .and_then([&](const json& document) -> Result<EditScript> {
            Checked<EditScript> script = read(document, {sourceName, byName, subject});
            if (!script) {
                return fail(ErrorCode::FileUnreadable,
                            fmt::format("{}: {}", sourceName, said(script.error())));
            }
            return std::move(*script);
        });
}

} // namespace slabcast
