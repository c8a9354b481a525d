#!/usr/bin/env bats
# What lasts: jobs, results and keys across starts, ends and accidents.

load helper

setup_file() {
    require_program
    make_sample
    make_bumpy 330 "$BATS_FILE_TMPDIR/slow.obj"  # 216 000 triangles: many seconds
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    slow=$BATS_FILE_TMPDIR/slow.obj
    DATA=$BATS_TEST_TMPDIR/data
}
teardown() { stop_servers; }

@test "jobs and results outlive the service, and what was cut off runs again" {
    start_server --workers 1
    flatten "$sample/last.obj" "$sample/last.request.json"
    finished=$job
    curl -sSf "$url$finished/result" -o "$BATS_TEST_TMPDIR/before"
    post "$slow"
    running=$job
    wait_until 20 is_in_state "$running" running
    post "$sample/last.obj" "$sample/last.request.json"
    waiting=$job
    worker=$(pgrep -P "$server")
    kill -KILL "$server"
    wait_until 5 has_ended "$worker"  # no worker outlives the service
    start_server --workers 1
    curl -sSf "$url$finished/result" | cmp - "$BATS_TEST_TMPDIR/before"
    wait_until 5 is_in_state "$running" running
    assert_equal "$(curl -sS "$url$running" | jq .attempt)" 2
    ask -X DELETE "$url$running"
    wait_until 60 has_ended_job "$waiting"
    assert_equal "$(state "$waiting")" succeeded
    "$LASTFLAT" doctor --data "$data"
}

@test "SIGTERM gives running jobs back to the queue without counting the attempt" {
    start_server --workers 1 --grace 0
    post "$slow"
    wait_until 20 is_in_state "$job" running
    curl -sSN "$url$job/events" > "$BATS_TEST_TMPDIR/events" &
    stream=$!
    wait_until 5 grep -q '^event: progress' "$BATS_TEST_TMPDIR/events"
    kill -TERM "$server"
    wait "$server"
    wait "$stream"
    grep -q '^event: shutdown' "$BATS_TEST_TMPDIR/events"
    assert_equal "$("$LASTFLAT" jobs --data "$data" | awk '{print $3, $5}')" "queued 0"
}

@test "while it ends it takes no jobs, is not ready, and still answers" {
    start_server --workers 1 --grace 60 --admin 127.0.0.1:0
    admin=$(sed -n 's/^admin on //p' "$BATS_TEST_TMPDIR"/server.*.out)
    assert_equal "$(curl -sS "$admin/readyz" | jq -r .status)" ready
    post "$slow"
    wait_until 20 is_in_state "$job" running
    kill -TERM "$server"
    is_draining() { [[ $(curl -sS -o "$BATS_TEST_TMPDIR/ready" -w '%{http_code}' "$admin/readyz") == 503 ]]; }
    wait_until 5 is_draining
    ask -F "model=@$sample/last.obj" "$url/v1/jobs"
    assert_problem 503 draining
    is_in_state "$job" running
    ask -X POST "$url$job/cancel"
    assert_equal "$status" 202
    wait "$server"
}

@test "one process at a time has the data" {
    start_server
    run -1 "$LASTFLAT" serve --listen 127.0.0.1:0 --data "$data"
    [[ $output == *"another process serves from"* ]]
}

@test "a worker that crashes fails its job alone" {
    start_server --workers 1
    post "$slow"
    wait_until 20 is_in_state "$job" running
    kill -SEGV "$(pgrep -P "$server")"
    wait_until 5 has_ended_job "$job"
    assert_equal "$(curl -sS "$url$job" | jq -r .error.code)" worker_crashed
    flatten "$sample/last.obj" "$sample/last.request.json"
}

@test "a job that takes too long, or too much memory, fails and says which limit" {
    start_server --workers 1 --job-time 1s
    post "$slow"
    wait_until 10 has_ended_job "$job"
    assert_equal "$(curl -sS "$url$job" | jq -r .error.code)" job_too_slow
    curl -sS "$url$job" | jq -r .error.detail | grep -q -- --job-time
    [[ -z ${LASTFLAT_SANITIZE:-} ]] || return 0  # sanitizers map terabytes
    stop_servers
    start_server --workers 1 --job-memory-mb 64
    post "$slow"
    wait_until 20 has_ended_job "$job"
    assert_equal "$(curl -sS "$url$job" | jq -r .error.code)" out_of_memory
}

