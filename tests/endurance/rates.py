#!/usr/bin/env python3
"""How many requests a second, and what the service adds to a flattening.

    tests/endurance/rates.py [HALF.obj HALF.request.json]     (default: the sample last)

GET of a job while two workers flatten (wrk, 16 connections kept alive); POST of a model of 300 kB until its 202, each
another one, so that each is written (wrk, 8 connections); POST to result less the flattening itself, one job at a time.
"""

import base64
import json
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from service import SAMPLE, Service, fresh_folder, submission

SCRIPT = """
local file = io.open("%s", "rb") local body = file:read("*a") file:close()
local count = 0
request = function()
  count = count + 1
  return wrk.format("POST", "/v1/jobs", {["Content-Type"] = "model/obj"}, "# " .. count .. " " .. math.random() .. "\\n" .. body)
end
"""


def slow_model(n=330):
    def height(x, y):
        return 6 * math.sin(200 * x / n / 9) * math.cos(200 * y / n / 11)
    lines = [f"v {200 * x / n:.4f} {200 * y / n:.4f} {height(x, y):.4f}" for y in range(n) for x in range(n)]
    corners = [y * n + x + 1 for y in range(n - 1) for x in range(n - 1)]
    return "\n".join(lines + [f"f {a} {a + 1} {a + n + 1} {a + n}" for a in corners]).encode()


def wrk(service, path, connections, seconds, *more):
    output = subprocess.run(["wrk", "-t1", f"-c{connections}", f"-d{seconds}s", "--latency", *more,
                             f"http://127.0.0.1:{service.port}{path}"], capture_output=True, text=True, check=True).stdout
    rate = float(output.split("Requests/sec:")[1].split()[0])
    errors = [line.strip() for line in output.splitlines() if "Non-2xx" in line or "Socket errors" in line]
    return rate, output.split("99%")[1].split()[0], " ".join(errors)


def get_rate():
    with fresh_folder() as folder:
        service = Service(folder, "--workers", "2").start()
        slow = submission("slow", slow_model())
        for _ in range(6):
            job = json.loads(service.ask("POST", "/v1/jobs", slow, {"Content-Type": "application/json"})[2])
        time.sleep(1)
        running = json.loads(service.ask("GET", "/v1/jobs?state=running")[2])["items"]
        rate, p99, errors = wrk(service, job["links"]["self"], 16, 8)
        print(f"GET job while {len(running)} workers flatten: {rate:.0f} a second, 99 % below {p99} {errors}")
        service.kill()


def post_rate(model):
    with fresh_folder() as folder, tempfile.NamedTemporaryFile("w", suffix=".lua") as script, tempfile.NamedTemporaryFile() as body:
        body.write(model)
        body.flush()
        script.write(SCRIPT % body.name)
        script.flush()
        service = Service(folder, "--queue", "100000").start()
        rate, p99, errors = wrk(service, "/", 8, 8, "-s", script.name)
        print(f"POST of {len(model) / 1000:.0f} kB until 202: {rate:.0f} a second, 99 % below {p99} {errors}")
        service.kill()


def overhead(model, request):
    with fresh_folder() as folder:
        service = Service(folder).start()
        connection = service.connect()
        headers = {"X-Flatten-Constraints": base64.urlsafe_b64encode(json.dumps(request).encode()).decode(),
                   "Prefer": "wait=60", "Content-Type": "model/obj"}
        whole, over = [], []
        for _ in range(21):
            begun = time.monotonic()
            status, _, content = service.ask("POST", "/v1/jobs", model, headers, connection)
            whole.append(1000 * (time.monotonic() - begun))
            assert status == 200, content[:300]
            over.append(whole[-1] - json.loads(content)["result"]["timing_ms"]["total"])
        print(f"POST to result: {statistics.median(whole):.1f} ms, of which not flattening: median {statistics.median(over):.1f} ms, most {max(over):.1f} ms")
        service.kill()


def main():
    model, request = (SAMPLE / "last.obj", SAMPLE / "last.request.json") if len(sys.argv) < 3 else map(pathlib.Path, sys.argv[1:3])
    if shutil.which("wrk"):
        get_rate()
        post_rate((model.read_bytes() * 10)[:300_000])
    else:
        print("skipped: wrk is not installed; only the time around the flattening is measured")
    overhead(model.read_bytes(), json.loads(request.read_text()))


if __name__ == "__main__":
    main()
