#!/usr/bin/env bats
# Live sessions: what the contract's walk does not see.

load helper

setup_file() { require_program; }
setup() { start_server; }
teardown() { stop_servers; }

# open MODEL [REQUEST]: sets $session, its URL.
open() {
    ask -F "model=@$1" ${2:+-F "request=@$2"} "$url/v1/sessions"
    assert_equal "$status" 201
    session=$url/v1/sessions/$(jq -r .id "$body")
    cp "$body" "$BATS_TEST_TMPDIR/opened"
}

# change SEQUENCE PATCH
change() { ask -X PATCH -H 'Content-Type: application/merge-patch+json' -d "$2" "$session?sequence=$1"; }

last=$examples/sample-last/last.obj
request=$examples/sample-last/last.request.json

@test "a job of a session has the bytes of the job that its request would be" {
    open "$last" "$request"
    change 1 '{"weights": {"stretch": 2}, "locks": [{"curve": "centre_front"}]}'
    assert_equal "$status $(jq -r .changed "$body")" "200 pattern"
    ask -X POST "$session/job"
    assert_equal "$status" 202
    (( $(jq '.difference_mm < 1e-5' "$body" | grep -c true) == 1 ))
    local id
    id=$(jq -r .job.id "$body")
    ask -H 'Prefer: wait=30' "$url/v1/jobs/$id"
    ask "$url/v1/jobs/$id/result"
    jq -S 'del(.timing_ms)' "$body" > "$BATS_TEST_TMPDIR/of-session"
    jq '.weights = {"stretch": 2} | .locks = [{"curve": "centre_front"}]' "$request" > "$BATS_TEST_TMPDIR/asked"
    ask -H 'Prefer: wait=30' -F "model=@$last" -F "request=@$BATS_TEST_TMPDIR/asked" "$url/v1/jobs"
    ask "$url/v1/jobs/$(jq -r .id "$body")/result"
    jq -S 'del(.timing_ms)' "$body" > "$BATS_TEST_TMPDIR/alone"
    cmp "$BATS_TEST_TMPDIR/of-session" "$BATS_TEST_TMPDIR/alone"
}

@test "on a bare last, the found curve is corrected, and the cut moves" {
    open <(grep -v '^g ' "$last")
    jq '.pattern.found.request.curves.heel.polyline' "$BATS_TEST_TMPDIR/opened" > "$BATS_TEST_TMPDIR/heel"
    change 1 "$(jq -c '{curves: {heel: {polyline: [.[] | .[1] += 0.5]}}}' "$BATS_TEST_TMPDIR/heel")"
    assert_equal "$status $(jq -r .changed "$body")" "200 regions"
    jq -e '[.pattern.regions[].curves[] | select(.locked) | .verdict] | all(. == "pass")' "$body"
    change 2 '{"curves": null}'
    assert_equal "$status $(jq -r .changed "$body")" "200 regions"
    # Back where it began, but for what the way there leaves: less than a micrometre.
    jq -n --slurpfile a "$BATS_TEST_TMPDIR/opened" --slurpfile b "$body" \
        '[$a[0].pattern.regions, $b[0].pattern.regions | map(.uv_mm)] | transpose
         | map(transpose | map(.[0] as $p | .[1] as $q | ($p[0] - $q[0] | fabs) + ($p[1] - $q[1] | fabs))) | flatten | max < 1e-3' \
        | grep -q true
}

@test "a newer change ends the one that is being computed" {
    python3 - "$BATS_TEST_TMPDIR/disk.obj" << 'END'
import math, sys
n = 130
with open(sys.argv[1], "w") as file:
    for y in range(n):
        for x in range(n):
            file.write(f"v {200 * x / n:.4f} {200 * y / n:.4f} {6 * math.sin(2.5 * x / 9) * math.cos(2.5 * y / 11):.4f}\n")
    for c in (y * n + x + 1 for y in range(n - 1) for x in range(n - 1)):
        file.write(f"f {c} {c + 1} {c + n + 1} {c + n}\n")
END
    open "$BATS_TEST_TMPDIR/disk.obj"
    local began newer
    began=$(milliseconds)
    curl -sS -X PATCH -H 'Content-Type: application/merge-patch+json' -d '{"weights": {"stretch": 9}}' \
        -o "$BATS_TEST_TMPDIR/older" -w '%{http_code} %{time_total}' "$session?sequence=1" > "$BATS_TEST_TMPDIR/ended" &
    local older=$!
    sleep 0.1
    newer=$(milliseconds)
    change 2 '{"weights": {"compression": 2}}'
    assert_equal "$status $(jq -r .revision "$body")" "200 2"
    wait "$older"
    read -r code seconds < "$BATS_TEST_TMPDIR/ended" || true
    assert_equal "$code $(jq -r .code "$BATS_TEST_TMPDIR/older")" "409 superseded"
    echo "# dropped within $(awk "BEGIN {printf \"%d\", $began + 1000 * $seconds - $newer}") ms" >&3
    ask "$session"
    assert_equal "$(jq -c .request.weights "$body")" '{"compression":2}'
}

@test "the end of the service is the end of its sessions" {
    open "$last" "$request"
    local worker
    worker=$(cat /proc/"$server"/task/*/children)
    [[ -n ${worker// /} ]]
    kill -TERM "$server"
    wait_until 10 has_ended "$server"
    for process in $worker; do wait_until 10 has_ended "$process"; done
}
