#!/usr/bin/env bats
# A batch as a factory uses it: one zip, one table, one message at the end.

load helper

setup_file() {
    require_program
    make_sample
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    DATA=$BATS_TEST_TMPDIR/data
}
teardown() { stop_servers; }

# post_batch [--no-wait] TAG... : the sample last once for each tag; `broken` is no model.
post_batch() {
    local wait=(-H 'Prefer: wait=60')
    if [[ $1 == --no-wait ]]; then wait=(); shift; fi
    base64 -w0 "$sample/last.obj" > "$BATS_TEST_TMPDIR/last"
    printf 'v 0 0 0\nf 1 2 3\n' | base64 -w0 > "$BATS_TEST_TMPDIR/broken"
    printf '%s\n' "$@" | jq -Rn --rawfile last "$BATS_TEST_TMPDIR/last" --rawfile broken "$BATS_TEST_TMPDIR/broken" \
        --slurpfile request "$sample/last.request.json" \
        '{jobs: [inputs | . as $tag | {model: {data: (if $tag == "broken" then $broken else $last end)}, request: ($request[0] + {tag: $tag})}]}' \
        > "$BATS_TEST_TMPDIR/batch"
    ask -H 'Content-Type: application/json' "${wait[@]}" --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
}

@test "a batch comes back as one archive and one table, what failed beside it" {
    start_server
    post_batch size-38 broken '=1+1' ../../etc/passwd
    assert_equal "$status $(jq -c '[.finished, .states]' "$body")" '200 [true,{"succeeded":3,"failed":1}]'
    batch=$(jq -r .links.self "$body")
    curl -sSf "$url$batch/result.zip" -o "$BATS_TEST_TMPDIR/all.zip"
    mkdir "$BATS_TEST_TMPDIR/all"
    python3 - "$BATS_TEST_TMPDIR/all.zip" "$BATS_TEST_TMPDIR/all" <<'PYTHON'
import sys, zipfile
with zipfile.ZipFile(sys.argv[1]) as archive:
    assert archive.testzip() is None
    archive.extractall(sys.argv[2])
    print(*sorted(archive.namelist()), sep="\n", file=open(sys.argv[2] + ".names", "w"))
PYTHON
    for file in result.json pattern.svg flat.glb flat.obj; do
        for folder in 001-size-38 003-_1_1 004-.._.._etc_passwd; do grep -qx "$folder/$file" "$BATS_TEST_TMPDIR/all.names"; done
    done
    assert_equal "$(wc -l < "$BATS_TEST_TMPDIR/all.names")" 14
    first=$(jq -r '.items[0].links.result' "$body")
    curl -sSf "$url$first" | cmp - "$BATS_TEST_TMPDIR/all/001-size-38/result.json"
    curl -sSf "$url$first.svg" | cmp - "$BATS_TEST_TMPDIR/all/001-size-38/pattern.svg"
    assert_equal "$(jq -c '[.items[] | [.tag, .state, .problem.code]]' "$BATS_TEST_TMPDIR/all/errors.json")" '[["broken","failed","unreadable_model"]]'
    curl -sSf "$url$batch/results.csv" | cmp - "$BATS_TEST_TMPDIR/all/results.csv"
    python3 - "$BATS_TEST_TMPDIR/all/results.csv" "$BATS_TEST_TMPDIR/all/001-size-38/result.json" <<'PYTHON'
import csv, json, sys
rows = list(csv.DictReader(open(sys.argv[1], newline="")))
result = json.load(open(sys.argv[2]))
curves = [(r["name"], c["name"], c["length_3d_mm"]) for r in result["regions"] for c in r["curves"]]
own = [(r["region"], r["curve"], float(r["last_mm"])) for r in rows if r["tag"] == "size-38"]
assert [c[:2] for c in own] == [c[:2] for c in curves] and all(abs(a[2] - b[2]) < 1e-6 for a, b in zip(own, curves)), (own, curves)
assert [r["error"] for r in rows if r["tag"] == "broken"] == ["unreadable_model"]
assert any(r["tag"] == "'=1+1" for r in rows)
PYTHON
}

@test "a batch is followed as it happens" {
    start_server --workers 1
    make_bumpy 120 "$BATS_TEST_TMPDIR/slow.obj"
    post "$BATS_TEST_TMPDIR/slow.obj"  # keeps the batch waiting
    post_batch --no-wait a b
    batch=$(jq -r .links.self "$body")
    curl -sSN --max-time 60 "$url$batch/events" > "$BATS_TEST_TMPDIR/events" &
    stream=$!
    wait_until 5 grep -q '"state":"queued"' "$BATS_TEST_TMPDIR/events"
    ask -X POST "$url$job/cancel"
    wait "$stream"
    states=$(sed -n '/^event: job$/{n;s/^data: //p}' "$BATS_TEST_TMPDIR/events" | jq -r '.tag + " " + .state')
    for tag in a b; do
        for state in queued succeeded; do grep -qx "$tag $state" <<< "$states"; done
    done
    assert_equal "$(grep -A1 '^event: done$' "$BATS_TEST_TMPDIR/events" | sed -n 's/^data: //p' | jq -c .states)" '{"succeeded":2}'
    ask -X POST "$url$batch/cancel"
    assert_problem 409 already_finished
}

@test "a batch and its key outlive the service" {
    start_server --workers 1
    ask -H 'Content-Type: application/json' -H 'Idempotency-Key: series' -d '{"jobs": []}' "$url/v1/jobs:batch"
    assert_problem 422 invalid_request
    post_batch a
    ask -H 'Content-Type: application/json' -H 'Idempotency-Key: series' --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
    batch=$(jq -r .links.self "$body")
    kill -KILL "$server"
    start_server --workers 1
    curl -sS -D "$BATS_TEST_TMPDIR/headers" -H 'Content-Type: application/json' -H 'Idempotency-Key: series' \
        --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch" > "$BATS_TEST_TMPDIR/again"
    assert_equal "$(jq -r .links.self "$BATS_TEST_TMPDIR/again")" "$batch"
    grep -qi '^idempotent-replayed: true' "$BATS_TEST_TMPDIR/headers"
    assert_equal "$(curl -sS -H 'Prefer: wait=30' "$url$batch" | jq .finished)" true
    "$LASTFLAT" doctor --data "$data"
}
