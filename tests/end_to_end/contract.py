#!/usr/bin/env python3
"""Holds a running server against api/openapi.json.

    LASTFLAT=build/release/lastflat tests/end_to_end/contract.py
    tests/end_to_end/contract.py --answers FOLDER     (answers that other tests have kept)

Starts a server, provokes every path, method and status that it can, and validates every answer: status declared, headers
declared, present and well-formed, content type declared, body as its schema says. Ends with 1 if an answer breaks the
contract or a declared operation was never exercised; lists the declared statuses that it could not provoke. Without
python3-jsonschema it says so and ends with 77 (skipped).
"""

import base64
import hashlib
import json
import math
import os
import pathlib
import re
import select
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: python3-jsonschema 4 or later is not installed")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
NO_JOB = "0" * 26
NO_ASSET = "0" * 64


def path_of(path, id):
    return path.replace("{id}", id).replace("{digest}", id if len(id) == 64 else NO_ASSET)
TYPES = {"json": "application/json", "svg": "image/svg+xml", "glb": "model/gltf-binary", "obj": "model/obj"}


class Contract:
    """The document, and which of its answers were seen."""

    def __init__(self, document):
        self.document = document
        self.seen = set()
        self.faults = []
        self.validators = {}

    def resolve(self, node):
        while "$ref" in node:
            target = self.document
            for name in node["$ref"][2:].split("/"):
                target = target[name]
            node = target
        return node

    def operations(self):
        for path, item in self.document["paths"].items():
            for method in ("get", "head", "post", "put", "patch", "delete", "options"):
                if method in item:
                    yield method.upper(), path, item[method]

    def declared(self):
        return {(m, p, int(status)) for m, p, o in self.operations() for status in o["responses"]}

    def complain(self, where, what):
        self.faults.append(f"{where}: {what}")
        print(f"FAULT {where}: {what}")

    def check_value(self, where, schema, value):
        key = json.dumps(schema, sort_keys=True)
        if key not in self.validators:
            self.validators[key] = Draft202012Validator({**schema, "components": self.document["components"]})
        for error in list(self.validators[key].iter_errors(value))[:3]:
            self.complain(where, f"/{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")

    def check(self, method, path, answer):
        """Validates one answer to a declared operation, or to a method or path that is none."""
        status, headers, body = answer
        where = f"{method} {path} {status}"
        item = self.document["paths"].get(path, {})
        if method.lower() in item:
            self.seen.add((method, path, status))
            response = item[method.lower()]["responses"].get(str(status))
            if response is None:
                return self.complain(where, f"this status is not declared: {body[:200]!r}")
        else:
            name = "MethodNotAllowed" if item else "NotFound"
            response = {"$ref": "#/components/responses/" + name}
            if status != (405 if item else 404):
                return self.complain(where, "expected 405 for a method, 404 for a path that is not declared")
        response = self.resolve(response)
        self.check_headers(where, response.get("headers", {}), headers)
        content = response.get("content")
        if not content:
            if body:
                self.complain(where, f"a body that is not declared: {body[:200]!r}")
            return headers
        media_type = headers.get("content-type", "").split(";")[0]
        if media_type not in content:
            return self.complain(where, f"the content type {media_type!r} is not declared")
        if media_type.endswith("json"):
            value = json.loads(body)
            self.check_value(where, content[media_type]["schema"], value)
            if media_type == "application/problem+json" and value["status"] != status:
                self.complain(where, f"the problem says {value['status']}")
            return value
        return body

    def check_headers(self, where, declared, headers):
        for name, header in declared.items():
            header = self.resolve(header)
            value = headers.get(name.lower())
            if value is None:
                if header.get("required"):
                    self.complain(where, f"the header {name} is missing")
                continue
            if header["schema"].get("type") == "integer":
                value = int(value)
            self.check_value(f"{where}, header {name}", header["schema"], value)
        for name in headers:
            if name not in {n.lower() for n in declared} | {"content-type"}:
                self.complain(where, f"the header {name} is not declared")

    def check_itself(self):
        """Every reference leads somewhere; every example is what its schema says."""
        def walk(node, where):
            if isinstance(node, dict):
                if "$ref" in node:
                    self.resolve(node)
                if isinstance(node.get("schema"), dict) and isinstance(node.get("examples"), dict):
                    for name, example in node["examples"].items():
                        self.check_value(f"example {where}/{name}", node["schema"], example["value"])
                for name, child in node.items():
                    walk(child, f"{where}/{name}")
            elif isinstance(node, list):
                for i, child in enumerate(node):
                    walk(child, f"{where}/{i}")
        walk(self.document, "")
        for name, schema in self.document["components"]["schemas"].items():
            Draft202012Validator.check_schema(schema)
            for example in schema.get("examples", []):
                self.check_value(f"example of {name}", {"$ref": f"#/components/schemas/{name}"}, example)


