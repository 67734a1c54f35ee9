#include "perf/model/gpu_rates.h"

#include <algorithm>
#include <iterator>

namespace slabcast {

namespace {

// Arm: "Arm Mali GPU Datasheet" of 2021, its rows "Warp width", "FP32 operations/clock" (of which a
// multiply-add is two), "Texels/clock", "Fragments/clock" and "Pixels/clock", each per core: G71 4,
// 24, 1, 1, 1; G52 8, 32 or 48, 2, 2, 2; G57 16, 64, 4, 2, 2. Mesa's statistics of all Bifrost GPUs
// count by the G52's rates (24 tuples, 2 texels; bifrost_compile.c, bi_print_stats), of all Valhall
// GPUs by 64 multiply-adds: the tuples are theirs, the rates Arm's. A filtered 3D fetch takes twice
// a 2D one, as does a texel of more than 32 bits: Arm, "The Valhall shader core", "Texture unit",
// and "Analyzing texture performance" in Streamline's tutorial, of Bifrost too. Blending keeps its
// rate at four samples a pixel: the same page, "ZS and blend unit". Instruction caches of Mali are
// not published: a range.
//
// Adreno: claimed TFLOPS over twice the clock are the instructions a clock (630 0.73, 650 1.2, 660
// 1.7: UploadVR's table of Snapdragon GPUs). Texels: 24 a clock of the 640's two cores (Chips and
// Cheese 2024, "Inside the Snapdragon 855's iGPU"), so 12 a core; cores, and the instruction cache
// of 64 or 127 lines of 128 bytes: Mesa's freedreno_devices.py (num_ccu, instr_cache_size). Pixels:
// 9.4 Gpixel/s of the 640, so 8 a core and clock (github.com/azhirnov/cpu-gpu-arch, Adreno-600).
// Twice for 3D is taken from Mali: nothing is published. Waves are of 64, as Mesa's
// threadsize_base; their shape on the screen is not published.
//
// Clocks and memory of the G52's and G57's devices, and memory of the Adrenos' devices, are as
// their makers state them on product pages that were not at hand: they matter where memory, or a
// device of one of these two, is the question.
constexpr GpuRates kRates[] = {
    {.name = "g71",
     .compiler = "g71",
     .title = "Mali-G71 MP20, Galaxy S8",
     .renderer = "Mali-G71",
     .megahertz = 546.0, // TechSpot 2017, review of the Galaxy S8+
     .cores = 20,
     .issueSlots = 20 * 12.0,
     .issueSlotsHigh = 20 * 12.0,
     .texels = 20 * 1.0,
     .fragments = 20 * 1.0,
     .pixels = 20 * 1.0,
     .texelsOf3d = 2.0,
     .waveWidth = 2,
     .waveHeight = 2,
     .gigabytesPerSecond = 29.0, // nanoreview.net, Exynos 8895
     .codeBytesLow = 8 << 10,
     .codeBytesHigh = 64 << 10,
     .source = "Arm Mali GPU Datasheet 2021; TechSpot 2017; nanoreview.net"},
    {.name = "g52",
     .compiler = "g52",
     .title = "Mali-G52 MC2, Helio G85",
     .renderer = "Mali-G52",
     .megahertz = 1000.0, // MediaTek, Helio G85
     .cores = 2,
     .issueSlots = 2 * 16.0,     // two engines a core
     .issueSlotsHigh = 2 * 24.0, // three
     .texels = 2 * 2.0,
     .fragments = 2 * 2.0,
     .pixels = 2 * 2.0,
     .texelsOf3d = 2.0,
     .waveWidth = 4,
     .waveHeight = 2,
     .gigabytesPerSecond = 14.4, // LPDDR4X of 1800 MHz, two channels of 16 bits
     .codeBytesLow = 8 << 10,
     .codeBytesHigh = 64 << 10,
     .source = "Arm Mali GPU Datasheet 2021; MediaTek Helio G85"},
    {.name = "g57",
     .compiler = "g57",
     .title = "Mali-G57 MC2, Dimensity 700",
     .renderer = "Mali-G57",
     .megahertz = 950.0, // MediaTek, Dimensity 700
     .cores = 2,
     .issueSlots = 2 * 32.0,
     .issueSlotsHigh = 2 * 32.0,
     .texels = 2 * 4.0,
     .fragments = 2 * 2.0,
     .pixels = 2 * 2.0,
     .texelsOf3d = 2.0,
     .waveWidth = 4,
     .waveHeight = 4,
     .gigabytesPerSecond = 17.1, // LPDDR4X of 2133 MHz, two channels of 16 bits
     .codeBytesLow = 8 << 10,
     .codeBytesHigh = 64 << 10,
     .source = "Arm Mali GPU Datasheet 2021; MediaTek Dimensity 700"},
    {.name = "adreno630",
     .compiler = "adreno630",
     .title = "Adreno 630, Snapdragon 845",
     .renderer = "Adreno (TM) 630",
     .megahertz = 710.0,
     .cores = 2,
     .issueSlots = 512.0,
     .issueSlotsHigh = 512.0,
     .texels = 2 * 12.0,
     .fragments = 2 * 8.0,
     .pixels = 2 * 8.0,
     .texelsOf3d = 2.0,
     .waveWidth = 8,
     .waveHeight = 8,
     .gigabytesPerSecond = 29.9,
     .codeBytesLow = 64 * 128,
     .codeBytesHigh = 64 * 128,
     .source = "UploadVR 2022; Chips and Cheese 2024; Mesa freedreno_devices.py"},
    {.name = "adreno650",
     .compiler = "adreno660",
     .title = "Adreno 650, Quest 2",
     .renderer = "Adreno (TM) 650",
     .megahertz = 490.0, // GPU level 3; levels 4 and 5 add 7 and 18 % (Meta, CPU and GPU levels)
     .cores = 3,
     .issueSlots = 1024.0,
     .issueSlotsHigh = 3 * 384.0, // three cores of the 640's size
     .texels = 3 * 12.0,
     .fragments = 3 * 8.0,
     .pixels = 3 * 8.0,
     .texelsOf3d = 2.0,
     .waveWidth = 8,
     .waveHeight = 8,
     .gigabytesPerSecond = 34.1, // LPDDR4X of 2133 MHz, 64 bits
     .codeBytesLow = 127 * 128,
     .codeBytesHigh = 127 * 128,
     .source = "UploadVR 2022; Chips and Cheese 2024; Mesa freedreno_devices.py; Meta"},
    {.name = "adreno660",
     .compiler = "adreno660",
     .title = "Adreno 660, Snapdragon 888",
     .renderer = "Adreno (TM) 660",
     .megahertz = 840.0,
     .cores = 3,
     .issueSlots = 1024.0,
     .issueSlotsHigh = 3 * 384.0,
     .texels = 3 * 12.0,
     .fragments = 3 * 8.0,
     .pixels = 3 * 8.0,
     .texelsOf3d = 2.0,
     .waveWidth = 8,
     .waveHeight = 8,
     .gigabytesPerSecond = 51.2, // LPDDR5 of 3200 MHz, 64 bits
     .codeBytesLow = 127 * 128,
     .codeBytesHigh = 127 * 128,
     .source = "UploadVR 2022; Chips and Cheese 2024; Mesa freedreno_devices.py"},
    {.name = "adreno740",
     .compiler = "adreno740",
     .title = "Adreno 740, Quest 3",
     .renderer = "Adreno (TM) 740",
     .megahertz = 545.0, // 599 where it is cool enough (UploadVR, Quest 3's GPU clock)
     .cores = 6,
     .issueSlots = 1536.0,
     .issueSlotsHigh = 2560.0, // 3.7 TFLOPS at 719 MHz (primua.com, Adreno 740)
     .texels = 6 * 12.0,
     .fragments = 6 * 8.0,
     .pixels = 6 * 8.0,
     .texelsOf3d = 2.0,
     .waveWidth = 8,
     .waveHeight = 8,
     .gigabytesPerSecond = 51.2, // LPDDR5 of 3200 MHz, 64 bits
     .codeBytesLow = 127 * 128,
     .codeBytesHigh = 127 * 128,
     .source = "Mesa freedreno_devices.py (six cores); UploadVR; 12 texels a core as of the 640"},
};

} // namespace

std::span<const GpuRates> gpuRates() {
    return kRates;
}

const GpuRates* findGpuRates(std::string_view name) {
    const auto found = std::find_if(std::begin(kRates), std::end(kRates),
                                    [=](const GpuRates& one) { return one.name == name; });
    return found == std::end(kRates) ? nullptr : found;
}

} // namespace slabcast
