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
    cp -r "$LASTFLAT_SOURCE/client-examples/javascript" "$PROJECT/"
    cd "$PROJECT" && npm ci --silent --no-progress
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    DATA=$BATS_TEST_TMPDIR/data
    cd "$PROJECT"
}
teardown() { stop_servers; }

compile() {
    npm run --silent generate
    npm run --silent compile
    ln -sfn ../javascript built/javascript
}

@test "the contract has nothing that linters complain of" {
    npm run --silent lint
}

@test "the JavaScript module is what its types say" {
    npm run --silent declare
    for types in lastflat.d.ts texture.d.ts; do diff "declared/$types" "javascript/$types"; done
}

@test "a client made of the contract compiles strictly and does its work" {
    compile
    start_server
    node built/client.js "$url" "$sample/last.obj" "$sample/last.request.json" > "$BATS_TEST_TMPDIR/curves"
    grep -Eqx 'lateral centre_front [0-9.]+ pass' "$BATS_TEST_TMPDIR/curves"
    grep -Eqx 'medial heel [0-9.]+ pass' "$BATS_TEST_TMPDIR/curves"
}

@test "every corner of a flat-shaded model has its place on the pattern" {
    compile
    start_server
    node built/texture.js "$url" "$sample/last.glb" > "$BATS_TEST_TMPDIR/textured"
    grep -Eqx '8192 triangles, [0-9]+ of them in parts' "$BATS_TEST_TMPDIR/textured"
}

@test "the JavaScript example uploads once, follows, asks again, and textures the model" {
    start_server
    cd "$BATS_TEST_TMPDIR"
    node "$PROJECT/javascript/flatten.js" "$sample/last.glb" "$sample/last.request.json" featherline > printed 2> progress
    grep -qx 'constrain [0-9]* %' progress
    grep -Eqx 'lateral featherline: [0-9.]+ mm on the last, flat - last [0-9.]+ mm \(free\)' printed
    grep -Eqx 'lateral featherline: [0-9.]+ mm on the last, flat - last -?0\.000000 mm pass' printed
    jq -e '.data.attributes.uv.array | length == 2 * 3 * 8192 and min >= 0 and max <= 1' textured.json
    run -2 --separate-stderr node "$PROJECT/javascript/flatten.js" "$sample/last.glb" "$sample/last.request.json" nobody
    [[ $stderr == *"(at /locks/"* ]]
}

@test "the JavaScript client asks again what did not come through, and cancels what it gave up" {
    start_server --workers 1
    node faults.mjs "$url" "$sample/last.obj" > "$BATS_TEST_TMPDIR/faults"
    grep -Eqx '[0-9]+ requests on a bad line' "$BATS_TEST_TMPDIR/faults"
}

@test "the glTF validator finds nothing in what is written" {
    cd "$BATS_TEST_TMPDIR"
    "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out halves
    "$LASTFLAT" flatten "$sample/last.obj" --out found
    node "$PROJECT/validate_glb.mjs" halves/flat.glb found/flat.glb "$sample/last.glb"
    printf 'glTF\x02\0\0\0' > broken.glb
    run -1 node "$PROJECT/validate_glb.mjs" broken.glb
}

@test "the page at /docs shows every operation with its bodies, examples and answers" {
    start_server
    node docs.mjs "$url" > "$BATS_TEST_TMPDIR/shown"
    grep -Eqx '[0-9]+ operations' "$BATS_TEST_TMPDIR/shown"
}
