#!/usr/bin/env bats
# The service behind a real nginx with the configuration that we recommend.

load helper
BEHIND_PROXY=yes

setup_file() {
    require_program
    make_sample
    make_bumpy 260 "$BATS_FILE_TMPDIR/slow.obj"
}
setup() {
    command -v nginx > "$BATS_TEST_TMPDIR/nginx" || skip "nginx is not installed"
    sample=$BATS_FILE_TMPDIR/sample
    DATA=$BATS_TEST_TMPDIR/data
    key=$("$LASTFLAT" keys add test --data "$DATA" 2> "$BATS_TEST_TMPDIR/said")
    start_server --workers 1
    backend=$url
    export CURL_HOME=$BATS_TEST_TMPDIR  # every curl of these tests sends the key
    echo "header = \"Authorization: Bearer $key\"" > "$CURL_HOME/.curlrc"
    port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
    folder=$BATS_TEST_TMPDIR
    {
        [[ $(id -u) != 0 ]] || echo "user root;"  # or it could not use the temporary folders of the test
        echo "pid $folder/pid; error_log $folder/error.log; worker_processes 1; daemon on;"
        echo "events { worker_connections 1024; }"
        echo "http { access_log off;"
        for kind in client_body proxy fastcgi uwsgi scgi; do echo "${kind}_temp_path $folder/$kind;"; done
        sed -e "s/127.0.0.1:8080/${backend#http://}/" -e "s/listen 80;/listen 127.0.0.1:$port;/" \
            -e "s,/var/log/nginx,$folder," -e 's/client_max_body_size 256m/client_max_body_size 12m/' "$BATS_TEST_DIRNAME/../../server/deploy/nginx.conf"
        echo "}"
    } > "$folder/nginx.conf"
    nginx -q -c "$folder/nginx.conf" -p "$folder" 2> "$folder/said" || { cat "$folder/said" >&2; return 1; }
    url=http://127.0.0.1:$port
}
teardown() {
    [[ ! -e $BATS_TEST_TMPDIR/pid ]] || kill "$(cat "$BATS_TEST_TMPDIR/pid")"
    stop_servers
}

@test "jobs, results, long polls and events pass through" {
    flatten "$sample/last.obj" "$sample/last.request.json"
    token=$(curl -sSf -H 'Content-Type: application/json' --data "{\"scope\": \"job:${job##*/}\"}" "$url/v1/tokens" | jq -r .token)
    CURL_HOME=/ curl -sSf "$url$job/result.svg?token=$token" | grep -q '<svg'
    grep -q "GET $job/result.svg\" 200" "$folder/lastflat.log"
    ! grep -qF "$token" "$folder/lastflat.log"
    curl -sSf "$url$job/result" -o "$BATS_TEST_TMPDIR/there"
    curl -sSf "$backend$job/result" | cmp - "$BATS_TEST_TMPDIR/there"
    ask -H 'Prefer: wait=30' -F "model=@$sample/last.obj" -F "request=@$sample/last.request.json" "$url/v1/jobs"
    assert_equal "$status $(jq -r .state "$body")" "200 succeeded"
    post "$BATS_FILE_TMPDIR/slow.obj"
    curl -sSN "$url$job/events" > "$BATS_TEST_TMPDIR/events" &
    wait_until 5 grep -q '^event: progress' "$BATS_TEST_TMPDIR/events"  # before the job has ended: nothing is buffered
    is_in_state "$job" running
    ask -X DELETE "$url$job"
    wait $!
    grep -q '^event: deleted' "$BATS_TEST_TMPDIR/events"
}

@test "without a key nobody is served through the proxy" {
    rm "$CURL_HOME/.curlrc"
    ask "$url/v1/jobs"
    assert_problem 401 key_missing
    stop_servers
    DATA=$BATS_TEST_TMPDIR/open
    start_server
    ask -H 'X-Forwarded-For: 203.0.113.9' "$url/v1/jobs"
    assert_problem 401 no_keys
    ask "$url/v1/jobs"
    assert_equal "$status" 200
}

@test "what is too large, ambiguous or broken does not reach the service" {
    head -c 20000000 /dev/zero > "$BATS_TEST_TMPDIR/large"
    ask -H 'Content-Type: model/obj' --data-binary "@$BATS_TEST_TMPDIR/large" "$url/v1/jobs"
    assert_equal "$status" 413
    ask -H 'Content-Type: model/obj' -H 'Transfer-Encoding: chunked' --data-binary "@$BATS_TEST_TMPDIR/large" "$url/v1/jobs"
    assert_equal "$status" 413
    ask -H 'Content-Encoding: gzip' --data-binary "@$sample/last.obj" "$url/v1/jobs"
    assert_problem 415 content_encoding_not_supported
    for head in 'GET /healthz HTTP/1.1\r\n\r\n' 'POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n' \
        'POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nContent-Length: 5\r\n\r\n'; do
        exec 4<> "/dev/tcp/127.0.0.1/${url##*:}"
        printf "$head" >&4
        assert_equal "$(timeout 5 head -n 1 <&4 | cut -d' ' -f2)" 400
        exec 4>&-
    done
    ask "$url/healthz"
    assert_equal "$status" 200
}

@test "slow heads and idle connections do not keep others out" {
    local held connection
    for (( held = 0; held < 60; ++held )); do
        exec {connection}<> "/dev/tcp/127.0.0.1/$port"
        printf 'GET / HTTP/1.1\r\nX: ' >&"$connection"
    done
    ask --max-time 1 "$url/healthz"  # accepted after them: connections are accepted in their order
    assert_equal "$status" 200
    run ! read -r -t 0 -u "$connection"  # nginx still has the last of them: it has not made room
}
