"""Services with other settings than the default's: keys, little room, webhooks, short retention."""

import base64
import json
import pathlib
import signal
import subprocess
import tempfile

from contract_service import Server, Walk, bumpy_disk
from eventually import eventually


def walk_keys(program, contract, example):
    """A service with keys: 401, 429, and what one key sees of another."""
    with tempfile.TemporaryDirectory() as folder:
        keys = [subprocess.run([program, "keys", "add", name, "--data", folder], check=True, capture_output=True,
                               text=True).stdout.strip() for name in ("one", "two", "three")]
        server = Server(program, "--rate", "170", "--session-rate", "10", "--queue-per-key", "2", "--workers", "1", "--streams", "4", "--data", folder)
        try:
            nobody = Walk(server, contract)
            one, two, three = (Walk(server, contract, ["Authorization: Bearer " + key]) for key in keys)
            for method, path, operation in contract.operations():
                if "401" in operation["responses"]:
                    nobody.expect(401, "key_missing" if method != "HEAD" else None, method, path)
            Walk(server, contract, ["Authorization: Bearer " + keys[0] + "0"]).expect(401, "key_unknown", "GET", "/v1/jobs")
            id = one.post(base64.b64decode(example["model"]["data"]), example["request"])
            one.wait_for(id, "succeeded")
            walk_tokens(one, nobody, id)
            two.expect(404, "job_not_found", "GET", "/v1/jobs/{id}", id=id)
            two.expect(404, "job_not_found", "DELETE", "/v1/jobs/{id}", id=id)
            assert two.expect(200, None, "GET", "/v1/jobs")["items"] == []
            slow = bumpy_disk(200)
            one.wait_for(one.post(slow), "running")
            for _ in range(2):
                one.post(slow)
            one.expect(429, "key_queue_full", "POST", "/v1/jobs", body=slow)
            # One key's half of the places to wait: the other key still gets its own.
            waiting = one.expect(200, None, "GET", "/v1/jobs", query="?state=queued")["items"][0]["id"]
            streams = [server.open(f"GET /v1/jobs/{waiting}/events HTTP/1.1\r\nHost: localhost\r\n{one.headers[0]}\r\n\r\n".encode()) for _ in range(2)]
            for stream in streams:
                stream.recv(100)
            one.expect(503, "streams_full", "GET", "/v1/jobs/{id}/events", id=waiting)
            two.post(slow)
            for _ in range(180):
                three.ask("GET", "/v1/jobs/{id}")
            for _ in range(12):
                three.ask("GET", "/v1/sessions/{id}")
            for method, path, operation in contract.operations():
                if "429" in operation["responses"]:
                    three.expect(429, "rate_exceeded" if method != "HEAD" else None, method, path)
            other = two.expect(200, None, "GET", "/v1/jobs")["items"][0]["id"]
            with server.open(f"GET /v1/jobs/{other}/events HTTP/1.1\r\nHost: localhost\r\n{two.headers[0]}\r\n\r\n".encode()) as stream:
                assert b" 200 " in stream.recv(100)
            for stream in streams:
                stream.close()
            subprocess.run([program, "keys", "revoke", keys[1].split("_")[1], "--data", folder], check=True)
            two.expect(401, "key_unknown", "GET", "/v1/jobs")
        finally:
            server.stop()


def walk_tokens(one, nobody, id):
    """A token is made, used in both places, and good for what it is for alone."""
    make = lambda status, code, body, walk=one: walk.expect(
        status, code, "POST", "/v1/tokens", headers=["Content-Type: application/json"], body=json.dumps(body).encode())
    token = make(201, None, {"scope": "job:" + id, "expires_in_s": 60})["token"]
    paths = ["result", "result.json", "result.svg", "result.png", "result.glb", "result.obj", "metrics", "events"]
    for method in ("GET", "HEAD"):
        for path in paths:
            nobody.expect(200, None, method, "/v1/jobs/{id}/" + path, id=id, query="?token=" + token)
            nobody.expect(401, "token_invalid" if method == "GET" else None, method, "/v1/jobs/{id}/" + path, id=id, query="?token=x")
    holder = Walk(one.server, one.contract, ["Authorization: bearer " + token])
    holder.expect(200, None, "GET", "/v1/jobs/{id}", id=id)
    holder.expect(403, "scope_refused", "GET", "/v1/jobs")
    make(403, "scope_refused", {"scope": "submit"}, holder)
    for scope in ("", "all", "job:" + id + "0", "job:", "asset:" + id):
        make(422, "invalid_request", {"scope": scope})
    make(422, "invalid_request", {})
    make(422, "invalid_request", {"scope": "submit", "expires_in_s": 86401})
    make(422, "invalid_request", {"scope": "submit", "origins": ["shop.example"]})
    one.expect(415, "media_type_unsupported", "POST", "/v1/tokens", body=b"{}")
    page = make(201, None, {"scope": "submit", "origins": ["https://shop.example"]})["token"]
    nobody.expect(403, "origin_refused", "POST", "/v1/jobs", headers=["Authorization: Bearer " + page], body=b"v 0 0 0\n")


