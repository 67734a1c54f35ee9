#include <algorithm>

#include <gtest/gtest.h>

#include "core/scene/known_devices.h"

namespace slabcast {
namespace {

/// A context that can do all that anything here asks of it.
gl::Caps ableContext() {
    gl::Caps caps = *gl::capsFrom(
        {"Mesa",
         "llvmpipe",
         "OpenGL ES 3.2 Mesa",
         {"GL_EXT_texture_norm16", "GL_OES_texture_float_linear", "GL_EXT_float_blend",
          "GL_OVR_multiview2", "GL_EXT_shader_framebuffer_fetch"}},
        {});
    caps.maxTexture3DSize = 1234;
    return caps;
}

TEST(KnownDevices, AreFoundByTheirNamesAndListed) {
    for (const KnownDevice& known : knownDevices()) {
        EXPECT_EQ(findKnownDevice(known.name), &known);
        EXPECT_NE(knownDeviceNames().find(known.name), std::string::npos);
    }
    for (const char* name : {"", "g7", "G71", "g711", "llvmpipe"}) {
        EXPECT_EQ(findKnownDevice(name), nullptr) << name;
    }
}

TEST(KnownDevices, WhatIsAssumedIsTheDevicesAndSaysSo) {
    const gl::Caps running = ableContext();
    ASSERT_TRUE(running.isSoftware && running.norm16);
    for (const KnownDevice& known : knownDevices()) {
        const gl::Caps caps = assumedCaps(known, running);
        const bool isAdreno = std::string_view(known.name).starts_with("adreno");
        EXPECT_EQ(caps.assumed, known.name);
        EXPECT_EQ(caps.renderer, known.renderer);
        EXPECT_NE(caps.driver.find("assumed; what runs is llvmpipe"), std::string::npos);
        EXPECT_EQ(caps.framebufferFetch, isAdreno) << known.name;
        EXPECT_EQ(caps.floatLinear, isAdreno) << known.name;
        EXPECT_FALSE(caps.norm16 || caps.isSoftware) << known.name;
    }
}

// Whatever the device: GL refuses calls beyond what the context can.
TEST(KnownDevices, TheContextsLimitsAndLacksStay) {
    gl::Caps running = ableContext();
    EXPECT_EQ(assumedCaps(*findKnownDevice("adreno740"), running).maxTexture3DSize, 1234);
    EXPECT_TRUE(assumedCaps(*findKnownDevice("g71"), running).floatBlend); // counts work
    running = *gl::capsFrom({"Mesa", "Mali-G71 (Panfrost)", "OpenGL ES 3.2 Mesa", {}}, {});
    for (const KnownDevice& known : knownDevices()) {
        const gl::Caps caps = assumedCaps(known, running);
        EXPECT_FALSE(caps.framebufferFetch || caps.floatLinear || caps.multiview) << known.name;
    }
}

TEST(KnownDevices, FormatsAreAsWrongAsTheFilterMayBe) {
    for (const KnownDevice& known : knownDevices()) {
        const std::vector<TexelFormatTest> tests = assumedFormats(known);
        ASSERT_EQ(tests.size(), 5U);
        for (std::size_t k = 0; k < tests.size(); ++k) {
            const TexelFormatTest& test = tests[k];
            EXPECT_EQ(test.format, static_cast<TexelFormat>(k));
            EXPECT_EQ(test.usable, test.format != TexelFormat::R16);
            EXPECT_NE(test.reason.find("assumed"), std::string::npos);
            EXPECT_TRUE(assumedTableFilter(known).usable);
            EXPECT_GE(assumedTableFilter(known).maxError, known.filterErrorPerAxis);
            const bool filtered = test.usable && !isExact(test.format);
            EXPECT_EQ(test.maxFilterError >= 3 * known.filterErrorPerAxis, filtered);
        }
    }
}

// 12-bit CT gets a filtered format, as on the devices; nothing of an assumption counts on R16.
TEST(KnownDevices, VolumesGetTheFormatsThatPhonesFilter) {
    VolumeStatistics ct;
    ct.min = -1024.0;
    ct.max = 3071.0;
    for (const KnownDevice& known : knownDevices()) {
        const Device device(assumedCaps(known, ableContext()), assumedFormats(known));
        EXPECT_EQ(device.texturesFor(VoxelType::U8, ct).texels, TexelFormat::R8);
        EXPECT_EQ(device.texturesFor(VoxelType::I16, ct).texels, TexelFormat::R16F);
        EXPECT_GT(device.texturesFor(VoxelType::U8, ct).filterErrorOfFullScale, 3.0 / 256.0);
    }
}

} // namespace
} // namespace slabcast