def unchunked(body):
    """The content of a chunked body; a body that breaks off raises."""
    content = b""
    while True:
        size, _, body = body.partition(b"\r\n")
        if int(size, 16) == 0:
            return content
        content, body = content + body[:int(size, 16)], body[int(size, 16) + 2:]


class Server:
    def __init__(self, program, *flags):
        self.folder = tempfile.TemporaryDirectory()
        if "--data" not in flags:
            flags = ("--data", self.folder.name, *flags)
        self.process = subprocess.Popen([program, "serve", "--listen", "127.0.0.1:0", *flags], stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        assert select.select([self.process.stdout], [], [], 10)[0], "the server does not start"
        line = self.process.stdout.readline()
        assert line.startswith("listening on http://"), f"the server does not start: {line!r}"
        self.port = urllib.parse.urlsplit(line.split()[-1]).port

    def stop(self):
        self.process.kill()
        self.process.wait()
        self.folder.cleanup()

    def open(self, data):
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=60)
        connection.sendall(data)
        return connection

    @staticmethod
    def read(connection):
        """The answer that is there when the server closes: status, headers in lower case, body."""
        data = b""
        with connection:
            while step := connection.recv(1 << 20):
                data += step
        head, _, body = data.partition(b"\r\n\r\n")
        lines = head.decode("latin-1").split("\r\n")
        headers = {}
        for line in lines[1:]:
            name, _, value = line.partition(":")
            headers[name.lower()] = value.strip()
        if body and headers.get("transfer-encoding") == "chunked":
            body = unchunked(body)
        return int(lines[0].split()[1]), headers, body


class Walk:
    """Requests to one server, each answer held against the contract."""

    def __init__(self, server, contract, headers=()):
        self.server, self.contract, self.headers = server, contract, list(headers)

    def ask(self, method, path, *, id=NO_JOB, query="", headers=(), body=None, version="HTTP/1.1", host="x"):
        lines = [f"{method} {path_of(path, id)}{query} {version}", f"Host: {host}", "Connection: close", *self.headers, *headers]
        if body is not None:
            lines.append(f"Content-Length: {len(body)}")
        data = "\r\n".join(lines).encode() + b"\r\n\r\n" + (body or b"")
        answer = self.server.read(self.server.open(data))
        return answer[0], self.contract.check(method, path, answer)

    def expect(self, status, code, method, path, **request):
        got, value = self.ask(method, path, **request)
        got_code = value.get("code") if isinstance(value, dict) and got >= 400 and method != "HEAD" else None
        if (got, got_code) != (status, code):
            self.contract.complain(f"{method} {path}", f"expected {status} {code}, got {got} {got_code}: {str(value)[:200]}")
        return value

    def post(self, model, request=None):
        constraints = base64.urlsafe_b64encode(json.dumps(request or {}).encode()).decode()
        return self.expect(202, None, "POST", "/v1/jobs", body=model,
                           headers=["Content-Type: model/obj", "X-Flatten-Constraints: " + constraints])["id"]

    def wait_for(self, id, *states):
        end = time.monotonic() + 60
        while (job := self.expect(200, None, "GET", "/v1/jobs/{id}", id=id))["state"] not in states:
            assert time.monotonic() < end, f"the job is still {job['state']}, not {states}"
            time.sleep(0.02)
        return job