def walk_webhooks(program, contract, example):
    """Making, testing, seeing and dropping webhooks; what is sent is looked at by webhooks.bats."""
    json_type = "Content-Type: application/json"
    hook = b'{"url": "http://127.0.0.1:9/", "events": ["job.failed"]}'
    server = Server(program)
    try:
        walk = Walk(server, contract)
        walk.expect(403, "webhooks_off", "POST", "/v1/webhooks", headers=[json_type], body=hook)
        walk.expect(403, "webhooks_off", "POST", "/v1/webhooks/{id}/test")
        submission = json.dumps({**example, "webhook": {"url": "http://127.0.0.1:9/", "secret": "whsec_" + "A" * 32}}).encode()
        own = "0f8fad5b-d9cb-469f-a165-70867728950e"
        walk.expect(403, "webhooks_off", "POST", "/v1/jobs", headers=[json_type], body=submission)
        walk.expect(403, "webhooks_off", "PUT", "/v1/jobs/{id}", id=own, headers=[json_type], body=submission)
    finally:
        server.stop()
    server = Server(program, "--webhooks", "public")
    try:
        walk = Walk(server, contract)
        id = walk.expect(201, None, "POST", "/v1/webhooks", headers=[json_type], body=hook)["id"]
        walk.expect(202, None, "POST", "/v1/webhooks/{id}/test", id=id)
        eventually(10, lambda: walk.expect(200, None, "GET", "/v1/webhooks/{id}/deliveries", id=id)["items"],
                   lambda sent: sent[0].get("error"))
        walk.expect(202, None, "PUT", "/v1/jobs/{id}", id=own, headers=[json_type], body=submission)
        walk.wait_for(own, "succeeded")
        assert walk.expect(200, None, "GET", "/v1/webhooks/{id}/deliveries", id=own)["items"][0]["event"] == "job.succeeded"
        assert len(walk.expect(200, None, "GET", "/v1/webhooks")["items"]) == 1
        walk.expect(409, "id_taken", "PUT", "/v1/jobs/{id}", id=id, headers=[json_type], body=submission)
        walk.expect(422, "invalid_request", "POST", "/v1/jobs", headers=[json_type],
                    body=submission.replace(b"whsec_", b"secret"))
        walk.expect(415, "media_type_unsupported", "POST", "/v1/webhooks", body=hook)
        walk.expect(422, "invalid_request", "POST", "/v1/webhooks", headers=[json_type], body=b'{"url": "ftp://x/"}')
        for _ in range(15):
            walk.expect(201, None, "POST", "/v1/webhooks", headers=[json_type], body=hook)
        walk.expect(422, "too_many_webhooks", "POST", "/v1/webhooks", headers=[json_type], body=hook)
        for method in ("GET", "HEAD"):
            walk.expect(200, None, method, "/v1/webhooks")
            for path in ("/v1/webhooks/{id}", "/v1/webhooks/{id}/deliveries"):
                walk.expect(200, None, method, path, id=id)
                walk.expect(404, "webhook_not_found" if method == "GET" else None, method, path)
        walk.expect(404, "webhook_not_found", "POST", "/v1/webhooks/{id}/test")
        walk.expect(204, None, "DELETE", "/v1/webhooks/{id}", id=id)
        walk.expect(404, "webhook_not_found", "DELETE", "/v1/webhooks/{id}", id=id)
    finally:
        server.stop()


def walk_room(program, contract):
    """Assets without end, and a disk without room."""
    server = Server(program, "--assets-per-key-mb", "1")
    try:
        walk = Walk(server, contract)
        model = b"v 0 0 0\n" * 75_000
        walk.expect(201, None, "POST", "/v1/assets", body=model)
        walk.expect(507, "assets_full", "POST", "/v1/assets", body=b"#" + model)
        assert len(walk.expect(200, None, "GET", "/v1/assets")["items"]) == 1
    finally:
        server.stop()
    server = Server(program, "--min-free-mb", str(1 << 24))
    try:
        walk = Walk(server, contract)
        walk.expect(507, "storage_full", "POST", "/v1/jobs", body=b"v 0 0 0\n")
        walk.expect(507, "storage_full", "PUT", "/v1/jobs/{id}", id="0f8fad5b-d9cb-469f-a165-70867728950e", body=b"v 0 0 0\n")
        walk.expect(507, "storage_full", "POST", "/v1/assets", body=b"v 0 0 0\n")
        walk.expect(507, "storage_full", "POST", "/v1/sessions", body=b"v 0 0 0\n")
    finally:
        server.stop()


