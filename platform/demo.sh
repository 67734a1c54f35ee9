#!/usr/bin/env bash
# From a fresh machine to a picture: packages, build, a CT skull, its rendering and the ratio sweep's report.
# What is up to date is left alone, so a second run takes seconds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out=build/demo
slabcast=build/bin/slabcast
skull=$out/skull.nrrd
picture=$out/skull.png
report=$out/sweep/report.html

renderOptions=(--size 1024x1024 --tf ct-bone --shade phong --camera=-32,12,2.0 --fov 34 --background 0d1014
    --layer-spacing 0.25 --planes 100 --target rgba16f)
sweepOptions=(--size 512x512 --tf ct-bone --classify preclassified --shade phong --layers "1,4,8,16,32,64,0" --frames 3)

# newer TARGET INPUT...: the target exists and no input is newer.
newer() {
    local target=$1 input
    [[ -e $target ]] || return 1
    for input in "${@:2}"; do
        [[ ! $input -nt $target ]] || return 1
    done
}

platform/packages.sh build demo

# The tests share the build folder and switch themselves on; here they would only ask for more packages.
[[ -f build/build.ninja ]] || cmake --preset release -DSLABCAST_BUILD_TESTS=OFF
cmake --build build --target slabcast

mkdir -p "$out"
newer "$skull" assets/prepare_skull.py ||
    /usr/bin/python3 assets/prepare_skull.py "$skull"
newer "$picture" "$skull" "$slabcast" platform/demo.sh ||
    "$slabcast" render "$skull" -o "$picture" "${renderOptions[@]}"
newer "$report" "$skull" "$slabcast" platform/demo.sh ||
    "$slabcast" sweep "$skull" --out "$out/sweep" --fresh "${sweepOptions[@]}"

echo
echo "picture  $PWD/$picture"
echo "report   $PWD/$report"
