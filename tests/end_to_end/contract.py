#!/usr/bin/env python3
"""Holds a running server against api/openapi.json.

    LASTFLAT=build/release/lastflat tests/end_to_end/contract.py

Starts servers, provokes every path, method and status that is declared, and validates every answer (contract_check.py).
Ends with 1 if an answer breaks the contract or a declared one was never seen. Without python3-jsonschema it says so and
ends with 77 (skipped).
"""

import base64
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from contract_check import TYPES, load_contract
from contract_batches import walk_batches
from contract_service import NO_ASSET, NO_JOB, Server, Walk, bumpy_disk, form, path_of, see_key_in_flight
from contract_sessions import walk_session_limits, walk_sessions
from contract_settings import walk_broken, walk_busy, walk_expiry, walk_keys, walk_room, walk_webhooks


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
    for method, path, operation in walk.contract.operations():
        if "403" in operation["responses"]:
            walk.expect(403, "host_refused" if method != "HEAD" else None, method, path, host="evil.example")
        walk.ask(method, path, query="?a=1&a=2")
        walk.ask(method, path, host="a b")
        walk.ask(method, path, headers=["Content-Length: 99999999999"])
        walk.ask(method, path, headers=["Expect: tea"])
        walk.ask(method, path, headers=["Transfer-Encoding: gzip"])
        walk.ask(method, path, headers=[f"X-{i}: 1" for i in range(120)])
        walk.ask(method, path, query="?" + "a" * 9000)
        walk.ask(method, path, version="HTTP/3.0")
        if method not in ("POST", "PUT", "PATCH") or path.endswith(("/cancel", "/test", "/job")):
            walk.ask(method, path, headers=["Content-Length: 2", "Content-Type: text/plain"])
        waiting.append((method, path, walk.server.open(f"{method} {path_of(path, NO_JOB)} HTTP/1.1\r\n".encode())))
    for path in walk.contract.document["paths"]:
        for method in ("GET", "POST", "PUT", "PATCH", "DELETE"):
            if method.lower() not in walk.contract.document["paths"][path]:
                walk.expect(405, "method_not_allowed", method, path)
    walk.expect(403, "origin_refused", "POST", "/v1/jobs", headers=["Origin: https://evil.example"], body=b"v 0 0 0")
    walk.expect(403, "origin_refused", "GET", "/v1/jobs", headers=["Sec-Fetch-Site: cross-site"])
    walk.expect(200, None, "GET", "/docs", headers=["Sec-Fetch-Site: cross-site", "Sec-Fetch-Mode: navigate"])
    for path in ("/", "/v1", "/v1/jobs/", "/v1/jobs/0123456789ABCDEFGHJKMNPQRS/results"):
        walk.expect(404, "not_found", "GET", path)
    for method, path, _ in walk.contract.operations():
        with_body = method != "HEAD"
        if "{" in path:
            walk.expect(400, "id_malformed" if with_body else None, method, path, id="short" if "{id}" in path else "z" * 64)
            walk.ask(method, path)
        if method != "OPTIONS":
            walk.expect(400, "parameter_unknown" if with_body else None, method, path, query="?pretty=1")
        if method in ("POST", "PUT", "PATCH"):
            walk.ask(method, path, headers=["Content-Encoding: gzip"], body=b"x")
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
    if not walk.expect(202, None, "POST", "/v1/jobs", fresh=False, **as_json).get("cached"):
        walk.contract.complain("POST /v1/jobs", "what is there did not answer")
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
    walk_map(walk, jobs[0])

    refused = [("invalid_request", 422, form((b"model", model), (b"request", b'{"lock": []}'))),
               ("invalid_request", 422, form((b"model", model), (b"request", b"{"))),
               ("model_missing", 422, form((b"request", b"{}"))), ("model_missing", 422, {"body": b""}),
               ("part_unknown", 400, form((b"model", model), (b"options", b"{}"))),
               ("part_repeated", 400, form((b"model", model), (b"model", model))),
               ("too_many_parts", 400, form(*[(b"model", b"")] * 17)),
               ("bad_multipart", 400, {"headers": ["Content-Type: multipart/form-data"], "body": b"x"}),
               ("header_invalid", 400, {"headers": ["X-Flatten-Constraints: {}"], "body": model}),
               ("unsupported_model", 415, {"body": b"\x89PNG\r\n\x1a\n"}), ("unsupported_model", 415, form((b"model", b"PK\x03\x04"))),
               ("unreadable_model", 422, {"body": b"<!DOCTYPE html><html>"}), ("unreadable_model", 422, {"body": b"glTF\x02\0\0\0"}),
               ("content_encoding_not_supported", 415, {"headers": ["Content-Encoding: gzip"], "body": model}),
               ("bad_chunks", 400, {"headers": ["Transfer-Encoding: chunked\r\n\r\nzz\r\n"]})]
    for code, status, what in refused:
        walk.expect(status, code, "POST", "/v1/jobs", **what)
    unknown_extension = b'{"asset": {"version": "2.0"}, "extensionsRequired": ["X_unknown"], "extensionsUsed": ["X_unknown"]}'
    for model, request, code in ((b"hello", {}, "unreadable_model"), (unknown_extension, {}, "unsupported_model"),
                                 (model, {"curves": {"far": {"polyline": [[0, 0, 900], [1, 1, 900]]}}}, "curve_invalid"),
                                 (model, {"cuts": ["none"]}, "curve_invalid"), (model, {"surface": {"groups": ["x"]}}, "group_not_found")):
        id = walk.post(model, request)
        job = walk.wait_for(id, "failed")
        if job["error"]["code"] != code:
            walk.contract.complain("a failed job", f"expected {code}, got {job['error']}")
        walk.expect(409, code, "GET", "/v1/jobs/{id}/result", id=id)
        walk.expect(409, None, "HEAD", "/v1/jobs/{id}/result", id=id)
    return jobs[0]


