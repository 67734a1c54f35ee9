#!/usr/bin/env bash
# Installs the Debian or Ubuntu packages that a step needs, and only what is missing.
# Where another package manager is at work, waits for it.
# usage: platform/packages.sh GROUP...        groups: build test demo compilers docs mobile
set -euo pipefail

# group, package, why
table="\
build g++                    the compiler (C++20)
build cmake                  configures the build
build ninja-build            runs it
build libglm-dev             vectors and matrices
build libexpected-dev        results that may fail, without exceptions (tl::expected)
build libgles-dev            OpenGL ES 3.2: headers
build libegl-dev             contexts without a window: headers
build libegl1                contexts without a window: loader
build libegl-mesa0           Mesa's EGL
build libgl1-mesa-dri        Mesa's drivers, llvmpipe among them: draws where there is no GPU
build libcli11-dev           command line
build nlohmann-json3-dev     JSON: transfer functions, statistics
build libfmt-dev             text formatting
build zlib1g-dev             reads the headers of compressed volumes
build libdcmtk-dev           reads DICOM
build libopenjp2-7-dev       decodes the JPEG 2000 in DICOM
build libpng-dev             writes PNG
build libseccomp-dev         holds the program that reads files to reading
build libtiff-dev            reads TIFF
build libjpeg-dev            reads JPEG, and tells where one is damaged
build libopenimageio-dev     reads other images, writes EXR
build python3-matplotlib     plots of the reports
test  libgtest-dev           unit tests
test  librapidcheck-dev      property tests
test  glslang-tools          checks every shader variant against the specification
demo  invesalius-examples    the skull: a CT as DICOM
demo  mricron-data           a head: MR as NIfTI
compilers clang-14           what Android's NDK compiles with
compilers libclang-rt-14-dev its fuzzer and sanitizers
compilers libc++-14-dev      its standard library
compilers libc++abi-14-dev   what that builds upon
compilers emscripten         the compiler for browsers
docs  doxygen                the reference of the public headers
mobile meson                 builds Mesa, whose compilers for mobile GPUs need no hardware
mobile bison                 Mesa's parsers
mobile flex                  their words
mobile python3-mako          Mesa's generated sources
mobile libdrm-dev            what Mesa's drivers ask the kernel by
mobile libexpat1-dev         Mesa's settings
mobile libelf-dev            a dependency of Mesa's tools
mobile dpkg-dev              fetches Debian's sources
mobile mmdebstrap            a Debian 13 root, for its newer Mesa"

isInstalled() { dpkg-query --show --showformat='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed; }

asRoot() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        echo "packages: neither root nor sudo; install as root: ${missing[*]}" >&2
        exit 1
    fi
}

refuse() {
    echo "packages: $1; groups: build test demo compilers docs mobile" >&2
    exit 2
}

# apt-get waits for the lock of dpkg if told to, and for that of the package lists never.
readonly lockSeconds=600
updateLists() {
    local end=$((SECONDS + lockSeconds)) said=""
    while true; do
        said=$(asRoot env LC_ALL=C apt-get update -q 2>&1) && break
        if [[ $said != *"Could not get lock"* || $SECONDS -ge $end ]]; then
            echo "$said" >&2
            # A third party's list that cannot be fetched is no reason to stop: the lists at hand may do.
            echo "packages: going on with the package lists at hand" >&2
            return
        fi
        echo "packages: another package manager reads its lists; waiting" >&2
        sleep 2
    done
}

main() {
    [[ $# -gt 0 ]] || refuse "no group named"
    local wanted
    for wanted in "$@"; do
        grep -q "^$wanted " <<<"$table" || refuse "no group '$wanted'"
    done
    table=$(grep -E "^($(IFS='|' && echo "$*")) " <<<"$table")
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "packages: neither Debian nor Ubuntu; these are needed, under your system's names:" >&2
        echo "$table" >&2
        return 0
    fi

    local missing=() package
    while read -r _ package _; do
        isInstalled "$package" || missing+=("$package")
    done <<<"$table"
    [[ ${#missing[@]} -gt 0 ]] || return 0
    echo "packages: installing ${missing[*]}"
    updateLists
    asRoot env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
        -o DPkg::Lock::Timeout=$lockSeconds "${missing[@]}"
}

main "$@"
