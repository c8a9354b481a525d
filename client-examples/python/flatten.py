#!/usr/bin/env python3
"""Flattens a last: sends it, waits, saves the pattern and prints what became of every curve.

    flatten.py LAST [REQUEST]      LAST: OBJ, STL, PLY, glTF or GLB; REQUEST: the constraint JSON

LASTFLAT_URL  the server; default http://127.0.0.1:8080
LASTFLAT_KEY  the API key, if the server asks for one
OUT           the folder for result.json, pattern.svg and flat.glb; default: a folder with the last's name, here

Ends with 0; with 2 if the last or the request is at fault; with 1 if anything else is. Only the standard library.
"""

import json
import os
import pathlib
import sys
import time
import urllib.error
import urllib.request
import uuid

SERVER = os.environ.get("LASTFLAT_URL", "http://127.0.0.1:8080").rstrip("/")

KEY = {"Authorization": "Bearer " + os.environ["LASTFLAT_KEY"]} if os.environ.get("LASTFLAT_KEY") else {}


class Problem(Exception):
    """What the server says is wrong (RFC 9457)."""

    def __init__(self, status, document):
        pointer = f"\n  at: {document['pointer']}" if "pointer" in document else ""
        super().__init__(f"{document.get('detail', f'status {status}')}{pointer}\n  code: {document.get('code')}")
        self.exit_code = 2 if 400 <= status < 500 else 1


def ask(path, body=None, headers=None):
    """The answer's bytes; a full queue is waited for."""
    for attempt in range(5):
        try:
            request = urllib.request.Request(SERVER + path, data=body, headers={**KEY, **(headers or {})})
            with urllib.request.urlopen(request, timeout=120) as answer:
                return answer.read()
        except urllib.error.HTTPError as error:
            text = error.read()
            if error.code == 503 and attempt < 4:
                time.sleep(int(error.headers.get("Retry-After", 5)))
                continue
            is_problem = error.headers.get_content_type() == "application/problem+json"
            raise Problem(error.code, json.loads(text) if is_problem else {}) from None


def form(parts):
    """The parts as multipart/form-data: its content type and bytes."""
    boundary = uuid.uuid4().hex
    lines = []
    for name, content_type, content in parts:
        head = f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"; filename="{name}"\r\n'
        lines += [head.encode(), f"Content-Type: {content_type}\r\n\r\n".encode(), content, b"\r\n"]
    return f"multipart/form-data; boundary={boundary}", b"".join(lines) + f"--{boundary}--\r\n".encode()


def finished(job):
    """Waits for the job's end: the server answers when it has come, at once when all places to wait are taken."""
    while job["state"] not in ("succeeded", "failed", "canceled"):
        time.sleep(0.1)
        job = json.loads(ask(job["links"]["self"], headers={"Prefer": "wait=30"}))
    return job


def places(count, number):
    """To so many places; what rounds to nothing has no sign."""
    return f"{round(number, count) + 0.0:.{count}f}"


def main(last, request=None):
    parts = [("model", "application/octet-stream", pathlib.Path(last).read_bytes())]
    if request:
        parts.append(("request", "application/json", pathlib.Path(request).read_bytes()))
    content_type, body = form(parts)
    once = uuid.uuid4().hex  # makes it one job, however often it is sent
    job = finished(json.loads(ask("/v1/jobs", body, {"Content-Type": content_type, "Idempotency-Key": once})))
    if job["state"] == "failed":
        raise Problem(422, job["error"])
    if job["state"] == "canceled":
        sys.exit("flatten.py: the job was canceled")

    folder = pathlib.Path(os.environ.get("OUT") or pathlib.Path(last).stem)
    files = {name: ask(f"{job['links']['result']}?format={kind}")
             for name, kind in (("result.json", "json"), ("pattern.svg", "svg"), ("flat.glb", "glb"))}
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)

    result = json.loads(files["result.json"])
    print("flat - last: above 0 a curve is gathered when it is lasted, below 0 stretched")
    row = "{:16} {:16} {:>10} {:>10} {:>14} {:>8}  {}"
    print(row.format("region", "curve", "last mm", "flat mm", "flat - last mm", "%", "verdict"))
    for region in result["regions"]:
        for c in region["curves"]:
            for name, part in [(c["name"], c)] + [("- " + zone["name"], zone) for zone in c.get("zones", [])]:
                on_last, in_flat = part["length_3d_mm"], part["length_2d_mm"]
                print(row.format(region["name"], name, places(3, on_last), places(3, in_flat),
                                 places(6, in_flat - on_last), places(3, part.get("ease_percent", 0)),
                                 part.get("verdict", "-")))
    for p in result["pairs"]:
        print(f"pair {p['curve']}: {p['a']} and {p['b']} differ by {places(6, p['difference_mm'])} mm  {p['verdict']}")
    for warning in result["warnings"]:
        print("warning:", warning["detail"])
    print(f"written to {folder}:", *files)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    try:
        main(*sys.argv[1:])
    except Problem as problem:
        print(f"flatten.py: {problem}", file=sys.stderr)
        sys.exit(problem.exit_code)
    except OSError as error:
        is_input = getattr(error, "filename", None) in sys.argv[1:]
        print(f"flatten.py: {error}", file=sys.stderr)
        sys.exit(2 if is_input else 1)
