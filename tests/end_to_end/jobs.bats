#!/usr/bin/env bats
# Jobs under load: waiting, canceling, deleting, ending.

load helper

setup_file() {
    require_program
    make_sample
    make_bumpy 330 "$BATS_FILE_TMPDIR/slow.obj"    # 216 000 triangles: most of a minute
    make_bumpy 260 "$BATS_FILE_TMPDIR/second.obj"  # 135 000 triangles: some seconds
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    slow=$BATS_FILE_TMPDIR/slow.obj
}
teardown() { stop_servers; }

@test "a job that has not ended has no result yet, and says when to ask again" {
    start_server --workers 1
    post "$slow"
    assert_equal "$(header Location)" "$job"
    assert_equal "$(header Retry-After)" 1
    running=$job
    wait_until 20 is_in_state "$running" running
    ask "$url$running/result"
    assert_problem 409 not_finished
    assert_equal "$(header Retry-After)" 1
    post "$sample/last.obj" "$sample/last.request.json"
    assert_equal "$(jq -c '[.state, .queue.position]' "$body")" '["queued",1]'
    ask "$url$job/result"
    assert_problem 409 not_finished
}

@test "a waiting job is canceled at once and never runs" {
    start_server --workers 1
    post "$slow"
    wait_until 20 is_in_state "$job" running
    post "$sample/last.obj" "$sample/last.request.json"
    ask -X POST "$url$job/cancel"
    assert_equal "$status $(jq -r .state "$body")" "200 canceled"
    jq -e 'has("started_at") | not' "$body"
    ask "$url$job/result"
    assert_problem 409 canceled
    ask -X POST "$url$job/cancel"
    assert_equal "$status $(jq -r .state "$body")" "200 canceled"
    assert_equal "$(curl -sS "$url/healthz" | jq .jobs.queued)" 0
}

@test "a running job stops within a second of being canceled" {
    start_server --workers 1
    post "$BATS_FILE_TMPDIR/second.obj"
    wait_until 20 is_in_state "$job" running
    begun=$(milliseconds)
    ask -X POST "$url$job/cancel"
    assert_equal "$status $(jq -r .state "$body")" "202 canceling"
    wait_until 20 is_in_state "$job" canceled
    taken=$(( $(milliseconds) - begun ))
    echo "# stopped after $taken ms (28 000 triangles)" >&3
    (( taken <= 1000 ))
    ask "$url$job/result"
    assert_problem 409 canceled
    # The worker is free again.
    flatten "$sample/last.obj" "$sample/last.request.json"
    ask -X POST "$url$job/cancel"
    assert_problem 409 already_finished
}

@test "a deleted job is gone, in whatever state it was" {
    start_server --workers 1
    flatten "$sample/last.obj" "$sample/last.request.json"
    finished=$job
    post "$slow"
    running=$job
    wait_until 20 is_in_state "$running" running
    post "$sample/last.obj"
    for path in "$finished" "$job" "$running"; do
        ask -X DELETE "$url$path"
        assert_equal "$status $(stat -c %s "$body" 2> "$BATS_TEST_TMPDIR/no_body" || echo 0)" "204 0"
        rm -f "$body"
        for gone in "$path" "$path/result"; do
            ask "$url$gone"
            assert_problem 404 job_not_found
        done
        ask -X DELETE "$url$path"
        assert_problem 404 job_not_found
        rm -f "$body"
    done
}

@test "a full queue turns jobs away and says when to come back" {
    start_server --workers 1 --queue 1
    post "$slow"
    running=$job
    wait_until 20 is_in_state "$running" running
    post "$sample/last.obj" "$sample/last.request.json"
    waiting=$job
    ask -F "model=@$sample/last.obj" "$url/v1/jobs"
    assert_problem 503 queue_full
    (( $(header Retry-After) > 0 ))
    assert_equal "$(curl -sS "$url/healthz" | jq -c .jobs)" '{"queued":1,"running":1}'
    ask -X DELETE "$url$running"
    wait_until 60 has_ended_job "$waiting"
    assert_equal "$(state "$waiting")" succeeded
    flatten "$sample/last.obj" "$sample/last.request.json"
}

