#pragma once

namespace slabcast {

/// The commit that was built; defined in a source that the build writes.
const char* commit();

} // namespace slabcast
