#!/usr/bin/env bash
# Makes the reference of the public headers: those that `cmake --install` lays down. Ends with status 1 at a warning.
# usage: docs/reference.sh BUILD_DIR OUT_DIR        BUILD_DIR: configured; OUT_DIR/html/index.html is the first page
set -euo pipefail
build=$(realpath "${1:?usage: docs/reference.sh BUILD_DIR OUT_DIR}")
out=${2:?usage: docs/reference.sh BUILD_DIR OUT_DIR}
docs=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work" >/dev/null
mkdir -p "$out"
SLABCAST_INCLUDE=$work/include/slabcast SLABCAST_DOCS=$docs SLABCAST_OUT=$(realpath "$out") doxygen "$docs/Doxyfile"
