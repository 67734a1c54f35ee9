#pragma once

#include <optional>
#include <string>
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

/// Both at once: piecewise linear as they are, over the points of either, `weight` of `b`.
/// Opacities are those of `a`'s unit of length. Of one TF and itself: that TF, exactly. Source:
/// Faludi et al. 2021, section 4.5.
TransferFunction mixed(const TransferFunction& a, const TransferFunction& b, double weight);

/// A script in the making: each step adds frames and begins with the TF that the last one left. A
/// TF that equals the one before it is no edit.
class EditWriter {
public:
    /// `data` must outlive the writer.
    EditWriter(TransferFunction start, const VolumeStatistics& data);

    void pause(int frames);
    /// There and back again, `periods` times, by a sine in time.
    void interpolate(const TransferFunction& to, double periods, int frames);
    void dragOpacity(std::size_t point, double to, int frames);
    void jump(TransferFunction to, int frames);             // at once, then nothing
    void random(std::uint32_t seed, int every, int frames); // bands of values

    const TransferFunction& now() const { return now_; }
    EditScript take() { return std::move(script_); }

private:
    void edit(const char* step, TransferFunction tf);
    void rest(const char* step, int frames);

    const VolumeStatistics& data_;
    TransferFunction now_;
    EditScript script_;
};

/// From one TF to the other and back, resting at both: of so many frames.
EditScript interpolation(const TransferFunction& a, const TransferFunction& b, int frames);

/// Something of every kind, whatever the volume.
EditScript usualScript(const TransferFunction& start, const VolumeStatistics& data, int frames);

} // namespace slabcast