def form(*parts):
    body = b"".join(b'--line\r\nContent-Disposition: form-data; name="%s"\r\n\r\n%s\r\n' % part for part in parts)
    return {"headers": ["Content-Type: multipart/form-data; boundary=line"], "body": body + b"--line--\r\n"}


def bumpy_disk(n):
    def height(x, y):
        return 6 * math.sin(200 * x / n / 9) * math.cos(200 * y / n / 11)
    points = [f"v {200 * x / n:.4f} {200 * y / n:.4f} {height(x, y):.4f}" for y in range(n) for x in range(n)]
    corners = [y * n + x + 1 for y in range(n - 1) for x in range(n - 1)]
    return "\n".join(points + [f"f {a} {a + 1} {a + n + 1} {a + n}" for a in corners]).encode()


def is_near(a, b):
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return abs(a - b) <= 1e-3
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(is_near, a, b))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_near(a[k], b[k]) for k in a if k != "timing_ms")
    return a == b


def walk_http(walk):
    """What HTTP alone can go wrong by, on every operation; what is slow to answer is returned to be read later."""
    waiting = []
    for method, path, _ in walk.contract.operations():
        walk.ask(method, path, query="?a=1&a=2")
        walk.ask(method, path, host="a b")
        walk.ask(method, path, headers=["Content-Length: 99999999999"])
        walk.ask(method, path, headers=["Expect: tea"])
        walk.ask(method, path, headers=["Transfer-Encoding: gzip"])
        walk.ask(method, path, headers=[f"X-{i}: 1" for i in range(120)])
        walk.ask(method, path, query="?" + "a" * 9000)
        walk.ask(method, path, version="HTTP/3.0")
        if method not in ("POST", "PUT") or path.endswith(("/cancel", "/test")):
            walk.ask(method, path, headers=["Content-Length: 2", "Content-Type: text/plain"])
        if method != "HEAD":
            waiting.append((method, path, walk.server.open(f"{method} {path_of(path, NO_JOB)} HTTP/1.1\r\n".encode())))
    for path in walk.contract.document["paths"]:
        for method in ("GET", "POST", "PUT", "PATCH", "DELETE"):
            if method.lower() not in walk.contract.document["paths"][path]:
                walk.expect(405, "method_not_allowed", method, path)
    for path in ("/", "/v1", "/v1/jobs/", "/v1/jobs/short"):
        walk.expect(404, "not_found", "GET", path)
    for method, path, _ in walk.contract.operations():
        if "{id}" in path:
            walk.ask(method, path, id="short")
            walk.ask(method, path)
    return waiting