@test "50 jobs of 8 clients all succeed and none is lost" {
    start_server
    flatten "$sample/last.obj" "$sample/last.request.json"
    curl -sSf "$url$job/result" -o "$BATS_TEST_TMPDIR/expected.json"
    begun=$(milliseconds)
    PYTHONPATH=$BATS_TEST_DIRNAME python3 - "$url" "$sample" "$BATS_TEST_TMPDIR/expected.json" <<'PYTHON'
import base64, concurrent.futures, json, sys, urllib.request
from eventually import eventually
url, sample, expected = sys.argv[1], sys.argv[2], json.load(open(sys.argv[3]))
model = base64.b64encode(open(sample + "/last.obj", "rb").read()).decode()
request = json.load(open(sample + "/last.request.json"))

def ask(path, body=None):
    headers = {"Content-Type": "application/json"} if body else {}
    with urllib.request.urlopen(urllib.request.Request(url + path, body, headers), timeout=60) as answer:
        return json.load(answer)

def one(number):
    tag = f"order-{number}"
    job = ask("/v1/jobs", json.dumps({"model": {"data": model}, "request": {**request, "tag": tag}}).encode())
    job = eventually(120, lambda: ask(job["links"]["self"]), lambda job: job["state"] not in ("queued", "running"))
    assert (job["state"], job["tag"]) == ("succeeded", tag), job
    result = ask(job["links"]["result"])
    assert result["regions"] == expected["regions"], tag
    return job["id"]

with concurrent.futures.ThreadPoolExecutor(8) as clients:
    ids = list(clients.map(one, range(50)))
assert len(set(ids)) == 50
assert ask("/healthz")["jobs"] == {"queued": 0, "running": 0}
PYTHON
    echo "# 50 jobs took $(( $(milliseconds) - begun )) ms" >&3
}

@test "health answers while the workers are busy and all connections are taken" {
    start_server --workers 1 --connections 2
    post "$slow"
    wait_until 20 is_in_state "$job" running
    # Two bodies that never come hold both connections.
    for descriptor in 5 6; do
        eval "exec $descriptor<> /dev/tcp/127.0.0.1/${url##*:}"
        printf 'POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n' >&$descriptor
    done
    wait_until 3 is_taken
    begun=$(milliseconds)
    ask --max-time 1 "$url/healthz"
    taken=$(( $(milliseconds) - begun ))
    echo "# health answered after $taken ms" >&3
    assert_equal "$status $(jq -c '[.status, .jobs.running]' "$body")" '200 ["ok",1]'
    is_taken  # still: so it was no luck
    exec 5>&- 6>&-
}
is_taken() { ! curl -s --max-time 0.3 "$url$job" -o "$BATS_TEST_TMPDIR/taken"; }

@test "SIGTERM ends the service with 0 while a job runs" {
    start_server --workers 1 --grace 0
    post "$BATS_FILE_TMPDIR/second.obj"
    wait_until 20 is_in_state "$job" running
    begun=$(milliseconds)
    kill -TERM "$server"
    wait_until 20 has_ended "$server"
    echo "# ended after $(( $(milliseconds) - begun )) ms" >&3
    run -0 wait "$server"
    run ! curl -sS "$url/healthz"
}

@test "SIGTERM lets a running job end within its grace, and ends with 0" {
    start_server --workers 1 --grace 60
    post "$BATS_FILE_TMPDIR/second.obj"
    wait_until 20 is_in_state "$job" running
    begun=$(milliseconds)
    kill -TERM "$server"
    wait_until 60 has_ended "$server"
    taken=$(( $(milliseconds) - begun ))
    echo "# ended after $taken ms" >&3
    (( taken > 500 ))  # the job takes seconds; cut short, it ends at once
    run -0 wait "$server"
}

@test "a long poll answers when the job changes, and with 304 when it does not" {
    start_server --workers 1 --connections 1
    post "$slow"
    wait_until 20 is_in_state "$job" running
    post "$sample/last.obj"  # waits behind it: nothing changes
    ask "$url$job"
    tag=$(header ETag)
    ask -H 'Prefer: wait=30' -H 'If-None-Match: W/"0"' "$url$job"  # another version: at once
    assert_equal "$status $(header Preference-Applied)" "200 wait=30"
    ask -H 'Prefer: wait=1' -H "If-None-Match: $tag" "$url$job"
    assert_equal "$status" 304
    exec 5<> "/dev/tcp/127.0.0.1/${url##*:}"
    printf 'GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nPrefer: wait=30\r\nIf-None-Match: %s\r\n\r\n' "$job" "$tag" >&5
    begun=$(milliseconds)
    ask -X POST "$url$job/cancel"  # served when the poll has left it the one connection, and waits
    timeout 30 cat <&5 | sed '1,/^\r$/d' > "$BATS_TEST_TMPDIR/polled"
    exec 5>&-
    (( $(milliseconds) - begun < 2000 ))
    assert_equal "$(jq -r .state "$BATS_TEST_TMPDIR/polled")" canceled
}

