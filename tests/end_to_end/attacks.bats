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

@test "JSON of countless small values is refused before it fills memory, and others are answered meanwhile" {
    start_server
    python3 - "$BATS_TEST_TMPDIR" << 'END'
import sys
def write(name, text):
    open(f"{sys.argv[1]}/{name}.json", "w").write(text)
def within(list):
    return '{"model": {"asset_id": "a"}, "request": {"curves": ' + list + '}}'
write("lists", within("[" + "[]," * 60_000_000 + "[]]"))
write("objects", within("[" + '{"a":1},' * 1_500_000 + '{"a":1}]'))
write("spaces", within("[" + " " * (40 << 20) + "]"))
write("megabyte", within("[" + '{"a":1},' * 125_000 + '{"a":1}]'))
END
    for kind in lists objects spaces megabyte; do
        ask -H 'Content-Type: application/json' --data-binary "@$BATS_TEST_TMPDIR/$kind.json" "$url/v1/jobs"
        assert_problem 422 invalid_request
    done
    echo "# at most $(memory) MiB" >&3
    [[ -n ${LASTFLAT_SANITIZE:-} ]] || (( $(memory) < 700 ))
    for _ in $(seq 64); do
        curl -s -o "$BATS_TEST_TMPDIR/refused" -H 'Content-Type: application/json' --data-binary "@$BATS_TEST_TMPDIR/megabyte.json" "$url/v1/jobs" &
    done
    ask "$url/v1/jobs"
    assert_equal "$status" 200
    kill %% 2> "$BATS_TEST_TMPDIR/kill" || true
    wait $(jobs -p | grep -v "^$server\$") || true
}

@test "without a key, web pages and proxies are refused, whatever they call this machine" {
    start_server
    ask -H 'Host: evil.example' "$url/v1/jobs"
    assert_problem 403 host_refused
    ask -H 'Origin: https://evil.example' -F "model=@$contract" "$url/v1/jobs"
    assert_problem 403 origin_refused
    ask -H 'Sec-Fetch-Site: cross-site' "$url/v1/jobs"
    assert_problem 403 origin_refused
    for proxy in 'Via: 1.1 gate' 'X-Real-IP: 203.0.113.9' 'X-Forwarded-Proto: https' 'CF-Connecting-IP: 203.0.113.9'; do
        ask -H "$proxy" "$url/v1/jobs"
        assert_problem 401 no_keys
    done
    ask -H 'Sec-Fetch-Site: cross-site' -H 'Sec-Fetch-Mode: navigate' "$url/docs"
    assert_equal "$status" 200
    ask -H "Origin: $url" "$url/v1/jobs"
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
