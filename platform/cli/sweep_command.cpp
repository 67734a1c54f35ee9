#include "platform/cli/commands.h"
namespace slabcast {
Result<void> sweepCommand(const SweepOptions&) { return fail(ErrorCode::Internal, "not yet"); }
}
