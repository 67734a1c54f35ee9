#pragma once

#include <cmath>
#include <vector>

#include "core/reference/discrete.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace slabcast::stability {

/// What is looked at while the view turns.
struct TurningScene {
    const char* name;
    const char* phantom;
    TransferFunction tf;
    bool allMethods; // else ray casting alone
};
std::vector<TurningScene> turningScenes();

/// By how much views turn.
std::vector<double> turnedDegrees(bool reduced);

/// The volume is seen from 2.5 radii away, 20 degrees beside the view axis and as wide: where a
/// headset's planes move most along a ray when the head turns. `degrees`: from where it was.
View headTurned(const Scene& scene, double degrees);
View volumeTurned(const Scene& scene, double degrees);

/// How the world's directions turn in the view, from a view that looks at the volume.
glm::dmat3 headTurn(double degrees);
/// Half of what that view sees, as a tangent.
double halfWindow();

struct Motion {
    const char* name;
    View (*view)(const Scene& scene, double degrees);
};
inline constexpr Motion kMotions[] = {{"head turn", headTurned}, {"orbit", volumeTurned}};

/// The scene by its continuous TF, over the given lattice.
DiscreteInput samplesOf(const Scene& scene, const View& view, glm::ivec2 size,
                        const Lattice& lattice);

/// Of any component, as an absolute value.
double largest(glm::dvec4 v);

class SquareSum {
public:
    void add(double value) { sum_ += value * value, ++count_; }
    double rms() const { return std::sqrt(sum_ / std::max(1, count_)); }

private:
    double sum_ = 0.0;
    int count_ = 0;
};

/// What plots of turning views share.
inline constexpr const char* kTurnedLabel = "turned by, degrees";

} // namespace slabcast::stability