def walk_expiry(program, contract, example):
    """A service that keeps results for a second and jobs for two."""
    server = Server(program, "--keep-results", "1s", "--keep-jobs", "3s", "--streams", "0")
    try:
        walk = Walk(server, contract)
        id = walk.post(base64.b64decode(example["model"]["data"]), example["request"])
        for method in ("GET", "HEAD"):
            walk.expect(503, "streams_full" if method == "GET" else None, method, "/v1/jobs/{id}/events", id=id)
        is_gone = lambda answer: answer[0] == 410
        answer = eventually(10, lambda: walk.ask("GET", "/v1/jobs/{id}/result", id=id), is_gone)
        assert answer[1]["code"] == "result_expired", answer
        eventually(10, lambda: walk.ask("GET", "/v1/jobs/{id}", id=id), is_gone)
        for method, path, operation in contract.operations():
            if "410" in operation["responses"] and path.startswith("/v1/jobs"):
                walk.expect(410, "job_expired" if method != "HEAD" else None, method, path, id=id)
    finally:
        server.stop()


def walk_busy(program, contract):
    """A service all of whose threads and places to wait for one are taken: 503 before any handler."""
    server = Server(program)
    try:
        walk = Walk(server, contract)
        half_sent = b"POST /v1/assets HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 9\r\n\r\n"
        asked = b"GET /v1/jobs HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        held, waiting = [], []
        for client in ("127.0.0.2", "127.0.0.3"):  # each has half of the threads, and half of the places to wait
            own = [server.open(half_sent, client) for _ in range(32)]
            for connection in own:  # a thread that asks for the body has nothing else to do until it comes
                answer = connection.recv(100)
                assert answer.startswith(b"HTTP/1.1 100 "), answer
            held += own
            # One more than one client has places: when it is refused, the others have theirs.
            own = [server.open(asked, client) for _ in range(129)]
            refused = server.first_answered(own)
            answer = contract.check("GET", "/v1/jobs", server.read(refused))
            assert answer.get("code") == ("server_busy" if waiting else "client_busy"), answer
            waiting += [one for one in own if one is not refused]
        refused = server.open(asked)
        answer = contract.check("GET", "/v1/jobs", server.read(refused))
        assert answer.get("code") == "server_busy", answer
        for method, path, operation in contract.operations():
            if "503" in operation["responses"]:
                if path == "/healthz" and method != "OPTIONS":  # has threads of its own
                    walk.expect(200, None, method, path)
                else:
                    walk.expect(503, "server_busy" if method != "HEAD" else None, method, path)
        for connection in held + waiting:
            connection.close()
        # Even they can be outrun, by hundreds of requests that arrive as one; not every time.
        for method in ("GET", "HEAD") * 10:
            if (method, "/healthz", 503) in contract.seen:
                continue
            server.process.send_signal(signal.SIGSTOP)
            asked = [server.open(f"{method} /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode()) for _ in range(400)]
            server.process.send_signal(signal.SIGCONT)
            for connection in asked:
                contract.check(method, "/healthz", server.read(connection))
    finally:
        server.stop()


def walk_broken(program, contract, example):
    """Bytes that have changed on the disk are never handed out."""
    server = Server(program)
    try:
        walk = Walk(server, contract)
        model = base64.b64decode(example["model"]["data"])
        asset = walk.expect(201, None, "POST", "/v1/assets", body=b"# an asset\n" + model)["id"]
        own = "0f8fad5b-d9cb-469f-a165-70867728950e"
        submitted = {"headers": ["Prefer: wait=30", 'Idempotency-Key: "k"'], "body": model}
        id = walk.expect(200, None, "POST", "/v1/jobs", **submitted)["id"]
        walk.expect(200, None, "PUT", "/v1/jobs/{id}", id=own, **submitted)
        for blob in pathlib.Path(server.folder.name, "blobs").glob("*/*"):
            blob.write_bytes(bytes(blob.stat().st_size))
        to_map = {"id": id, "headers": ["Content-Type: application/json"], "body": b'{"to_last": {"region": "r", "points": [[0, 0]]}}'}
        special = {"POST /v1/jobs": submitted, "PUT /v1/jobs/{id}": {"id": own, **submitted}, "POST /v1/jobs/{id}/map": to_map,
                   "POST /v1/sessions": {"query": "?asset_id=" + asset, "body": b""},
                   "POST /v1/validate": {"query": "?asset_id=" + asset, "body": b""}}
        for method, path, operation in contract.operations():
            if "500" in operation["responses"]:
                walk.expect(500, "result_corrupt" if method != "HEAD" else None, method, path,
                            **special.get(f"{method} {path}", {"id": id}))
    finally:
        server.stop()