def walk_map(walk, id):
    """Every vertex of a piece to the last and back."""
    result = walk.expect(200, None, "GET", "/v1/jobs/{id}/result", id=id)
    region = result["regions"][0]
    ask = lambda asked: walk.expect(200, None, "POST", "/v1/jobs/{id}/map", id=id, headers=["Content-Type: application/json"],
                                    body=json.dumps(asked).encode())
    last = ask({"to_last": {"region": region["name"], "points": region["uv_mm"], "polylines": [region["uv_mm"][:3]]}})["to_last"]
    back = ask({"to_pattern": {"region": region["name"], "points": [p["position"] for p in last["points"]],
                               "polylines": [last["polylines"][0]["positions"]]}})["to_pattern"]
    for uv, there, here in zip(region["uv_mm"], last["points"], back["points"]):
        assert there["distance_mm"] < 1e-9 and math.dist(uv, here["uv_mm"]) < 1e-6, (uv, there, here)
    assert len(back["polylines"]) == 1, back["polylines"]
    for code, status, what in (("invalid_request", 422, b'{"to_last": {}}'), ("invalid_request", 422, b"{"),
                               ("region_invalid", 422, b'{"to_last": {"region": "nowhere", "points": [[0, 0]]}}')):
        walk.expect(status, code, "POST", "/v1/jobs/{id}/map", id=id, headers=["Content-Type: application/json"], body=what)
    walk.expect(415, "media_type_unsupported", "POST", "/v1/jobs/{id}/map", id=id, body=b"{}")


