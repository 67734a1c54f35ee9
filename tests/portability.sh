#!/usr/bin/env bash
# Compiles all of core and perf by one compiler, with every warning an error, and makes no objects.
# usage: tests/portability.sh COMPILER FOLDER [FLAG...] [-- CORE_FLAG...]
# COMPILER: gcc, clang, libc++ or emscripten. FOLDER: for what Emscripten keeps. CORE_FLAGs are for core alone.
# Exit status: 0 where all compile, 1 where one does not, 2 on bad usage, 77 where the compiler is not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
    echo "skipped: $1; platform/packages.sh compilers installs it"
    exit 77
}

# Of several names for one program, the first that is there.
firstOf() {
    local name
    for name in "$@"; do
        command -v "$name" && return
    done
    return 1
}

compiles() { "$@" -x c++ -std=c++20 -fsyntax-only - <<<'#include <vector>' >/dev/null 2>&1; }

main() {
    local which=${1:?a compiler: gcc clang libc++ emscripten} folder=${2:?a folder} flags=() command perProcess=8 status=0
    shift 2
    while [[ $# -gt 0 && $1 != -- ]]; do
        flags+=("$1")
        shift
    done
    case $which in
    gcc) command=("$(firstOf g++-12 g++)") || skip "no g++" ;;
    clang) command=("$(firstOf clang++-14 clang++)") || skip "no clang++" ;;
    libc++)
        command=("$(firstOf clang++-14 clang++)" -stdlib=libc++ -fno-exceptions -fno-rtti) || skip "no clang++"
        compiles "${command[@]}" || skip "no libc++"
        ;;
    emscripten)
        command=("$(firstOf em++)" -pthread -fno-exceptions -fno-rtti) || skip "no em++"
        headersForEmscripten "$folder/emscripten"
        perProcess=1 # em++ leaves out the sources after one that fails
        ;;
    *)
        echo "portability: no compiler '$which'" >&2
        exit 2
        ;;
    esac
    echo "$which: $("${command[0]}" --version | head -n 1)"
    check perf "${flags[@]}" || status=1
    check core "${flags[@]}" "${@:2}" || status=1
    return $status
}

# Every source of a folder by `command`. All that fail are shown: xargs goes on, and fails at the end.
check() {
    local sources
    sources=$(find "$1" -name '*.cpp' | wc -l)
    if find "$1" -name '*.cpp' -print0 |
        xargs -0 -n "$perProcess" -P "$(nproc)" "${command[@]}" -std=c++20 -fsyntax-only -I. "${@:2}" -Werror; then
        echo "$which: $sources sources of $1 compile"
    else
        echo "$which: of $sources sources of $1 some do not compile"
        return 1
    fi
}

# Emscripten sees no header of the system's own, so the header-only libraries are put where it looks. Its cache as
# Debian installs it can only be read, so a copy of our own is made before compilers run side by side.
headersForEmscripten() {
    local folder=$1 library
    mkdir -p "$folder/include"
    for library in glm tl nlohmann; do
        ln -sfn "/usr/include/$library" "$folder/include/$library"
    done
    export EM_CACHE=$folder/cache EM_FROZEN_CACHE=
    command+=(-isystem "$folder/include")
    compiles "${command[@]}" || skip "em++ compiles nothing"
}

main "$@"
