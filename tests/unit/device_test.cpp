#include "core/scene/device.h"

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/scene/scene_api.h"
#include "core/volume/phantoms.h"

namespace slabcast {
namespace {

gl::Caps capsOf(const std::string& renderer) {
    gl::Caps caps;
    caps.renderer = renderer;
    caps.norm16 = true;
    caps.framebufferFetch = true;
    caps.maxTextureSize = 16384;
    return caps;
}

std::vector<TexelFormatTest> allUsable() {
    return {{.format = TexelFormat::R8, .usable = true, .maxFilterError = 0.004},
            {.format = TexelFormat::R16, .usable = true, .maxFilterError = 0.003},
            {.format = TexelFormat::R16F, .usable = true, .maxFilterError = 0.002},
            {.format = TexelFormat::Rg8Exact, .usable = true},
            {.format = TexelFormat::R32fExact, .usable = true}};
}

TEST(Device, NothingIsAskedOfGlBeforeItIsLoaded) {
    const Result<gl::Caps> caps = gl::queryCaps();
    ASSERT_FALSE(caps.has_value());
    EXPECT_EQ(caps.error().code, ErrorCode::InvalidArgument);
    EXPECT_NE(caps.error().detail.find("loadApi"), std::string::npos) << caps.error().detail;
    const Result<Device> device = Device::open(nullptr);
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().code, ErrorCode::InvalidArgument);
}

TEST(Device, ADriverWithoutGlesIsRefusedByTheNameOfWhatItLacks) {
    const Result<Device> device = Device::open([](const char*) -> void* { return nullptr; });
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().code, ErrorCode::DeviceUnsupported);
    EXPECT_NE(device.error().detail.find("glActiveTexture"), std::string::npos)
        << device.error().detail;
}

TEST(Device, QuirksAreThoseOfTheDriver) {
    EXPECT_TRUE(knownQuirks(capsOf("llvmpipe (LLVM 15.0.6, 256 bits)")).computeIsSlow);
    EXPECT_EQ(knownQuirks(capsOf("Adreno (TM) 740")), Quirks{});
}

TEST(Device, AQuirkIsAsGoodAsAnAbsentExtension) {
    const Device plain(capsOf("Adreno (TM) 740"), allUsable());
    EXPECT_EQ(plain.texturesFor(VoxelType::U16, {}).texels, TexelFormat::R16);
    EXPECT_TRUE(plain.caps().framebufferFetch);

    const Quirks faulty{.noNorm16 = true, .noFramebufferFetch = true};
    const Device device(capsOf("Adreno (TM) 740"), allUsable(), {.quirks = faulty});
    const TextureChoice choice = device.texturesFor(VoxelType::U16, {});
    EXPECT_EQ(choice.texels, TexelFormat::R16F);
    EXPECT_NE(choice.reason.find("known fault"), std::string::npos) << choice.reason;
    EXPECT_FALSE(device.caps().norm16);
    EXPECT_FALSE(device.caps().framebufferFetch);
    EXPECT_EQ(device.quirks(), faulty);
}

TEST(Device, AFormatComesWithTheErrorOfItsFilter) {
    const Device device(capsOf("x"), allUsable());
    EXPECT_EQ(device.texturesFor(VoxelType::U8, {}).filterErrorOfFullScale, 0.004);
    EXPECT_EQ(device.texturesFor(VoxelType::I16, {}).filterErrorOfFullScale, 0.003);
    const TextureChoice exact = device.texturesFor(VoxelType::F32, {}, true);
    EXPECT_EQ(exact.texels, TexelFormat::R32fExact);
    EXPECT_EQ(exact.filterErrorOfFullScale, 0.0);
}

TEST(Device, TablesFitTheDevicesTextures) {
    gl::Caps caps = capsOf("x");
    EXPECT_EQ(Device(caps, {}).texturesFor(VoxelType::U8, {}).maxTableSize, 4096);
    caps.maxTextureSize = 2048;
    EXPECT_EQ(Device(caps, {}).texturesFor(VoxelType::U8, {}).maxTableSize, 2048);
}

TEST(Device, LinesGoToTheHostsHook) {
    std::vector<std::string> lines;
    const Device device(capsOf("x"), {},
                        {.log = [&](const std::string& line) { lines.push_back(line); }});
    device.log("built on the CPU");
    EXPECT_EQ(lines, std::vector<std::string>{"built on the CPU"});
}

/// Runs all in the calling thread and says how often it was asked.
class HostsExecutor : public Executor {
public:
    ~HostsExecutor() override { setExecutor(nullptr); }
    int concurrency() const override { return 2; }
    void run(int count, FunctionRef<void(int)> task) override {
        ++runs;
        for (int i = 0; i < count; ++i) {
            task(i);
        }
    }
    int runs = 0;
};

TEST(Device, WorkRunsOnTheHostsThreads) {
    const Volume volume = makePhantom("phantom:shells:32").value();
    HostsExecutor host;
    const Device device(capsOf("x"), allUsable(), {.executor = &host});
    EXPECT_EQ(&executor(), &host);
    EXPECT_EQ(host.runs, 0);

    Scene scene = Scene::create(volume, device).value();
    const int toCreate = host.runs;
    EXPECT_GT(toCreate, 0) << "statistics and texels";
    const TransferFunction ramp{
        .points = {{0.0, glm::dvec3(1.0), 0.0}, {255.0, glm::dvec3(1.0), 0.9}}};
    ASSERT_TRUE(scene.setLook({.tf = ramp}).has_value());
    ASSERT_TRUE(scene.provide({.skip = {.structure = SkipStructure::Proximity}}).has_value());
    EXPECT_GT(host.runs, toCreate) << "the skip structure";

    const Device another(capsOf("x"), allUsable());
    EXPECT_EQ(&executor(), &host) << "who says nothing of threads leaves what is set";
}

TEST(DeviceDeathTest, ABreachedContractIsToldToTheHostFirst) {
    const auto breach = [] {
        const Device device(capsOf("x"), {},
                            {.contract = [](const char* function, const char*, double value) {
                                std::fprintf(stderr, "host hears %s %g", function, value);
                            }});
        contractBreach("f", "x > 0", 7.0);
    };
    EXPECT_DEATH(breach(), "host hears f 7");
}

} // namespace
} // namespace slabcast
