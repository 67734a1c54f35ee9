// main() of tests that ctest lists by source file: --file=NAME runs those of one file and no
// others.
#include <cstdio>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace {

/// A filter of GoogleTest's with every test of the file; empty where it has none.
std::string testsOfFile(const std::string& file) {
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    std::string filter;
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *all.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            const std::string path = test.file();
            if (path.substr(path.find_last_of('/') + 1) == file) {
                filter += std::string(filter.empty() ? "" : ":") + suite.name() + "." + test.name();
            }
        }
    }
    return filter;
}

} // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    constexpr const char* kOption = "--file=";
    if (argc > 1) {
        const bool isFile = std::strncmp(argv[1], kOption, std::strlen(kOption)) == 0;
        const std::string filter = isFile ? testsOfFile(argv[1] + std::strlen(kOption)) : "";
        if (filter.empty()) {
            std::fprintf(stderr, "%s: no test of %s\n", argv[0], argv[1]);
            return 2;
        }
        testing::GTEST_FLAG(filter) = filter;
    }
    return RUN_ALL_TESTS();
}