def walk_submissions(walk, example):
    model, request = base64.b64decode(example["model"]["data"]), example["request"]
    as_json = {"headers": ["Content-Type: application/json"], "body": json.dumps(example).encode()}
    as_form = form((b"model", model), (b"request", json.dumps(request).encode()))
    jobs = []
    for submit in (lambda: walk.expect(202, None, "POST", "/v1/jobs", **as_form)["id"],
                   lambda: walk.expect(202, None, "POST", "/v1/jobs", **as_json)["id"],
                   lambda: walk.post(model, request)):
        jobs.append(submit())
        walk.wait_for(jobs[-1], "succeeded")
    shown = walk.contract.document["components"]["schemas"]["FlattenResult"]["examples"][0]
    for id in jobs:
        result = walk.expect(200, None, "GET", "/v1/jobs/{id}/result", id=id)
        if not is_near(result, shown):
            walk.contract.complain("the example of FlattenResult", "the example request gives another result")
    for kind, media_type in TYPES.items():
        for method in ("GET", "HEAD"):
            walk.expect(200, None, method, "/v1/jobs/{id}/result", id=jobs[0], query="?format=" + kind)
            walk.expect(200, None, method, "/v1/jobs/{id}/result", id=jobs[0], headers=["Accept: " + media_type])
    for method in ("GET", "HEAD"):
        read = (lambda code: code) if method == "GET" else (lambda code: None)
        walk.expect(400, read("format_unknown"), method, "/v1/jobs/{id}/result", id=jobs[0], query="?format=dxf")
        walk.expect(406, read("not_acceptable"), method, "/v1/jobs/{id}/result", id=jobs[0], headers=["Accept: text/html"])
        walk.expect(200, None, method, "/v1/jobs/{id}", id=jobs[0])
        walk.expect(200, None, method, "/healthz")
        walk.expect(200, None, method, "/openapi.json")
    for method, path, _ in walk.contract.operations():
        if method == "OPTIONS":
            walk.expect(204, None, method, path)
    walk.expect(409, "already_finished", "POST", "/v1/jobs/{id}/cancel", id=jobs[0])

    refused = [("invalid_request", 422, form((b"model", model), (b"request", b'{"lock": []}'))),
               ("invalid_request", 422, form((b"model", model), (b"request", b"{"))),
               ("unsupported_request", 422, form((b"model", model), (b"request", b'{"curves": {"heel": {"polyline": [[0, 0, 0], [1, 1, 1]]}}}'))),
               ("model_missing", 422, form((b"request", b"{}"))), ("model_missing", 422, {"body": b""}),
               ("part_unknown", 400, form((b"model", model), (b"options", b"{}"))),
               ("part_repeated", 400, form((b"model", model), (b"model", model))),
               ("too_many_parts", 400, form(*[(b"model", b"")] * 17)),
               ("bad_multipart", 400, {"headers": ["Content-Type: multipart/form-data"], "body": b"x"}),
               ("header_invalid", 400, {"headers": ["X-Flatten-Constraints: {}"], "body": model}),
               ("content_encoding_not_supported", 415, {"headers": ["Content-Encoding: gzip"], "body": model}),
               ("bad_chunks", 400, {"headers": ["Transfer-Encoding: chunked\r\n\r\nzz\r\n"]})]
    for code, status, what in refused:
        walk.expect(status, code, "POST", "/v1/jobs", **what)
    for model, request, code in ((b"hello", {}, "unreadable_model"), (b"ply\nformat ascii 1.0\n", {}, "unsupported_model"),
                                 (model, {"cuts": ["none"]}, "curve_invalid"), (model, {"surface": {"groups": ["x"]}}, "group_not_found")):
        id = walk.post(model, request)
        job = walk.wait_for(id, "failed")
        if job["error"]["code"] != code:
            walk.contract.complain("a failed job", f"expected {code}, got {job['error']}")
        walk.expect(409, code, "GET", "/v1/jobs/{id}/result", id=id)
        walk.expect(409, None, "HEAD", "/v1/jobs/{id}/result", id=id)
    return jobs[0]


def walk_waiting(walk, finished):
    """States that last: on a server with one worker and room for one job to wait."""
    slow = bumpy_disk(120)
    running = walk.post(slow)
    walk.wait_for(running, "running")
    waiting = walk.post(slow)
    walk.expect(503, "queue_full", "POST", "/v1/jobs", body=slow)
    walk.expect(200, None, "GET", "/v1/jobs/{id}", id=waiting)
    for method, path, operation in walk.contract.operations():
        if "409" in operation["responses"] and method in ("GET", "HEAD"):
            walk.expect(409, "not_finished" if method == "GET" else None, method, path, id=waiting)
    walk.expect(200, None, "POST", "/v1/jobs/{id}/cancel", id=waiting)
    walk.expect(409, "canceled", "GET", "/v1/jobs/{id}/result", id=waiting)
    walk.expect(202, None, "POST", "/v1/jobs/{id}/cancel", id=running)
    walk.wait_for(running, "canceled")
    for id in (finished, waiting, running):
        walk.expect(204, None, "DELETE", "/v1/jobs/{id}", id=id)
    walk.expect(404, "job_not_found", "DELETE", "/v1/jobs/{id}", id=running)


