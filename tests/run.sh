#!/usr/bin/env bash
# Builds everything and runs all tests. Ends with ctest's summary. Further arguments go to ctest: tests/run.sh -R skip
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

platform/packages.sh build test
cmake --preset release -DSLABCAST_BUILD_TESTS=ON -DSLABCAST_CI_TESTS=OFF
cmake --build build
exec ctest --test-dir build --output-on-failure --no-tests=error --parallel "$(nproc)" "$@"
