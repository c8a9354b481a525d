#!/bin/sh
# Builds the harnesses in build/fuzz and runs each for SECONDS (default 60) over its corpus.
# One line per harness; exit 1 if any of them found something. See README.md.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
seconds=${1:-60}
build=${LASTFLAT_FUZZ_BUILD:-$root/build/fuzz}

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DLASTFLAT_FUZZ=ON \
    -DCMAKE_CXX_COMPILER="${CXX:-clang++}" >/dev/null
ninja -C "$build" -j "${LASTFLAT_FUZZ_JOBS:-1}" fuzz >/dev/null

failed=0
for harness in ${LASTFLAT_FUZZ_ONLY:-obj stl ply gltf request_json http_head multipart chunked flatten}; do
    grown=$build/corpus/$harness  # what the fuzzer learns stays out of the source tree
    found=$build/findings/$harness
    mkdir -p "$grown" "$found"
    dictionary=$here/dictionaries/$harness.dict
    status=0
    "$build/tests/fuzz/fuzz_$harness" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
        -max_len=4096 -print_final_stats=1 -artifact_prefix="$found/" \
        ${dictionary:+$([ -f "$dictionary" ] && echo "-dict=$dictionary")} \
        "$grown" "$here/corpus/$harness" >"$build/$harness.log" 2>&1 || status=$?
    statistic() { sed -n "s/^stat::$1: *//p" "$build/$harness.log"; }
    findings=$(find "$found" -type f | wc -l)
    printf '%-14s %10s executions %8s per second %3s findings\n' "$harness" \
        "$(statistic number_of_executed_units)" "$(statistic average_exec_per_sec)" "$findings"
    if [ "$status" -ne 0 ] || [ "$findings" -ne 0 ]; then
        failed=1
        echo "  log: $build/$harness.log, inputs: $found"
    fi
done
exit $failed
