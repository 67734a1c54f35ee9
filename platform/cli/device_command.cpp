#include <limits>

#include <fmt/core.h>

#include "platform/cli/commands.h"

namespace slabcast {

Result<void> deviceCommand(const SessionOptions& options) {
    const Result<Session> session = openSession(options);
    if (!session) {
        return tl::unexpected(session.error());
    }
    const gl::Caps& caps = session->device.caps();
    fmt::print("{}\n  vendor     {}\n  driver     {}\n  context    {}\n", caps.renderer,
               caps.vendor, caps.driver, session->context.description());
    if (!caps.assumed.empty()) {
        fmt::print("  assumed    {}: taken from a table, not asked and tested\n", caps.assumed);
    }
    fmt::print("  software   {}\n", caps.isSoftware ? "yes: its times are not a headset's" : "no");
    fmt::print("  3D limit   {} texels along an edge\n  2D limit   {}\n  uniform block {} bytes\n",
               caps.maxTexture3DSize, caps.maxTextureSize, caps.maxUniformBlockSize);
    const struct {
        const char* what;
        bool has;
    } features[] = {
        {"GL_EXT_texture_norm16", caps.norm16},
        {"GL_OES_texture_float_linear", caps.floatLinear},
        {"GL_EXT_float_blend (work counters)", caps.floatBlend},
        {"GL_EXT_disjoint_timer_query", caps.timerQuery},
        {"GL_EXT_shader_framebuffer_fetch", caps.framebufferFetch},
        {"GL_OVR_multiview2", caps.multiview},
    };
    for (const auto& feature : features) {
        fmt::print("  {:<3} {}\n", feature.has ? "yes" : "no", feature.what);
    }
    fmt::print("texel formats, {}:\n",
               caps.assumed.empty() ? "by drawing and reading back" : "assumed");
    for (const TexelFormatTest& test : session->device.formats()) {
        fmt::print("  {:<12} {:<9} filter error {:.3g}, fetch error {:.3g}: {}\n",
                   name(test.format), test.usable ? "usable" : "unusable", test.maxFilterError,
                   test.maxFetchError, test.reason);
    }
    const TableFilterTest& table = session->device.tableFilter();
    fmt::print("  {:<12} {:<9} filter error {:.3g}: {}\n", "table",
               table.usable ? "usable" : "unusable", table.maxError, table.reason);
    VolumeStatistics ct;
    ct.min = -1024.0;
    ct.max = 3071.0;
    fmt::print("what volumes get:\n");
    for (const VoxelType type : {VoxelType::U8, VoxelType::I16, VoxelType::F32}) {
        for (const bool exact : {false, true}) {
            std::string reason;
            const TexelFormat format =
                chooseTexelFormat(type, ct, exact, std::numeric_limits<double>::infinity(),
                                  session->device.formats(), &reason);
            fmt::print("  {:<6} {:<8} {:<12} {}\n", name(type), exact ? "--exact" : "",
                       name(format), reason);
        }
    }
    return {};
}

} // namespace slabcast
