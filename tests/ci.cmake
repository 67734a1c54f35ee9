# Tests that a newcomer need not wait for: they take other compilers, or compile the library once more.

# Core as strictly as its own build is, perf likewise; 77 says that the compiler is not here.
foreach(compiler IN ITEMS gcc clang libc++ emscripten)
    slabcast_test(portability_${compiler} portability ${CMAKE_CURRENT_SOURCE_DIR}/portability.sh ${compiler}
        ${CMAKE_CURRENT_BINARY_DIR} ${SLABCAST_WARNINGS} ${SLABCAST_NO_WARNINGS} -- ${SLABCAST_CONVERSIONS})
    set_tests_properties(portability_${compiler} PROPERTIES SKIP_RETURN_CODE 77 PROCESSORS 2)
endforeach()

# What runs on several threads, every access to shared memory checked: the executor, and structures that are rebuilt
# while they are edited. Of the library only what these see.
file(GLOB threadTests CONFIGURE_DEPENDS unit/*executor*_test.cpp unit/*parallel*_test.cpp unit/live_*_test.cpp)
set(threadSources ${coreSources})
list(FILTER threadSources INCLUDE REGEX "core/(base|volume|transfer|view|skip)/[^/]*$")
add_executable(thread_tests ${threadTests} support/property.cpp ${threadSources})
target_include_directories(thread_tests PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(thread_tests PRIVATE glm::glm tl::expected Threads::Threads rapidcheck GTest::gtest_main)
target_compile_options(thread_tests PRIVATE -O1 -g1 -fsanitize=thread)
target_link_options(thread_tests PRIVATE -fsanitize=thread)
slabcast_test(threads threads thread_tests)
set_tests_properties(threads PROPERTIES ENVIRONMENT "RC_PARAMS=max_success=20;TSAN_OPTIONS=halt_on_error=1")

# The library as an application takes it that has files and windows of its own: without importers, without tests,
# without a warning.
slabcast_test(core_alone alone ${CMAKE_CTEST_COMMAND}
    --build-and-test ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/core_alone
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_BUILD_TYPE=Release -DSLABCAST_BUILD_IO=OFF -DSLABCAST_BUILD_TESTS=OFF -DSLABCAST_WERROR=ON)
set_tests_properties(core_alone PROPERTIES PROCESSORS 2)

# A little of what tests/fuzz/fuzz.sh does for as long as one likes; the same in every run.
if(SLABCAST_BUILD_IO)
    slabcast_test(fuzz_smoke fuzz ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz.sh ${CMAKE_BINARY_DIR}
        ${CMAKE_BINARY_DIR}/fuzz -runs=30000)
    set_tests_properties(fuzz_smoke PROPERTIES SKIP_RETURN_CODE 77 PROCESSORS 2 ENVIRONMENT SEED=1)
endif()

slabcast_test(reference_pages docs ${PROJECT_SOURCE_DIR}/docs/reference.sh ${CMAKE_BINARY_DIR}
    ${CMAKE_BINARY_DIR}/reference)
