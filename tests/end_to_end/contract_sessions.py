"""Live sessions, held against the contract."""

import base64
import json
import math
import os
import pathlib
import signal
import struct
import subprocess
import tempfile

from contract_service import Server, Walk
from eventually import eventually

JSON = ["Content-Type: application/json"]
MERGE = ["Content-Type: application/merge-patch+json"]
POINTS = "application/vnd.lastflat.points"


def workers_of(server):
    """Processes that the server has started."""
    children = pathlib.Path(f"/proc/{server.process.pid}/task").glob("*/children")
    return [int(pid) for text in children for pid in text.read_text().split()]


def read_points(content):
    """`application/vnd.lastflat.points`, as it is documented."""
    place = 4

    def numbers(count, kind="I"):
        nonlocal place
        values = struct.unpack_from(f"<{count}{kind}", content, place)
        place += 4 * count
        return values

    assert content[:4] == b"LFPT", content[:8]
    layout, revision, changed, regions, curves = numbers(5)
    charts = [numbers(2 * numbers(1)[0], "f") for _ in range(regions)]
    lines = []
    for _ in range(curves):
        on_last = numbers(3 * numbers(1)[0], "f")
        runs = []
        for _ in range(numbers(1)[0]):
            region, size = numbers(2)
            runs.append((region, numbers(2 * size, "f")))
        lines.append((on_last, runs))
    assert layout == 1 and place == len(content), (layout, place, len(content))
    return revision, changed, charts, lines


def fit_for(method, path):
    """What a request needs to come as far as its session."""
    if method == "PATCH":
        return {"query": "?sequence=1", "headers": MERGE, "body": b"{}"}
    return {"headers": JSON, "body": b"{}"} if path.endswith("/map") else {}


def walk_sessions(walk, example):
    """Opened, changed, looked at, made a job, closed; and one whose process is killed."""
    body = json.dumps(example).encode()
    assert walk.expect(200, None, "GET", "/v1/sessions") == {"items": []}
    opened = walk.expect(201, None, "POST", "/v1/sessions", headers=JSON, body=body)
    id, regions = opened["id"], opened["pattern"]["regions"]
    assert opened["request"] == example["request"] and opened["changed"] == "model", opened
    patch = lambda status, code, number, change, **more: walk.expect(
        status, code, "PATCH", "/v1/sessions/{id}", id=id, query=f"?sequence={number}",
        **{"headers": MERGE, "body": json.dumps(change).encode(), **more})
    pin = {"kind": "pin", "vertex": next(v for v in regions[0]["source_vertices"] if v is not None), "at_mm": [5.0, 7.0]}
    moved = patch(200, None, 5, {"constraints": [pin]})
    assert (moved["changed"], moved["sequence"], moved["revision"]) == ("pattern", 5, 2), moved
    assert moved["pattern"]["regions"][0]["uv_mm"] != regions[0]["uv_mm"]
    patch(409, "superseded", 5, {})
    patch(409, "superseded", 4, {})
    patch(422, "invalid_request", 6, {"weights": {"strech": 3.0}})
    patch(422, "curve_invalid", 7, {"cuts": ["nothing"]})
    patch(422, "invalid_request", 8, [])
    patch(422, "invalid_request", 9, {}, body=b'{"tag": "\xff"}')
    patch(415, "media_type_unsupported", 9, {}, headers=["Content-Type: text/plain"])
    patch(400, "parameter_invalid", "first", {})
    made = walk.expect(202, None, "POST", "/v1/sessions/{id}/job", id=id)
    assert made["difference_mm"] < 1e-6, made
    walk.wait_for(made["job"]["id"], "succeeded")
    job = walk.expect(200, None, "GET", "/v1/jobs/{id}/result", id=made["job"]["id"])
    assert math.dist(job["regions"][0]["uv_mm"][0], moved["pattern"]["regions"][0]["uv_mm"][0]) < 1e-6, job
    ends = [walk.expect(200, None, "POST", "/v1/sessions/{id}/map", id=id, headers=JSON, body=json.dumps(
        {"to_last": {"region": r["name"], "points": [[sum(p[k] for p in r["uv_mm"]) / len(r["uv_mm"]) for k in (0, 1)]]}}).encode())
        ["to_last"]["points"][0]["position"] for r in regions]
    drawn = patch(200, None, 10, {"constraints": None, "curves": {"line": {"polyline": ends}}})
    assert drawn["changed"] == "pattern" and len(drawn["curves"][0]["runs"]) == 2, drawn["curves"]
    ends[0][2] += 0.01
    content = patch(200, None, 11, {"curves": {"line": {"polyline": ends}}}, headers=[*MERGE, "Accept: " + POINTS])
    revision, changed, charts, lines = read_points(content)
    assert (revision, changed, [len(c) for c in charts], len(lines[0][1])) == (4, 1, [0] * len(regions), 2), content[:40]
    whole = read_points(walk.expect(200, None, "GET", "/v1/sessions/{id}", id=id, headers=["Accept: " + POINTS]))
    assert len(whole[2][0]) == 2 * len(regions[0]["uv_mm"])
    state = walk.expect(200, None, "GET", "/v1/sessions/{id}", id=id)
    assert state["request"]["curves"]["line"] == {"polyline": ends} and "constraints" not in state["request"], state["request"]
    assert [s["id"] for s in walk.expect(200, None, "GET", "/v1/sessions")["items"]] == [id]
    walk.expect(200, None, "HEAD", "/v1/sessions")
    for path in ("/v1/sessions/{id}", "/v1/sessions/{id}/surface"):
        walk.expect(200, None, "HEAD", path, id=id)
    assert walk.expect(200, None, "GET", "/v1/sessions/{id}/surface", id=id)[:4] == b"glTF"
    for code, status, what in (("invalid_request", 422, {"headers": JSON, "body": b"{"}), ("media_type_unsupported", 415, {"body": b"{}"}),
                               ("region_invalid", 422, {"headers": JSON, "body": b'{"to_last": {"region": "none", "points": [[0, 0]]}}'})):
        walk.expect(status, code, "POST", "/v1/sessions/{id}/map", id=id, **what)
    walk.expect(204, None, "DELETE", "/v1/sessions/{id}", id=id)
    for method, path, operation in walk.contract.operations():
        if path.startswith("/v1/sessions/{id}") and "404" in operation["responses"]:
            walk.expect(404, "session_not_found" if method != "HEAD" else None, method, path, id=id, **fit_for(method, path))
    walk.expect(422, "unreadable_model", "POST", "/v1/sessions", body=b"hello")
    walk.expect(415, "unsupported_model", "POST", "/v1/sessions", body=b"PK\x03\x04")
    walk_lost(walk, body)


