#!/usr/bin/env bash
# Installs, builds and runs every test. Ends with ctest's own summary; exit code 0: all passed.
# Quick run while working: cmake --workflow --preset dev
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s (%d min)\n' "$1" $((SECONDS / 60)); }
quietly() {
    local log
    log=$(mktemp)
    if ! "$@" >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        rm -f "$log"
        echo "failed: $*" >&2
        exit 1
    fi
    rm -f "$log"
}
build() {  # PRESET TARGET...
    quietly cmake --preset "$1"
    quietly cmake --build --preset "$1" --target "${@:2}"
}

step "install"
tests/install.sh run build test

step "format"
git ls-files -z '*.h' '*.cpp' 2>/dev/null | xargs -0 clang-format-14 --dry-run --Werror

step "release: build"
build release all

step "headers"
build release check_headers

step "address and undefined behaviour sanitizers"
build asan core_tests api_tests server_tests lastflat
ctest --preset asan -R '^(core_tests|api_tests|server_tests|hostile)$' --quiet --output-log build/asan/ctest.log ||
    { tail -n 80 build/asan/ctest.log; exit 1; }

step "thread sanitizer"
build tsan server_tests parallel_tests
ctest --preset tsan -R '^(server_tests|parallel_tests)$' --quiet --output-log build/tsan/ctest.log ||
    { tail -n 80 build/tsan/ctest.log; exit 1; }

step "release: test"
ctest --preset release