def walk_more(walk, example):
    """Assets, validation, batches, lists, repetitions, conditions, ranges, events."""
    model, request = base64.b64decode(example["model"]["data"]), example["request"]
    digest = hashlib.sha256(model).hexdigest()
    asset = walk.expect(201, None, "POST", "/v1/assets", body=model, headers=["Content-Digest: sha-256=:" + base64.b64encode(
        hashlib.sha256(model).digest()).decode() + ":"])
    assert asset["id"] == digest and asset["bytes"] == len(model), asset
    walk.expect(200, None, "POST", "/v1/assets", **form((b"model", model)))
    walk.expect(400, "digest_differs", "POST", "/v1/assets", body=model, headers=["Content-Digest: sha-256=:" + "A" * 43 + "=:"])
    walk.expect(422, "model_missing", "POST", "/v1/assets", body=b"")
    for method in ("GET", "HEAD"):
        walk.expect(200, None, method, "/v1/assets/{digest}", id=digest)
        walk.expect(404, "asset_not_found" if method == "GET" else None, method, "/v1/assets/{digest}")
    by_asset = {"model": {"asset_id": digest}, "request": request}
    json_type = "Content-Type: application/json"
    report = walk.expect(200, None, "POST", "/v1/validate", body=json.dumps(by_asset).encode(), headers=[json_type])
    assert report["flattens"] and report["surface"]["border_loops_mm"], report
    closed = walk.expect(200, None, "POST", "/v1/validate", body=b"v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    assert not closed["flattens"] and closed["problem"]["code"] == "region_not_disk", closed
    walk.expect(422, "unreadable_model", "POST", "/v1/validate", body=b"hello")

    post_asset = dict(body=json.dumps(by_asset).encode())
    key = ['Idempotency-Key: "order-1"', json_type, "Cancel-After: 5m"]
    first = walk.expect(202, None, "POST", "/v1/jobs", headers=key, **post_asset)
    again = walk.expect(202, None, "POST", "/v1/jobs", headers=key, **post_asset)
    assert first["id"] == again["id"] and "cancel_at" in first, (first, again)
    other = json.dumps({**by_asset, "request": {}}).encode()
    walk.expect(422, "key_reused", "POST", "/v1/jobs", headers=key, body=other)
    own = "0f8fad5b-d9cb-469f-a165-70867728950e"
    walk.expect(202, None, "PUT", "/v1/jobs/{id}", id=own, headers=[json_type], **post_asset)
    done = walk.expect(200, None, "PUT", "/v1/jobs/{id}", id=own, headers=[json_type, "Prefer: wait=30"], **post_asset)
    assert done["state"] == "succeeded" and done["result"]["regions"], done
    walk.expect(409, "id_taken", "PUT", "/v1/jobs/{id}", id=own, headers=[json_type], body=other)
    done = walk.expect(200, None, "POST", "/v1/jobs", headers=[json_type, "Prefer: wait=30"], **post_asset)
    assert done["result"]["regions"], done
    walk.expect(422, "asset_not_found", "POST", "/v1/jobs", query="?asset_id=" + NO_ASSET, body=b"")
    walk.expect(400, "model_repeated", "POST", "/v1/jobs", query="?asset_id=" + digest, body=model)
    walk.expect(400, "header_invalid", "POST", "/v1/jobs", headers=["Cancel-After: soon"], body=model)

    batch = walk.expect(202, None, "POST", "/v1/jobs:batch", headers=[json_type],
                        body=json.dumps({"jobs": [by_asset, {"model": {"asset_id": NO_ASSET}}]}).encode())
    assert (batch["taken"], batch["refused"]) == (1, 1) and batch["items"][1]["problem"]["code"] == "asset_not_found", batch
    walk.expect(415, "media_type_unsupported", "POST", "/v1/jobs:batch", body=b"{}")
    walk.expect(422, "invalid_request", "POST", "/v1/jobs:batch", headers=[json_type], body=b"{}")
    walk.wait_for(batch["items"][0]["job"]["id"], "succeeded")
    for method in ("GET", "HEAD"):
        walk.expect(200, None, method, "/v1/batches/{id}", id=batch["id"])
    assert walk.expect(200, None, "GET", "/v1/batches/{id}", id=batch["id"])["finished"]
    walk.expect(404, "batch_not_found", "GET", "/v1/batches/{id}")

    seen, cursor = [], ""
    while cursor is not None:
        part = walk.expect(200, None, "GET", "/v1/jobs", query="?limit=3&state=succeeded" + cursor)
        seen += [job["id"] for job in part["items"]]
        cursor = "&cursor=" + part["next_cursor"] if "next_cursor" in part else None
    assert own in seen and len(seen) == len(set(seen)) > 3, seen
    walk.expect(200, None, "HEAD", "/v1/jobs")
    for query in ("?limit=0", "?state=lost", "?created_after=today"):
        walk.expect(400, "parameter_invalid", "GET", "/v1/jobs", query=query)
    walk.expect(400, "parameter_unknown", "GET", "/v1/jobs", query="?stat=queued")
    walk.expect(400, "cursor_invalid", "GET", "/v1/jobs", query="?cursor=AAAAAAAAAAAAAAAAAAAA")
    walk_conditions(walk, own)
    walk.expect(204, None, "DELETE", "/v1/assets/{digest}", id=digest)
    walk.expect(404, "asset_not_found", "DELETE", "/v1/assets/{digest}", id=digest)


def walk_conditions(walk, id):
    """304, 206 and 416 wherever they are declared, and the events."""
    for method, path, operation in walk.contract.operations():
        if "304" not in operation["responses"]:
            continue
        headers = walk.expect(200, None, "HEAD", path, id=id)
        walk.expect(200, None, method, path, id=id)
        walk.expect(304, None, method, path, id=id, headers=["If-None-Match: " + headers["etag"]])
        if "206" in operation["responses"]:
            answer = walk.server.read(walk.server.open(
                f"{method} {path_of(path, id)} HTTP/1.1\r\nHost: x\r\nConnection: close\r\nRange: bytes=1-10\r\n\r\n".encode()))
            status, headers, body = answer
            walk.contract.seen.add((method, path, status))
            if status != 206 or len(body) != (10 if method == "GET" else 0) or not headers["content-range"].startswith("bytes 1-10/"):
                walk.contract.complain(f"{method} {path}", f"no range: {answer}")
            walk.expect(416, "range_outside" if method == "GET" else None, method, path, id=id, headers=["Range: bytes=999999999-"])
    events = walk.expect(200, None, "GET", "/v1/jobs/{id}/events", id=id).decode()
    assert events.count("event: state") == 3 and events.count("event: done") == 1, events
    last = [line[4:] for line in events.splitlines() if line.startswith("id: ")][-1]
    walk.expect(200, None, "HEAD", "/v1/jobs/{id}/events", id=id)
    resumed = walk.expect(200, None, "GET", "/v1/jobs/{id}/events", id=id, headers=["Last-Event-ID: 1"]).decode()
    assert resumed.count("event: state") == 2, resumed
    for method in ("GET", "HEAD"):
        walk.expect(204, None, method, "/v1/jobs/{id}/events", id=id, headers=["Last-Event-ID: " + last])
        walk.expect(406, "not_acceptable" if method == "GET" else None, method, "/v1/jobs/{id}/events", id=id, headers=["Accept: application/json"])


def walk_keys(program, contract, example):
    """A service with keys: 401, 429, and what one key sees of another."""
    with tempfile.TemporaryDirectory() as folder:
        keys = [subprocess.run([program, "keys", "add", name, "--data", folder], check=True, capture_output=True,
                               text=True).stdout.strip() for name in ("one", "two", "three")]
        server = Server(program, "--rate", "150", "--queue-per-key", "2", "--workers", "1", "--streams", "4", "--data", folder)
        try:
            nobody = Walk(server, contract)
            one, two, three = (Walk(server, contract, ["Authorization: Bearer " + key]) for key in keys)
            for method, path, operation in contract.operations():
                if "401" in operation["responses"]:
                    nobody.expect(401, "key_missing" if method != "HEAD" else None, method, path)
            Walk(server, contract, ["Authorization: Bearer " + keys[0] + "0"]).expect(401, "key_unknown", "GET", "/v1/jobs")
            id = one.post(base64.b64decode(example["model"]["data"]), example["request"])
            one.wait_for(id, "succeeded")
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
            streams = [server.open(f"GET /v1/jobs/{waiting}/events HTTP/1.1\r\nHost: x\r\n{one.headers[0]}\r\n\r\n".encode()) for _ in range(2)]
            for stream in streams:
                stream.recv(100)
            one.expect(503, "streams_full", "GET", "/v1/jobs/{id}/events", id=waiting)
            two.post(slow)
            for _ in range(160):
                three.ask("GET", "/v1/jobs/{id}")
            for method, path, operation in contract.operations():
                if "429" in operation["responses"]:
                    three.expect(429, "rate_exceeded" if method != "HEAD" else None, method, path)
            other = two.expect(200, None, "GET", "/v1/jobs")["items"][0]["id"]
            with server.open(f"GET /v1/jobs/{other}/events HTTP/1.1\r\nHost: x\r\n{two.headers[0]}\r\n\r\n".encode()) as stream:
                assert b" 200 " in stream.recv(100)
            for stream in streams:
                stream.close()
            subprocess.run([program, "keys", "revoke", keys[1].split("_")[1], "--data", folder], check=True)
            two.expect(401, "key_unknown", "GET", "/v1/jobs")
        finally:
            server.stop()


def walk_webhooks(program, contract):
    """Making, testing, seeing and dropping webhooks; what is sent is looked at by webhooks.bats."""
    json_type = "Content-Type: application/json"
    hook = b'{"url": "http://127.0.0.1:9/", "events": ["job.failed"]}'
    server = Server(program)
    try:
        walk = Walk(server, contract)
        walk.expect(403, "webhooks_off", "POST", "/v1/webhooks", headers=[json_type], body=hook)
        walk.expect(403, "webhooks_off", "POST", "/v1/webhooks/{id}/test")
    finally:
        server.stop()
    server = Server(program, "--webhooks", "public")
    try:
        walk = Walk(server, contract)
        id = walk.expect(201, None, "POST", "/v1/webhooks", headers=[json_type], body=hook)["id"]
        walk.expect(202, None, "POST", "/v1/webhooks/{id}/test", id=id)
        end = time.monotonic() + 10
        while not (sent := walk.expect(200, None, "GET", "/v1/webhooks/{id}/deliveries", id=id)["items"])[0].get("error"):
            assert time.monotonic() < end, sent
            time.sleep(0.05)
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


def walk_expiry(program, contract, example):
    """A service that keeps results for a second and jobs for two."""
    server = Server(program, "--keep-results", "1s", "--keep-jobs", "3s", "--streams", "0")
    try:
        walk = Walk(server, contract)
        id = walk.post(base64.b64decode(example["model"]["data"]), example["request"])
        for method in ("GET", "HEAD"):
            walk.expect(503, "streams_full" if method == "GET" else None, method, "/v1/jobs/{id}/events", id=id)
        end = time.monotonic() + 10
        while (answer := walk.ask("GET", "/v1/jobs/{id}/result", id=id))[0] != 410 and time.monotonic() < end:
            time.sleep(0.1)
        assert answer[1]["code"] == "result_expired", answer
        while walk.ask("GET", "/v1/jobs/{id}", id=id)[0] != 410 and time.monotonic() < end:
            time.sleep(0.1)
        for method, path, operation in contract.operations():
            if "410" in operation["responses"]:
                walk.expect(410, "job_expired" if method != "HEAD" else None, method, path, id=id)
    finally:
        server.stop()


def walk_sample(walk, program):
    """The real thing once: the sample last."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "sample-last", "--out", folder], check=True)
        model = pathlib.Path(folder, "last.obj").read_bytes()
        request = json.loads(pathlib.Path(folder, "last.request.json").read_text())
    walk.contract.check_value("the sample request", {"$ref": "#/components/schemas/FlattenRequest"}, request)
    id = walk.post(model, request)
    walk.wait_for(id, "succeeded")
    walk.expect(200, None, "GET", "/v1/jobs/{id}/result", id=id)


def template_of(contract, path):
    """The path of the contract that a path is an instance of; itself if there is none."""
    groups = {"{id}": "(?:[0-9A-Z]{26}|[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})", "{digest}": "[0-9a-f]{64}"}
    for template in contract.document["paths"]:
        pattern = re.escape(template)
        for name, group in groups.items():
            pattern = pattern.replace(re.escape(name), group)
        if re.fullmatch(pattern, path):
            return template
    return path


def check_answers(folder):
    """Holds answers that were kept (asked: status, method, URL; headers; body) against the contract."""
    contract = Contract(json.loads((ROOT / "api" / "openapi.json").read_text()))
    kept = [path for path in sorted(pathlib.Path(folder).iterdir()) if (path / "asked").exists()]
    for path in kept:
        status, method, url = (path / "asked").read_text().split(maxsplit=2)
        lines = (path / "headers").read_text("latin-1").replace("\r", "").strip().split("\n\n")[-1].splitlines()
        headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines[1:])}
        body = path / "body"
        if int(status) == 0 or (not body.exists() and headers.get("content-length", "0") != "0" and method != "HEAD"):
            continue  # no answer at all, or one too large to be kept
        content = body.read_bytes() if body.exists() and method != "HEAD" else b""
        contract.check(method, template_of(contract, urllib.parse.urlsplit(url.strip()).path), (int(status), headers, content))
    if contract.faults:
        print(f"{len(kept)} answers, {len(contract.faults)} faults")
    sys.exit(1 if contract.faults else 0)


def main():
    if sys.argv[1:2] == ["--answers"]:
        check_answers(sys.argv[2])
    program = os.environ.get("LASTFLAT", "")
    if not os.access(program, os.X_OK):
        sys.exit("LASTFLAT must name the program to test, such as build/release/lastflat")
    contract = Contract(json.loads((ROOT / "api" / "openapi.json").read_text()))
    contract.check_itself()
    server = Server(program, "--workers", "1", "--queue", "1")
    try:
        walk = Walk(server, contract)
        waiting = walk_http(walk)
        example = contract.document["components"]["schemas"]["JsonSubmission"]["examples"][0]
        finished = walk_submissions(walk, example)
        walk_more(walk, example)
        walk_sample(walk, program)
        walk_waiting(walk, finished)
        for method, path, connection in waiting:
            contract.check(method, path, server.read(connection))
        served = walk.expect(200, None, "GET", "/openapi.json")
        if served != contract.document:
            contract.complain("GET /openapi.json", "the server was built from another contract")
    finally:
        server.stop()
    walk_keys(program, contract, example)
    walk_expiry(program, contract, example)
    walk_webhooks(program, contract)

    exercised = {(m, p) for m, p, _ in contract.seen}
    for method, path, _ in contract.operations():
        if (method, path) not in exercised:
            contract.complain(f"{method} {path}", "never exercised")
    missing = {}
    for method, path, status in sorted(contract.declared() - contract.seen):
        missing.setdefault(status, []).append(f"{method} {path}")
    for status, operations in missing.items():
        print(f"not provoked: {status} of {', '.join(operations)}")
    print(f"{len(contract.seen)} of {len(contract.declared())} declared answers seen, {len(contract.faults)} faults")
    sys.exit(1 if contract.faults else 0)


if __name__ == "__main__":
    main()
