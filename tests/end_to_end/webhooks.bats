#!/usr/bin/env bats
# Webhooks: signed, repeated until they arrive, and never to where they must not go.

load helper

setup_file() {
    require_program
    make_sample
}
setup() { sample=$BATS_FILE_TMPDIR/sample; }
teardown() {
    [[ -z ${receiver:-} ]] || kill "$receiver"
    stop_servers
}

# start_receiver STATUS...: answers with each status in turn, the last for ever; writes what it got to $BATS_TEST_TMPDIR/got.
start_receiver() {
    python3 - "$BATS_TEST_TMPDIR" "$@" <<'PYTHON' &
import http.server, json, sys
folder, statuses = sys.argv[1], list(map(int, sys.argv[2:]))
class Handler(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"])).decode()
        with open(folder + "/got", "a") as got:
            got.write(json.dumps({"path": self.path, "headers": {k.lower(): v for k, v in self.headers.items()}, "body": body}) + "\n")
        self.send_response(statuses.pop(0) if len(statuses) > 1 else statuses[0])
        self.send_header("Location", "/elsewhere")
        self.end_headers()
        self.wfile.write(b"x" * 100000)
    def log_message(self, *_): pass
server = http.server.HTTPServer(("127.0.0.1", 0), Handler)
open(folder + "/port", "w").write(str(server.server_port))
server.serve_forever()
PYTHON
    receiver=$!
    wait_until 5 test -s "$BATS_TEST_TMPDIR/port"
    target=http://127.0.0.1:$(cat "$BATS_TEST_TMPDIR/port")/hook
}

register() {
    ask -H 'Content-Type: application/json' --data "{\"url\": \"$1\"}" "$url/v1/webhooks"
    assert_equal "$status" 201
    webhook=$(jq -r .id "$body") secret=$(jq -r .secret "$body")
}
got() { [[ $(wc -l < "$BATS_TEST_TMPDIR/got" 2> "$BATS_TEST_TMPDIR/none" || echo 0) -ge $1 ]]; }

# is_signed SECRET JOB: the first message tells of the job's success, and its signature is right.
is_signed() {
    python3 - "$BATS_TEST_TMPDIR/got" "$1" "$2" <<'PYTHON'
import base64, hashlib, hmac, json, sys, time
got, secret, job = json.loads(open(sys.argv[1]).readline()), sys.argv[2], sys.argv[3]
headers, body = got["headers"], got["body"]
signed = f'{headers["webhook-id"]}.{headers["webhook-timestamp"]}.{body}'.encode()
code = hmac.new(base64.b64decode(secret.removeprefix("whsec_")), signed, hashlib.sha256).digest()
assert headers["webhook-signature"] == "v1," + base64.b64encode(code).decode(), headers
assert abs(time.time() - int(headers["webhook-timestamp"])) < 60
assert headers["content-type"] == "application/json"
message = json.loads(body)
assert message["type"] == "job.succeeded" and message["data"]["id"] == job, message
PYTHON
}

@test "a finished job is told, signed so that the receiver can check it" {
    start_receiver 204
    start_server --webhooks any
    register "$target"
    flatten "$sample/last.obj" "$sample/last.request.json"
    wait_until 5 got 1
    is_signed "$secret" "${job##*/}"
    ask "$url/v1/webhooks/$webhook/deliveries"
    assert_equal "$(jq -c '[.items[0].delivered, .items[0].status, .items[0].attempt]' "$body")" '[true,204,1]'
    ask "$url/v1/webhooks"
    assert_equal "$(jq -c '[(.items | length), (.items[0] | has("secret"))]' "$body")" '[1,false]'
}

@test "a job that is answered from what is there is told, too" {
    start_receiver 204
    start_server --webhooks any
    flatten "$sample/last.obj" "$sample/last.request.json"
    register "$target"
    cache_control=max-age=60
    flatten "$sample/last.obj" "$sample/last.request.json"
    assert_equal "$(curl -sS "$url$job" | jq .cached)" true
    wait_until 5 got 1
    is_signed "$secret" "${job##*/}"
}

@test "a job may bring its own webhook, signed with the secret that it brings" {
    start_receiver 204
    start_server --webhooks any
    secret=whsec_$(head -c 32 /dev/urandom | base64)
    python3 - "$sample" "$target" "$secret" > "$BATS_TEST_TMPDIR/submission.json" <<'PYTHON'
import base64, json, sys
folder, target, secret = sys.argv[1:]
print(json.dumps({"model": {"data": base64.b64encode(open(folder + "/last.obj", "rb").read()).decode()},
                  "request": json.load(open(folder + "/last.request.json")), "webhook": {"url": target, "secret": secret}}))
PYTHON
    ask -H 'Content-Type: application/json' --data-binary "@$BATS_TEST_TMPDIR/submission.json" "$url/v1/jobs"
    assert_equal "$status" 202
    local own
    own=$(jq -r .id "$body")
    flatten "$sample/last.obj" "$sample/last.request.json"  # another job, that asks for no message
    wait_until 5 got 1
    is_signed "$secret" "$own"
    assert_equal "$(wc -l < "$BATS_TEST_TMPDIR/got")" 1
    ask "$url/v1/webhooks/$own/deliveries"
    assert_equal "$(jq -c '[.items[0].delivered, .items[0].event]' "$body")" '[true,"job.succeeded"]'
    ask -X DELETE "$url/v1/jobs/$own"
    ask "$url/v1/webhooks/$own"
    assert_equal "$status" 404
}

@test "what does not arrive is tried again with the same id, and the list says why" {
    start_receiver 500 204
    start_server --webhooks any
    register "$target"
    ask -X POST "$url/v1/webhooks/$webhook/test"
    assert_equal "$status" 202
    wait_until 5 got 1
    is_noted() { curl -sS "$url/v1/webhooks/$webhook/deliveries" | jq -e '.items[0].error and .items[0].next_attempt_at' > "$BATS_TEST_TMPDIR/noted"; }
    wait_until 5 is_noted
    wait_until 10 got 2
    assert_equal "$(jq -r '.headers["webhook-id"]' "$BATS_TEST_TMPDIR/got" | uniq | wc -l)" 1
}

@test "a redirect is not followed and is said" {
    start_receiver 302
    start_server --webhooks any
    register "$target"
    ask -X POST "$url/v1/webhooks/$webhook/test"
    is_noted() { curl -sS "$url/v1/webhooks/$webhook/deliveries" | jq -e '.items[0].error // "" | test("redirect")' > "$BATS_TEST_TMPDIR/noted"; }
    wait_until 5 is_noted
    assert_equal "$(jq -r .path "$BATS_TEST_TMPDIR/got")" /hook
}

@test "private addresses are refused when the connection is made, whatever name leads there" {
    start_receiver 204
    start_server --webhooks public
    for host in 127.0.0.1 localhost 0177.0.0.1 2130706433 '[::ffff:127.0.0.1]' 127.1; do
        register "${target/127.0.0.1/$host}"
        ask -X POST "$url/v1/webhooks/$webhook/test"
        is_noted() { curl -sS "$url/v1/webhooks/$webhook/deliveries" | jq -e '.items[0].error' > "$BATS_TEST_TMPDIR/noted"; }
        wait_until 10 is_noted
        ask -X DELETE "$url/v1/webhooks/$webhook"
        assert_equal "$status" 204
    done
    run ! got 1
}

@test "webhooks are off unless allowed, and their addresses are checked" {
    start_server
    ask -H 'Content-Type: application/json' --data '{"url": "https://example.com/"}' "$url/v1/webhooks"
    assert_problem 403 webhooks_off
    start_server --webhooks public
    for wrong in 'ftp://example.com/' 'file:///etc/passwd' 'nonsense' 'http://user:word@example.com/' 'gopher://x/'; do
        ask -H 'Content-Type: application/json' --data "{\"url\": \"$wrong\"}" "$url/v1/webhooks"
        assert_problem 422 invalid_request /url
    done
    ask -H 'Content-Type: application/json' --data '{"url": "https://example.com/", "events": ["job.done"]}' "$url/v1/webhooks"
    assert_problem 422 invalid_request /events/0
}
