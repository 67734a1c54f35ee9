# Headers that nearly every source of a library reads, parsed once per target: a quarter of the time of a source of the
# core went into reading them again (perf/README.md). Sources include what they use all the same; tests/portability.sh
# compiles each without these.
set(SLABCAST_STD_HEADERS <algorithm> <array> <atomic> <cmath> <cstdint> <functional> <limits> <map> <memory> <optional>
    <span> <string> <string_view> <utility> <vector>)
set(SLABCAST_CORE_HEADERS ${SLABCAST_STD_HEADERS} <glm/glm.hpp> <tl/expected.hpp>)
# What measures sees the whole core.
set(SLABCAST_PERF_HEADERS ${SLABCAST_CORE_HEADERS}
    ${PROJECT_SOURCE_DIR}/core/scene/scene.h ${PROJECT_SOURCE_DIR}/core/draw/renderer.h)
