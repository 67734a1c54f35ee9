#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "platform/io/load_volume.h"

namespace slabcast::test {

/// A folder of its own for every test, gone afterwards.
class IoTest : public ::testing::Test {
protected:
    IoTest() {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("slabcast_" + std::string(info->test_suite_name()) + "_" + info->name() + "_" +
                   std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~IoTest() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    std::filesystem::path at(std::string_view name) const { return folder_ / name; }

    std::filesystem::path write(std::string_view name, std::string_view content) const {
        std::ofstream(at(name), std::ios::binary) << content;
        return at(name);
    }

    std::filesystem::path writeGz(std::string_view name, std::string_view content) const {
        gzFile file = gzopen(at(name).c_str(), "wb");
        gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
        gzclose(file);
        return at(name);
    }

    /// Keeps the first `bytes` only.
    static void truncate(const std::filesystem::path& path, std::uintmax_t bytes) {
        std::filesystem::resize_file(path, bytes);
    }

    std::filesystem::path folder_;
};

/// The voxel that all test files hold at (x, y, z): every one different, and within int8.
inline int codeAt(int x, int y, int z) {
    return x + 5 * y + 20 * z;
}

inline constexpr glm::ivec3 kDims{5, 4, 3};

template <class T>
std::string codes(glm::ivec3 dims = kDims, bool bigEndian = false) {
    std::string bytes;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                auto raw =
                    std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(codeAt(x, y, z)));
                bytes += bigEndian ? std::string(raw.rbegin(), raw.rend())
                                   : std::string(raw.begin(), raw.end());
            }
        }
    }
    return bytes;
}

inline void expectCodes(const Volume& volume, glm::ivec3 dims = kDims) {
    ASSERT_EQ(volume.geometry.dims, dims);
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                ASSERT_EQ(volume.valueAt({x, y, z}), codeAt(x, y, z)) << x << " " << y << " " << z;
            }
        }
    }
}

inline void expectNear(glm::dvec3 a, glm::dvec3 b, double tolerance = 1e-6) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
    }
}

inline void expectGeometry(const Volume& volume, glm::dvec3 spacing, glm::dvec3 origin,
                           glm::dmat3 direction = glm::dmat3(1.0)) {
    expectNear(volume.geometry.spacingMm, spacing);
    expectNear(volume.geometry.originMm, origin);
    for (int axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE("direction of axis " + std::to_string(axis));
        expectNear(volume.geometry.direction[axis], direction[axis]);
    }
}

/// The code, and a line that names the file and what to do.
inline void expectFailure(const Result<Volume>& result, ErrorCode code, std::string_view path,
                          std::string_view remedy) {
    ASSERT_FALSE(result.has_value());
    const std::string& detail = result.error().detail;
    EXPECT_EQ(result.error().code, code) << detail;
    EXPECT_NE(detail.find(path), std::string::npos) << detail;
    EXPECT_NE(detail.find(remedy), std::string::npos) << detail;
    EXPECT_EQ(detail.find('\n'), std::string::npos) << detail;
}

#define ASSERT_LOADED(volume) ASSERT_TRUE((volume).has_value()) << (volume).error().detail

} // namespace slabcast::test
