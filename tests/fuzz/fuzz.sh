#!/usr/bin/env bash
# Feeds every parser of ours what libFuzzer thinks of, with addresses and undefined operations checked.
# usage: tests/fuzz/fuzz.sh BUILD FOLDER -runs=N|-max_total_time=SECONDS [TARGET...]
# BUILD: a build of the project, for the libraries that parsers stand on. FOLDER: keeps what was found interesting, from
# run to run, and findings. $SEED: of chance; 0, or none: another in every run. Targets: those of targets.cpp. Prints a line for each: executions, edges covered.
# Exit status: 0 where nothing was found, 1 where something was, 77 where clang or its libFuzzer is not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly build=${1:?a build folder} folder=${2:?a folder} effort=${3:?-runs=N or -max_total_time=SECONDS}
shift 3
if [[ $# -gt 0 ]]; then targets=("$@"); else
    mapfile -t targets < <(grep -oE '^ +\{"[a-z_]+"|, +\{"[a-z_]+"' tests/fuzz/targets.cpp | grep -oE '[a-z_]+')
fi

# Instrumented: what parses. Everything below it is linked as it ships.
readonly sources=(tests/fuzz/targets.cpp platform/io/base/load_words.cpp platform/io/base/parse_text.cpp platform/io/volumes/*header*.cpp
    platform/io/volumes/length_unit.cpp platform/io/apart/wire.cpp platform/json/json_checks.cpp
    platform/json/transfer_json.cpp platform/cli/edit_script.cpp perf/json.cpp perf/error/error_table_json.cpp)
readonly flags=(-std=c++20 -O2 -g1 -I. -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all)

clang=$(command -v clang++-14 || command -v clang++) || { echo "skipped: no clang++"; exit 77; }
mkdir -p "$folder/objects"
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$folder/objects/try.cpp"
"$clang" -fsanitize=fuzzer "$folder/objects/try.cpp" -o "$folder/objects/try" 2>/dev/null || {
    echo "skipped: no libFuzzer; platform/packages.sh compilers installs it"
    exit 77
}

compile() { "$clang" "${flags[@]}" -c "$1" -o "$2"; }
objects=()
for source in "${sources[@]}"; do
    objects+=("$folder/objects/$(tr / _ <<<"$source").o")
    while [[ $(jobs -rp | wc -l) -ge $(nproc) ]]; do wait -n; done
    compile "$source" "${objects[-1]}" &
done
wait
libraries=("$build/platform/io/libslabcast_io.a" "$build/platform/json/libslabcast_json.a"
    "$build/perf/libslabcast_perf.a" "$build/core/libslabcast_core.a")
readonly program=$folder/fuzz
"$clang" "${flags[@]}" "${objects[@]}" -Wl,--start-group "${libraries[@]}" -Wl,--end-group -lfmt -lz -lpthread -ldl \
    -Wl,--unresolved-symbols=ignore-all -o "$program" # of readers' libraries, which no parser calls

status=0
for target in "${targets[@]}"; do
    corpus=$folder/corpus/$target
    mkdir -p "$corpus" "$folder/findings/$target"
    cp -n tests/fuzz/seeds/"$target"/* "$corpus" 2>/dev/null || true
    if ! SLABCAST_FUZZ=$target "$program" "$effort" -seed="${SEED:-0}" -print_final_stats=1 -artifact_prefix="$folder/findings/$target/" \
        -max_len=1024 -timeout=30 -rss_limit_mb=2048 "$corpus" >"$folder/$target.log" 2>&1; then
        status=1
        grep -aE "ERROR|SUMMARY|runtime error|Test unit written" "$folder/$target.log" | head -n 5 || true
    fi
    printf '%-14s %10s executions, %5s edges\n' "$target" \
        "$(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/$target.log")" \
        "$(grep -ao 'cov: [0-9]*' "$folder/$target.log" | tail -n 1 | cut -d' ' -f2)"
done
exit $status
