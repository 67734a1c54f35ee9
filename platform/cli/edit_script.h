#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "perf/edit/writer.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

/// A preset's name or a file as a TF.
using TransferByName = std::function<Result<TransferFunction>(const std::string& name)>;

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
/// Fails: FileUnreadable, as "script.json: steps[2].kind: ...", and as TFs do. Tested by:
/// edit_test.py
Result<EditScript> parseEditScript(std::string_view text, const std::string& sourceName,
                                   const TransferByName& byName, const TransferSubject& subject);

} // namespace slabcast
