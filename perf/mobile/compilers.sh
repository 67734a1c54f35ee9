#!/usr/bin/env bash
# Makes Mesa's compilers for mobile GPUs from Debian's source, with shims that stand for the kernel's drivers, so that
# no hardware is needed. What is made is kept. Two cores take about ten minutes for either.
# usage: perf/mobile/compilers.sh 22|25
#   22: Debian 12's Mesa 22.3, built here: Mali G71, G52, G57; Adreno 630, 650/660
#   25: Debian 13's Mesa 25, built in a root of its own: Mali G610; Adreno 740
# Prints the folder of what was made. $SLABCAST_COMPILERS: where it is kept; else ~/.cache/slabcast-compilers.
# Exit status: 77 where it cannot be made here (no Debian, no root, no network), after a line that says why.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly cache=${SLABCAST_COMPILERS:-$HOME/.cache/slabcast-compilers}
readonly version=${1:-}

unavailable() {
    echo "mobile compilers: $1" >&2
    exit 77
}

debianMirror() { awk '/^URIs:/ { print $2; exit }' /etc/apt/sources.list.d/debian.sources 2>/dev/null; }

# Of the drivers only these two, and no window system: what compiles shaders, and a context to ask it by. What they say
# does not depend on how well they are optimised themselves.
readonly options="-Doptimization=1 -Ddebug=false -Db_ndebug=true -Dgallium-drivers=freedreno,panfrost
    -Dvulkan-drivers= -Dtools=drm-shim -Dplatforms= -Dglx=disabled -Degl=enabled -Dgbm=enabled -Dgles1=disabled
    -Dgles2=enabled -Dgallium-va=disabled -Dgallium-vdpau=disabled -Dgallium-xa=disabled -Dvideo-codecs=
    -Dshader-cache=disabled"
readonly shims="src/panfrost/drm-shim/libpanfrost_noop_drm_shim.so src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so"

# Debian 12's source through lists of its own: the system's are left as they are.
build22() {
    "$here/../../platform/packages.sh" mobile >&2
    local lists=$cache/lists
    mkdir -p "$lists/partial"
    printf 'deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s bookworm main\n' \
        "$(debianMirror)" >"$cache/source.list"
    local apt=(-o Dir::Etc::sourcelist="$cache/source.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$lists"
        -o APT::Get::List-Cleanup=0)
    apt-get "${apt[@]}" update -q >&2 || unavailable "Debian's list of sources cannot be fetched"
    cd "$cache"
    apt-get "${apt[@]}" source --download-only mesa >&2 ||
        unavailable "the source of Debian 12's Mesa cannot be fetched"
    rm -rf mesa-22.3.6 "$made"
    tar xzf mesa_22.3.6.orig.tar.gz
    cd mesa-22.3.6
    # Debian's Python, which has mako, before any other.
    # shellcheck disable=SC2086 # words
    PATH=/usr/bin:$PATH meson setup "$made" $options -Dllvm=disabled >&2
    # shellcheck disable=SC2086
    PATH=/usr/bin:$PATH ninja -C "$made" src/egl/libEGL.so.1.0.0 src/gbm/libgbm.so.1.0.0 \
        src/gallium/targets/dri/msm_dri.so src/gallium/targets/dri/panfrost_dri.so $shims >&2
}

# Panfrost's own kernels take LLVM's OpenCL to build, and nothing of it to run.
build25() {
    [[ $(id -u) -eq 0 ]] || unavailable "a Debian 13 root is made by root only"
    "$here/../../platform/packages.sh" mobile >&2
    rm -rf "$root"
    mmdebstrap --variant=apt --include="$(tr -d ' \n' <<<"meson,ninja-build,gcc,g++,python3-mako,python3-yaml,
        python3-packaging,bison,flex,libdrm-dev,zlib1g-dev,libelf-dev,pkg-config,dpkg-dev,xz-utils,llvm-19-dev,
        libclang-19-dev,libclang-cpp19-dev,libclc-19-dev,libclc-19,llvm-spirv-19,libllvmspirvlib-19-dev,spirv-tools,
        libarchive-dev,libxml2-dev")" trixie "$root" \
        "deb $(debianMirror) trixie main" "deb-src $(debianMirror) trixie main" >&2 ||
        unavailable "Debian 13 cannot be fetched"
    cp /etc/resolv.conf "$root/etc/" || true
    chroot "$root" sh -euc "cd /root && apt-get update -q && apt-get source --download-only mesa
        tar xf mesa_25*.orig.tar.xz && cd mesa-25*
        meson setup /root/build $(tr '\n' ' ' <<<"$options") -Dllvm=enabled -Ddraw-use-llvm=false -Dxmlconfig=disabled
        ninja -C /root/build src/egl/libEGL.so.1.0.0 src/gbm/libgbm.so.1.0.0 src/gbm/backends/dri/dri_gbm.so $shims" >&2
}

case $version in
22) made=$cache/22 ;;
25) made=$cache/25/root/build root=$cache/25 ;;
*)
    echo "usage: perf/mobile/compilers.sh 22|25" >&2
    exit 2
    ;;
esac
mkdir -p "$cache"
exec 9>"$cache/lock.$version"
flock 9 # two at once would build into one folder
if [[ ! -e $cache/$version.done ]]; then
    [[ -n $(debianMirror) ]] || unavailable "sources come from Debian's mirror, which this system does not name"
    "build$version" 9>&-
    touch "$cache/$version.done"
fi
echo "$made"
