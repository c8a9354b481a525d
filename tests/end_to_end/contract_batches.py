"""A batch is taken whole or refused whole, waited for, canceled, and fetched as one."""

import base64
import json

from contract_service import NO_ASSET, Server, Walk, bumpy_disk, see_key_in_flight

METHODS = ("GET", "HEAD")
JSON = "Content-Type: application/json"


def batch(*jobs, **headers):
    more = [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    return {"headers": [JSON, *more], "body": json.dumps({"jobs": jobs}).encode()}


def walk_refusals(walk, quick):
    walk.expect(422, "asset_not_found", "POST", "/v1/jobs:batch", **batch(quick, {"model": {"asset_id": NO_ASSET}}))
    broken = walk.expect(422, "invalid_request", "POST", "/v1/jobs:batch", **batch(quick, {**quick, "request": {"lock": 1}}))
    assert broken["pointer"] == "/jobs/1/request/lock", broken
    walk.expect(422, "invalid_request", "POST", "/v1/jobs:batch", **batch())
    walk.expect(422, "invalid_request", "POST", "/v1/jobs:batch", **batch(*[quick] * 4))  # more than the queue holds
    walk.expect(415, "media_type_unsupported", "POST", "/v1/jobs:batch", body=b"{}")
    assert walk.expect(200, None, "GET", "/v1/jobs")["items"] == []


def walk_one(walk, quick, slow):
    asked = batch(slow, quick, slow, Idempotency_Key="a batch")
    first = walk.expect(202, None, "POST", "/v1/jobs:batch", **asked)
    again = walk.expect(202, None, "POST", "/v1/jobs:batch", **asked)
    assert again["id"] == first["id"], (first, again)
    walk.expect(422, "key_reused", "POST", "/v1/jobs:batch", **batch(quick, Idempotency_Key="a batch"))
    walk.expect(503, "queue_full", "POST", "/v1/jobs:batch", **batch(quick, quick))
    id = first["id"]
    for path in ("/v1/batches/{id}/results.csv", "/v1/batches/{id}/result.zip"):
        for method in METHODS:
            walk.expect(409, "not_finished" if method == "GET" else None, method, path, id=id)
    walk.ask("POST", "/v1/jobs/{id}/cancel", id=first["items"][0]["id"])
    walk.wait_for(first["items"][1]["id"], "succeeded")
    walk.wait_for(first["items"][2]["id"], "running")
    walk.expect(202, None, "POST", "/v1/batches/{id}/cancel", id=id)
    done = walk.expect(200, None, "GET", "/v1/batches/{id}", id=id, headers=["Prefer: wait=30"])
    assert done["finished"] and done["states"] == {"succeeded": 1, "canceled": 2}, done
    walk.expect(409, "already_finished", "POST", "/v1/batches/{id}/cancel", id=id)
    for method in METHODS:
        for end in ("", "/results.csv", "/result.zip", "/events"):
            walk.expect(200, None, method, "/v1/batches/{id}" + end, id=id)
            walk.expect(404, "batch_not_found" if method == "GET" else None, method, "/v1/batches/{id}" + end)
    walk.expect(404, "batch_not_found", "POST", "/v1/batches/{id}/cancel")


def walk_batches(program, contract, example):
    server = Server(program, "--workers", "1", "--queue", "3")
    try:
        walk = Walk(server, contract)
        model = base64.b64decode(example["model"]["data"])
        asset = walk.expect(201, None, "POST", "/v1/assets", body=model)["id"]
        quick = {**example, "model": {"asset_id": asset}}
        slow = {"model": {"data": base64.b64encode(bumpy_disk(150)).decode()}}
        walk_refusals(walk, quick)
        walk_one(walk, quick, slow)
        whole = walk.expect(200, None, "POST", "/v1/jobs:batch", **batch(quick, Prefer="wait=30"))
        assert whole["states"] == {"succeeded": 1} and whole["items"][0]["priority"] == "batch", whole
        see_key_in_flight(walk, "/v1/jobs:batch", batch(quick)["body"], "application/json")
        running = walk.post(base64.b64decode(slow["model"]["data"]))
        walk.wait_for(running, "running")
        waits = walk.expect(202, None, "POST", "/v1/jobs:batch", **batch(quick, quick))
        canceled = walk.expect(200, None, "POST", "/v1/batches/{id}/cancel", id=waits["id"])
        assert canceled["states"] == {"canceled": 2}, canceled
    finally:
        server.stop()
    server = Server(program, "--min-free-mb", str(1 << 24))
    try:
        Walk(server, contract).expect(507, "storage_full", "POST", "/v1/jobs:batch", **batch(example))
    finally:
        server.stop()
