#!/usr/bin/env bash
# Makes Mesa's compilers for mobile GPUs from Debian's source, with shims that stand for the kernel's drivers, so that
# no hardware is needed. What is made is kept (about 10 minutes the first time, two cores).
# usage: perf/mobile/compilers.sh 22|25
#   22: Debian 12's Mesa 22.3, built here: Mali G71, G52, G57; Adreno 630, 650, 660
#   25: Debian 13's Mesa 25, built in a root of its own: Adreno 740
# Prints the folder of what was made. $SLABCAST_COMPILERS: where it is kept; else ~/.cache/slabcast-compilers.
# Exit status: 77 where it cannot be made here (no Debian, no root, no network), after a line that says why.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly cache=${SLABCAST_COMPILERS:-$HOME/.cache/slabcast-compilers}
readonly version=${1:?22 or 25}

unavailable() {
    echo "mobile compilers: $1" >&2
    exit 77
}

debianMirror() { awk '/^URIs:/ { print $2; exit }' /etc/apt/sources.list.d/debian.sources 2>/dev/null; }

# Of the drivers only these two, and no window system: what compiles shaders, and a context to ask it by.
readonly options="-Dbuildtype=release -Dvulkan-drivers= -Dtools=drm-shim -Dplatforms= -Dglx=disabled -Degl=enabled
    -Dgbm=enabled -Dgles1=disabled -Dgles2=enabled -Dllvm=disabled"

# Debian 12's source through lists of its own: the system's are left as they are.
build22() {
    "$here/../../platform/packages.sh" mobile >&2
    local lists=$cache/lists
    mkdir -p "$lists/partial"
    printf 'deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s bookworm main\n' "$(debianMirror)" >"$cache/source.list"
    local apt=(-o Dir::Etc::sourcelist="$cache/source.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$lists" -o APT::Get::List-Cleanup=0)
    apt-get "${apt[@]}" update -q >&2 || unavailable "Debian's list of sources cannot be fetched"
    cd "$cache"
    apt-get "${apt[@]}" source --download-only mesa=22.3.6-1+deb12u1 >&2 || apt-get "${apt[@]}" source --download-only mesa >&2 ||
        unavailable "the source of Debian 12's Mesa cannot be fetched"
    tar xzf mesa_22.3.6.orig.tar.gz
    cd mesa-22.3.6
    # Debian's Python, which has mako, before any other.
    PATH=/usr/bin:$PATH meson setup "$made" $options -Dgallium-drivers=freedreno,panfrost >&2
    PATH=/usr/bin:$PATH ninja -C "$made" >&2
}

build25() {
    [[ $(id -u) -eq 0 ]] || unavailable "a Debian 13 root is made by root only"
    "$here/../../platform/packages.sh" mobile >&2
    mmdebstrap --variant=apt --include="$(tr -d ' \n' <<<"meson,ninja-build,gcc,g++,python3-mako,python3-yaml,python3-packaging,
        bison,flex,libdrm-dev,zlib1g-dev,libexpat1-dev,libelf-dev,pkg-config,libegl-dev,libgles-dev,dpkg-dev,
        libarchive-dev,libxml2-dev")" trixie "$root" \
        "deb $(debianMirror) trixie main" "deb-src $(debianMirror) trixie main" >&2 || unavailable "Debian 13 cannot be fetched"
    cp /etc/resolv.conf "$root/etc/" || true
    chroot "$root" sh -c "cd /root && apt-get source --download-only mesa && tar xf mesa_25*.orig.tar.xz &&
        cd mesa-25* && meson setup build $(tr '\n' ' ' <<<"$options") -Dgallium-drivers=freedreno && ninja -C build && ln -s \$PWD/build /root/build" >&2
}

mkdir -p "$cache"
exec 9>"$cache/lock"
flock 9 # two at once would build into one folder
case $version in
22) made=$cache/22 ;;
25) made=$cache/25/root/build root=$cache/25 ;;
*) echo "mobile compilers: 22 or 25, not '$version'" >&2 && exit 2 ;;
esac
if [[ ! -e $cache/$version.done ]]; then
    [[ -n $(debianMirror) ]] || unavailable "sources come from Debian's mirror, which this system does not name"
    "build$version"
    touch "$cache/$version.done"
fi
echo "$made"
