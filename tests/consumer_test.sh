#!/usr/bin/env bash
# Installs a build into a temporary prefix and moves that prefix, for a package must not remember where it was made.
# Then a project outside the tree finds it, builds, and runs.
# usage: tests/consumer_test.sh BUILD_DIR
set -euo pipefail
build=$(realpath "${1:?usage: tests/consumer_test.sh BUILD_DIR}")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    echo "consumer_test: $1" >&2
    exit 1
}

cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
if grep -rF -e "$build" -e "$(dirname "$tests")/" -e "$work/first" "$work/prefix/lib" --include='*.cmake'; then
    fail "the package names the folder above"
fi

cp -r "$tests/consumer" "$work/source"
if ! { cmake -S "$work/source" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" &&
    cmake --build "$work/build"; } >"$work/log" 2>&1; then
    cat "$work/log"
    fail "the consumer does not build"
fi
"$work/build/consumer" || fail "the picture is wrong"

# The importers are a part of their own: left out of a build without ITK.
if [[ -n $(find "$work/prefix" -name 'Slabcast_io.cmake') ]]; then
    printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n' >"$work/eight.nrrd"
    "$work/build/import" "$work/eight.nrrd" | tee "$work/log"
    grep -q 'last value 8$' "$work/log" || fail "the importer read something else"
fi