def walk_lost(walk, body):
    before = set(workers_of(walk.server))
    id = walk.expect(201, None, "POST", "/v1/sessions", headers=JSON, body=body)["id"]
    (process,) = set(workers_of(walk.server)) - before
    os.kill(process, signal.SIGKILL)
    eventually(10, lambda: walk.ask("GET", "/v1/sessions/{id}", id=id), lambda answer: answer[0] == 410)
    for method, path, operation in walk.contract.operations():
        if path.startswith("/v1/sessions/{id}") and "410" in operation["responses"]:
            walk.expect(410, "session_lost" if method != "HEAD" else None, method, path, id=id, **fit_for(method, path))
    walk.expect(204, None, "DELETE", "/v1/sessions/{id}", id=id)


def walk_session_limits(program, contract, example):
    """One session of a key, and no room for the job that would be made of it; none at all."""
    model = b"# " + b"x" * (2 << 20) + b"\n" + base64.b64decode(example["model"]["data"])
    with tempfile.TemporaryDirectory() as folder:
        key = subprocess.run([program, "keys", "add", "one", "--data", folder], check=True, capture_output=True, text=True).stdout.strip()
        server = Server(program, "--sessions-per-key", "1", "--storage-per-key-mb", "1", "--session-idle", "2s", "--data", folder)
        try:
            walk = Walk(server, contract, ["Authorization: Bearer " + key])
            id = walk.expect(201, None, "POST", "/v1/sessions", body=model)["id"]
            walk.expect(429, "key_sessions_full", "POST", "/v1/sessions", body=model)
            walk.expect(507, "quota_exceeded", "POST", "/v1/sessions/{id}/job", id=id)
            eventually(10, lambda: walk.expect(200, None, "GET", "/v1/sessions"), lambda list: list == {"items": []})
            eventually(10, lambda: [*pathlib.Path(folder, "work").iterdir(), *workers_of(server)], lambda left: not left)
        finally:
            server.stop()
    server = Server(program, "--sessions", "0")
    try:
        Walk(server, contract).expect(503, "sessions_full", "POST", "/v1/sessions", body=model)
    finally:
        server.stop()
