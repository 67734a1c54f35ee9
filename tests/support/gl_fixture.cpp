#include "tests/support/gl_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "platform/egl/egl_context.h"

namespace slabcast {

namespace {

/// The context, its API and its debug output: one for the process, kept to its end (drivers dislike
/// being torn down in exit handlers).
struct SharedDevice {
    Result<EglContext> context = EglContext::create({.debug = true});
    Result<gl::Caps> caps = fail(ErrorCode::DeviceUnsupported, "no context");
    std::optional<gl::DebugOutput> debug;

    SharedDevice() {
        if (!context) {
            caps = tl::unexpected(context.error());
            return;
        }
        if (const auto loaded = gl::loadApi(context->getProc()); !loaded) {
            caps = tl::unexpected(loaded.error());
            return;
        }
        const char* mask = std::getenv("SLABCAST_MASK_EXTENSIONS");
        caps = gl::queryCaps(gl::parseExtensionMask(mask == nullptr ? "" : mask));
        debug.emplace();
    }
};

SharedDevice& device() {
    static SharedDevice* shared = new SharedDevice;
    return *shared;
}

} // namespace

void GlTest::SetUp() {
    ASSERT_TRUE(device().caps.has_value()) << device().caps.error().detail;
    device().context->makeCurrent();
    takeErrorCount();
}

void GlTest::TearDown() {
    if (!device().caps) {
        return; // SetUp has failed the test
    }
    const GLenum flag = gl::takeError();
    EXPECT_EQ(flag, static_cast<GLenum>(GL_NO_ERROR)) << gl::errorName(flag);
    EXPECT_EQ(device().debug->errorCount(), 0) << device().debug->firstError();
}

const gl::Caps& GlTest::caps() const {
    return *device().caps;
}

gl::GetProc GlTest::getProc() const {
    return device().context->getProc();
}

void GlTest::makeCurrent() const {
    device().context->makeCurrent();
}

int GlTest::takeErrorCount() {
    const int flags = gl::takeError() == GL_NO_ERROR ? 0 : 1;
    const int reported = device().debug->errorCount();
    device().debug->clear();
    return std::max(flags, reported);
}

} // namespace slabcast