@test "Cancel-After ends a job that has not ended by then, and says so" {
    start_server --workers 1
    ask -H 'Cancel-After: 1s' -F "model=@$slow" "$url/v1/jobs"
    running=$(jq -r .links.self "$body")
    ask -H 'Cancel-After: 1s' -F "model=@$sample/last.obj" "$url/v1/jobs"
    waiting=$(jq -r .links.self "$body")
    wait_until 5 has_ended_job "$waiting"
    wait_until 5 has_ended_job "$running"
    for path in "$running" "$waiting"; do
        assert_equal "$(curl -sS "$url$path" | jq -c '[.state, .reason]')" '["canceled","deadline"]'
    done
}

@test "one last, many jobs: an asset is kept once and used by its id" {
    start_server
    ask --data-binary "@$sample/last.obj" "$url/v1/assets"
    assert_equal "$status" 201
    asset=$(jq -r .id "$body")
    assert_equal "$asset" "$(sha256sum < "$sample/last.obj" | cut -d' ' -f1)"
    ask --data-binary "@$sample/last.obj" "$url/v1/assets"
    assert_equal "$status" 200
    jq -n --arg asset "$asset" --slurpfile request "$sample/last.request.json" \
        '{jobs: [range(5) | {model: {asset_id: $asset}, request: ($request[0] + {tag: "size-\(.)"})}]}' > "$BATS_TEST_TMPDIR/batch"
    ask -H 'Content-Type: application/json' -H 'Idempotency-Key: series' --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
    assert_equal "$status $(jq -c '[.size, (.items | length)]' "$body")" "202 [5,5]"
    batch=$(jq -r .links.self "$body")
    ask -H 'Content-Type: application/json' -H 'Idempotency-Key: series' --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
    assert_equal "$(jq -r .links.self "$body")" "$batch"
    ask -X DELETE "$url/v1/assets/$asset"  # the jobs that use it keep it
    is_finished() { [[ $(curl -sS "$url$batch" | jq .finished) == true ]]; }
    wait_until 60 is_finished
    assert_equal "$(curl -sS "$url$batch" | jq -c .states)" '{"succeeded":5}'
    assert_equal "$(curl -sS "$url/v1/jobs?tag=size-3" | jq '.items | length')" 1
    assert_equal "$(find "$data/blobs" -type f | wc -l)" 5  # the results; the model is gone
}

@test "the same request on the same model is answered from what is there, as a job of its own" {
    start_server
    asset=$(curl -sS --data-binary "@$sample/last.obj" "$url/v1/assets" | jq -r .id)
    cache_control=max-age=60
    post() {  # REQUEST's filter, CURL_ARGUMENTS...
        jq -c --arg asset "$asset" "{model: {asset_id: \$asset}, request: (. + $1)}" "$sample/last.request.json" > "$BATS_TEST_TMPDIR/asked"
        ask -H 'Content-Type: application/json' -H 'Prefer: wait=60' "${@:2}" --data-binary "@$BATS_TEST_TMPDIR/asked" "$url/v1/jobs"
        assert_equal "$status $(jq -r .state "$body")" "200 succeeded"
    }
    post '{tag: "first"}'
    first=$(jq -r .links.self "$body")
    assert_equal "$(jq -c '[.cached, .attempt]' "$body")" '[null,1]'
    post '{tag: "second"}' -H 'Idempotency-Key: again'
    second=$(jq -r .links.self "$body")
    assert_equal "$(jq -c '[.cached, .attempt, .tag, has("started_at")]' "$body")" '[true,0,"second",false]'
    [[ $second != "$first" ]]
    cmp <(curl -sS "$url$first/result") <(curl -sS "$url$second/result")
    ask "$url$second/events"
    assert_equal "$(sed -n 's/^event: //p' "$body" | sort -u | xargs)" "done state"
    post '{tag: "second"}' -H 'Idempotency-Key: again'
    assert_equal "$(jq -r .links.self "$body") $(header Idempotent-Replayed)" "$second true"
    post '{draw: ["fan"]}'
    assert_equal "$(jq .cached "$body")" null
    cache_control=no-cache
    post '{}'
    assert_equal "$(jq .cached "$body")" null

    ask -X DELETE "$url$first"
    ask "$url$second/result"
    assert_equal "$status" 200

    # A model that was sent with what is answered is not kept; neither is that of a batch.
    cache_control=max-age=60
    for _ in 1 2; do ask -H 'Prefer: wait=60' -F "model=@$sample/last.glb" -F 'request={"units": "m"}' "$url/v1/jobs"; done
    assert_equal "$(jq .cached "$body")" true
    base64 -w0 "$sample/last.glb" | jq -Rc '{jobs: [{model: {data: .}, request: {units: "m"}}]}' > "$BATS_TEST_TMPDIR/batch"
    ask -H 'Content-Type: application/json' -H 'Prefer: wait=60' --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
    assert_equal "$(jq -c .states "$body")" '{"succeeded":1}'
    "$LASTFLAT" doctor --data "$data" | grep -q '(0 that nothing needs;'
}