def walk_waiting(walk, finished):
    """States that last: on a server with one worker and room for one job to wait."""
    slow = bumpy_disk(120)
    running = walk.post(slow)
    walk.wait_for(running, "running")
    waiting = walk.post(slow)
    walk.expect(503, "queue_full", "POST", "/v1/jobs", body=slow)
    walk.expect(200, None, "GET", "/v1/jobs/{id}", id=waiting)
    for method, path, operation in walk.contract.operations():
        if "409" in operation["responses"] and method in ("GET", "HEAD") and path.startswith("/v1/jobs/"):
            walk.expect(409, "not_finished" if method == "GET" else None, method, path, id=waiting)
    walk.expect(409, "not_finished", "POST", "/v1/jobs/{id}/map", id=waiting, headers=["Content-Type: application/json"],
                body=b'{"to_last": {"region": "r", "points": [[0, 0]]}}')
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
    assert walk.expect(200, None, "GET", "/v1/assets") == {"items": []}
    asset = walk.expect(201, None, "POST", "/v1/assets", body=model, headers=["Content-Digest: sha-256=:" + base64.b64encode(
        hashlib.sha256(model).digest()).decode() + ":"])
    assert asset["id"] == digest and asset["bytes"] == len(model), asset
    walk.expect(200, None, "POST", "/v1/assets", **form((b"model", model)))
    walk.expect(400, "digest_differs", "POST", "/v1/assets", body=model, headers=["Content-Digest: sha-256=:" + "A" * 43 + "=:"])
    walk.expect(422, "model_missing", "POST", "/v1/assets", body=b"")
    walk.expect(422, "unreadable_model", "POST", "/v1/assets", body=bytes(64))
    walk.expect(415, "unsupported_model", "POST", "/v1/assets", body=b"PK\x03\x04")
    for method in ("GET", "HEAD"):
        walk.expect(200, None, method, "/v1/assets")
        walk.expect(200, None, method, "/v1/assets/{digest}", id=digest)
        walk.expect(404, "asset_not_found" if method == "GET" else None, method, "/v1/assets/{digest}")
    by_asset = {"model": {"asset_id": digest}, "request": request}
    json_type = "Content-Type: application/json"
    report = walk.expect(200, None, "POST", "/v1/validate", body=json.dumps(by_asset).encode(), headers=[json_type])
    assert report["flattens"] and report["surface"]["border_loops_mm"], report
    closed = walk.expect(200, None, "POST", "/v1/validate", body=b"v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    assert not closed["flattens"] and closed["problem"]["code"] == "region_invalid", closed
    walk.expect(422, "unreadable_model", "POST", "/v1/validate", body=b"hello")

    post_asset = dict(body=json.dumps(by_asset).encode())
    key = ['Idempotency-Key: "order-1"', json_type, "Cancel-After: 5m"]
    first = walk.expect(202, None, "POST", "/v1/jobs", headers=key, **post_asset)
    again = walk.expect(202, None, "POST", "/v1/jobs", headers=key, **post_asset)
    assert first["id"] == again["id"] and "cancel_at" in first, (first, again)
    job = see_key_in_flight(walk, "/v1/jobs", model)
    walk.wait_for(job["id"], "succeeded")
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
    walk.expect(400, "header_invalid", "POST", "/v1/jobs", headers=["Job-Priority: first"], body=model)


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
                f"{method} {path_of(path, id)} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nRange: bytes=1-10\r\n\r\n".encode()))
            status, headers, body = answer
            walk.contract.seen.add((method, path, status))
            if status != 206 or len(body) != (10 if method == "GET" else 0) or not headers["content-range"].startswith("bytes 1-10/"):
                walk.contract.complain(f"{method} {path}", f"no range: {answer}")
            walk.expect(416, "range_outside" if method == "GET" else None, method, path, id=id, headers=["Range: bytes=999999999-"])
    for width in ("0", "15", "2049", "wide", ""):
        walk.expect(400, "parameter_invalid", "GET", "/v1/jobs/{id}/result.png", id=id, query="?width=" + width)
    picture = walk.expect(200, None, "GET", "/v1/jobs/{id}/result.png", id=id, query="?width=320")
    assert picture[:8] == b"\x89PNG\r\n\x1a\n" and int.from_bytes(picture[16:20], "big") == 320, picture[:32]
    events = walk.expect(200, None, "GET", "/v1/jobs/{id}/events", id=id).decode()
    assert events.count("event: state") == 3 and events.count("event: done") == 1, events
    last = [line[4:] for line in events.splitlines() if line.startswith("id: ")][-1]
    walk.expect(200, None, "HEAD", "/v1/jobs/{id}/events", id=id)
    resumed = walk.expect(200, None, "GET", "/v1/jobs/{id}/events", id=id, headers=["Last-Event-ID: 1"]).decode()
    assert resumed.count("event: state") == 2, resumed
    for method in ("GET", "HEAD"):
        walk.expect(204, None, method, "/v1/jobs/{id}/events", id=id, headers=["Last-Event-ID: " + last])
        walk.expect(406, "not_acceptable" if method == "GET" else None, method, "/v1/jobs/{id}/events", id=id, headers=["Accept: application/json"])


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
    # Without a word: what the request would have said is found, and may be sent back.
    id = walk.post(re.sub(rb"(?m)^g .*\n", b"", model))
    walk.wait_for(id, "succeeded")
    bare = walk.expect(200, None, "GET", "/v1/jobs/{id}/result", id=id)
    assert [r["name"] for r in bare["regions"]] == ["lateral", "medial"] and bare["found"]["foot"] == "right", bare["found"]
    walk.contract.check_value("the request found", {"$ref": "#/components/schemas/FlattenRequest"}, bare["found"]["request"])


def main():
    program = os.environ.get("LASTFLAT", "")
    if not os.access(program, os.X_OK):
        sys.exit("LASTFLAT must name the program to test, such as build/release/lastflat")
    contract = load_contract()
    contract.check_itself()
    server = Server(program, "--workers", "1", "--queue", "1")
    try:
        walk = Walk(server, contract)
        waiting = walk_http(walk)
        example = contract.document["components"]["schemas"]["JsonSubmission"]["examples"][0]
        finished = walk_submissions(walk, example)
        walk_more(walk, example)
        walk_sessions(walk, example)
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
    walk_webhooks(program, contract, example)
    walk_batches(program, contract, example)
    walk_session_limits(program, contract, example)
    walk_room(program, contract)
    walk_busy(program, contract)
    walk_broken(program, contract, example)

    missing = {}
    for method, path, status in sorted(contract.declared() - contract.seen):
        missing.setdefault(status, []).append(f"{method} {path}")
    for status, operations in missing.items():
        contract.complain(f"{status} of {', '.join(operations)}", "declared, but not provoked")
    print(f"{len(contract.seen)} of {len(contract.declared())} declared answers seen, {len(contract.faults)} faults")
    sys.exit(1 if contract.faults else 0)


if __name__ == "__main__":
    main()
