#include "core/transfer/table_axis.h"

#include <cmath>

namespace slabcast {

TableAxis tableAxis(const Texels& texels, const TransferTable& table) {
    SLABCAST_EXPECTS(texels.valueScale > 0.0, texels.valueScale);
    TableAxis axis{.lastTexel = static_cast<int>(table.texels.size()) - 1};
    const double texelsPerSampled =
        axis.lastTexel * texels.valueScale / (table.lastValue - table.firstValue);
    axis.hasSpan = std::isfinite(texelsPerSampled) && texelsPerSampled > 0.0;
    if (axis.hasSpan) {
        axis.texelsPerSampled = texelsPerSampled;
        axis.firstSampled = (table.firstValue - texels.valueBias) / texels.valueScale;
    }
    return axis;
}

} // namespace slabcast