@test "a result that went bad on the disk is never sent, and the doctor finds it" {
    start_server
    flatten "$sample/last.obj" "$sample/last.request.json"
    blob=$(find "$data/blobs" -type f)
    printf 'x' | dd of="$blob" bs=1 seek=1000 conv=notrunc status=none
    ask "$url$job/result?format=json"
    assert_problem 500 result_corrupt
    run -2 "$LASTFLAT" doctor --data "$data"
    [[ $output == *"${job##*/}"* ]]
}

@test "a model that went bad on the disk makes a failed job, not a wrong one" {
    start_server --workers 1
    post "$slow"
    post "$sample/last.obj"
    printf 'x' | dd of="$data/blobs/$(sha256sum < "$sample/last.obj" | sed -E 's,^(..)(\S+).*,\1/\2,')" bs=1 seek=10 conv=notrunc status=none
    ask -X DELETE "$url/v1/jobs/$("$LASTFLAT" jobs --data "$data" --state running | cut -d' ' -f1)"
    wait_until 20 has_ended_job "$job"
    assert_equal "$(curl -sS "$url$job" | jq -r .error.code)" model_lost
}

@test "a disk that may not be written to is named at the start" {
    mkdir -p "$BATS_TEST_TMPDIR/fixed"
    mount -t tmpfs -o size=1m,ro tmpfs "$BATS_TEST_TMPDIR/fixed" 2> "$BATS_TEST_TMPDIR/mount" || skip "no right to mount a disk"
    run "$LASTFLAT" serve --listen 127.0.0.1:0 --data "$BATS_TEST_TMPDIR/fixed/data"
    umount "$BATS_TEST_TMPDIR/fixed"
    [[ $status -ne 0 && $output == *"$BATS_TEST_TMPDIR/fixed/data"* ]]
    [[ $output != *terminate* ]]
}

@test "a full disk refuses jobs, loses none, and the work goes on when there is room" {
    mkdir "$BATS_TEST_TMPDIR/small"
    mount -t tmpfs -o size=10m tmpfs "$BATS_TEST_TMPDIR/small" 2> "$BATS_TEST_TMPDIR/mount" || skip "no right to mount a small disk"
    DATA=$BATS_TEST_TMPDIR/small/data
    start_server --workers 1 --min-free-mb 4
    ask -F "model=@$sample/last.glb" "$url/v1/jobs"
    assert_equal "$status" 202
    wait_until 20 has_ended_job "$(header location)"
    dd if=/dev/zero of="$BATS_TEST_TMPDIR/small/ballast" bs=1k count=7000 2> "$BATS_TEST_TMPDIR/dd"
    ask -F "model=@$sample/last.glb" "$url/v1/jobs"
    assert_problem 507 storage_full
    rm "$BATS_TEST_TMPDIR/small/ballast"
    stop_servers
    start_server --workers 1 --min-free-mb 0
    flatten "$sample/last.obj" "$sample/last.request.json"
    first=$job
    dd if=/dev/zero of="$BATS_TEST_TMPDIR/small/ballast" bs=1k 2> "$BATS_TEST_TMPDIR/dd" || true
    ask -F "model=@$sample/last.glb" "$url/v1/jobs"
    assert_problem 503 store_unavailable
    truncate -s "$(( $(stat -c %s "$BATS_TEST_TMPDIR/small/ballast") - 700000 ))" "$BATS_TEST_TMPDIR/small/ballast"
    post "$sample/last.obj" "$sample/last.request.json"  # room for the job, not for its result
    wait_until 20 grep -q "\"job\":\"${job##*/}\".*\"outcome\":\"queued\".*No space left" "$BATS_TEST_TMPDIR"/server.*.err
    [[ $(state "$job") =~ ^(queued|running)$ ]]
    rm "$BATS_TEST_TMPDIR/small/ballast"
    wait_until 20 has_ended_job "$job"
    assert_equal "$(state "$job") $(curl -sS "$url$first/result" | jq '.regions | length')" "succeeded 2"
    stop_servers
    "$LASTFLAT" doctor --data "$DATA"
    umount "$BATS_TEST_TMPDIR/small"
}
