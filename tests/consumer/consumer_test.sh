#!/usr/bin/env bash
# Installs a build into a temporary prefix and moves that prefix, for a package must not remember where it was made.
# Then a project outside the tree finds it, builds, and runs.
# usage: tests/consumer/consumer_test.sh BUILD_DIR
set -euo pipefail
build=$(realpath "${1:?usage: tests/consumer/consumer_test.sh BUILD_DIR}")
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    echo "consumer_test: $1" >&2
    exit 1
}

cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
if grep -rF -e "$build" -e "$(realpath "$source/../..")/" -e "$work/first" "$work/prefix/lib" --include='*.cmake'; then
    fail "the package names the folder above"
fi

# What applications include is there, and no internals.
include=$work/prefix/include/slabcast
[[ -s $include/slabcast.h && -s $include/platform/egl/egl_context.h ]] || fail "the way in is not installed"
for internal in core/gl/api.h core/gl/objects.h core/gl/state_guard.h core/scene/scene.h core/scene/gpu_scene.h \
    core/skip/octree.h core/skip/live_skip.h core/draw/renderer.h core/draw/proxy_stack.h core/reference/continuous.h \
    platform/egl/egl_library.h platform/io/base/readers.h platform/io/volumes/file_header.h platform/json/json_checks.h; do
    [[ -e $source/../../$internal ]] || fail "$internal is looked for and is no more: name another"
    [[ ! -e $include/$internal ]] || fail "$internal is installed"
done

cp -r "$source" "$work/source"
cp -r "$source/../../examples" "$work/source/examples"
if ! { cmake -S "$work/source" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" &&
    cmake --build "$work/build"; } >"$work/log" 2>&1; then
    cat "$work/log"
    fail "the consumer does not build"
fi
for example in minimal stereo edit; do
    "$work/build/$example" || fail "$example: the picture is wrong"
done

# The importers are a part of their own: left out of a build without their libraries.
if [[ -n $(find "$work/prefix" -name 'Slabcast_io.cmake') ]]; then
    printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n' >"$work/eight.nrrd"
    "$work/build/import" "$work/eight.nrrd" | tee "$work/log"
    grep -q 'last value 8$' "$work/log" || fail "the importer read something else"

    # Images need the module, found along the run path of whoever links the importers and of the program itself.
    mkdir "$work/slices"
    printf 'P2 2 2 255 1 2 3 4\n' >"$work/slices/1.pgm"
    printf 'P2 2 2 255 5 6 7 9\n' >"$work/slices/2.pgm"
    "$work/build/import" "$work/slices" | tee "$work/log"
    grep -q 'last value 9$' "$work/log" || fail "the importer read other images"

    slabcast=$work/prefix/bin/slabcast
    ! ldd "$slabcast" | grep OpenImageIO || fail "the program loads OpenImageIO before it is needed"
    draw=("$slabcast" render phantom:shells:16 --size 8x8 --planes 4 --layers 8 -o)
    "${draw[@]}" "$work/with.exr" >"$work/log"
    [[ -s $work/with.exr ]] || fail "no EXR picture with the module"
    find "$work/prefix" -name 'slabcast_images.so' -delete
    "${draw[@]}" "$work/a.png" >"$work/log" || fail "no PNG picture without the module"
    ! "${draw[@]}" "$work/without.exr" >"$work/log" 2>&1 || fail "an EXR picture without the module"
    [[ $(wc -l <"$work/log") -eq 1 && ! -e $work/without.exr ]] && grep "without.exr: .*slabcast_images.so" "$work/log" ||
        fail "without the module there should be one line and no picture"
    ! "$work/build/import" "$work/slices" 2>"$work/log" || fail "images are read without the module"
    grep "slices/1.pgm: .*slabcast_images.so" "$work/log" || fail "the missing module is not named"
fi
