#!/usr/bin/env bats
# The contract as tools understand it: linted, made into a client, compiled strictly, run.

load helper

setup_file() {
    require_program
    command -v npm >/dev/null || skip "npm is not installed"
    make_sample
    export PROJECT=$BATS_FILE_TMPDIR/typescript
    cp -r "$LASTFLAT_SOURCE/tests/typescript" "$PROJECT"
    cp "$LASTFLAT_SOURCE/api/openapi.json" "$PROJECT/"
    cd "$PROJECT" && npm ci --silent --no-progress
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    DATA=$BATS_TEST_TMPDIR/data
    cd "$PROJECT"
}
teardown() { stop_servers; }

@test "the contract has nothing that linters complain of" {
    npm run --silent lint
}

@test "a client made of it compiles strictly and does its work" {
    npm run --silent generate
    npm run --silent compile
    start_server
    node built/client.js "$url" "$sample/last.obj" "$sample/last.request.json" > "$BATS_TEST_TMPDIR/curves"
    grep -Eqx 'lateral centre_front [0-9.]+ pass' "$BATS_TEST_TMPDIR/curves"
    grep -Eqx 'medial heel [0-9.]+ pass' "$BATS_TEST_TMPDIR/curves"
}
