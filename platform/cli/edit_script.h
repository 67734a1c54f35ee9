#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"

namespace slabcast {

/// What happens before one frame of a replayed edit.
struct EditFrame {
    std::string step;                            // of the script
    std::optional<TransferFunction> newTransfer; // none: nothing is edited
};

struct EditScript {
    TransferFunction start;
    std::vector<EditFrame> frames;
};

/// A preset's name or a file as a TF.
using TransferByName = std::function<Result<TransferFunction>(const std::string& name)>;

/// Both at once: piecewise linear as they are, over the points of either, `weight` of `b`.
/// Opacities are those of `a`'s unit of length. Source: Faludi et al. 2021, section 4.5.
TransferFunction mixed(const TransferFunction& a, const TransferFunction& b, double weight);

/// As a script:
/// {"start": TF, "steps": [{"kind": KIND, "frames": N, ...}, ...]}
/// where a TF is a preset's name, a file, or an object as in a file of its own; each step begins
/// with the TF that the one before it left; and of the kinds
/// - pause edits nothing;
/// - interpolate goes to the TF "to" and back again, "periods" times (1; 0.5 stays there), by a
///   sine in time;
/// - opacity drags the opacity of point "point" to "to";
/// - jump puts the TF "to" in place at once, then edits nothing;
/// - random puts one of two bands of values in place every "every" frames (1), by "seed" (1).
/// Fails: InvalidArgument, as "script.json: steps[2].kind: ...", and as TFs do. Tested by:
/// edit_test.py
Result<EditScript> parseEditScript(std::string_view text, const std::string& sourceName,
                                   const TransferByName& byName, const VolumeStatistics& data);

/// From one TF to the other and back, resting at both: of so many frames.
EditScript interpolation(const TransferFunction& a, const TransferFunction& b, int frames);

/// Something of every kind, whatever the volume.
EditScript usualScript(const TransferFunction& start, const VolumeStatistics& data, int frames);

} // namespace slabcast
