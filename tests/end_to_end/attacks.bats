#!/usr/bin/env bats
# What a hostile network sends: every attack has one clean answer, and the service is none the worse.

load helper

setup_file() { require_program; }
teardown() { stop_servers; }

memory() { awk '/VmHWM/ {print int($2 / 1024)}' "/proc/$server/status"; }

@test "broken framing, endless lines, bombs, floods and tricks are refused, in little memory" {
    start_server --max-body-mb 16
    run -0 python3 "$BATS_TEST_DIRNAME/../server/http/attacks.py" "${url##*:}" --body-bytes $(( 16 << 20 ))
    echo "$output" | grep -c '^ok' | sed 's/$/ attacks answered/; s/^/# /' >&3
    echo "# at most $(memory) MiB" >&3
    [[ -n ${LASTFLAT_SANITIZE:-} ]] || (( $(memory) < 300 ))
    ask "$url/healthz"
    assert_equal "$status" 200
}

@test "ranges of a result are one at a time and inside it" {
    make_sample
    start_server
    flatten "$BATS_FILE_TMPDIR/sample/last.obj" "$BATS_FILE_TMPDIR/sample/last.request.json"
    ask -H "Range: bytes=$(printf '0-,%.0s' $(seq 2600))0-" "$url$job/result"
    [[ $status == 400 || $status == 431 ]]
    ask -H 'Range: bytes=0-9999999999' "$url$job/result.svg"
    assert_equal "$status $(header Content-Length)" "206 $(curl -sS "$url$job/result.svg" | wc -c)"
    ask -H 'Range: bytes=9999999999-' "$url$job/result.svg"
    assert_problem 416 range_outside
}

@test "event streams and long polls that take every place leave the others theirs" {
    start_server --workers 1 --streams 4 --connections 2
    make_bumpy 260 "$BATS_TEST_TMPDIR/slow.obj"
    post "$BATS_TEST_TMPDIR/slow.obj"
    for _ in 1 2 3 4; do curl -sN "$url$job/events" > "$BATS_TEST_TMPDIR/stream" & done
    all_taken() { [[ $(curl -s -o "$BATS_TEST_TMPDIR/full" -w '%{http_code}' --max-time 1 "$url$job/events") == 503 ]]; }
    wait_until 5 all_taken
    begun=$(milliseconds)
    ask -H 'Prefer: wait=30' "$url$job"  # answered at once: there is no place to wait
    (( $(milliseconds) - begun < 1000 ))
    assert_equal "$status" 200
    ask -X DELETE "$url$job"
    assert_equal "$status" 204
    wait $(jobs -p | grep -v "^$server$")
}
