#!/usr/bin/env python3
"""What a batch costs beside its jobs: 24 sizes, as single jobs and as one batch with its archive and its table.

    tests/endurance/batch.py [--runs 3] [FOLDER]

FOLDER: closed lasts (`*.obj`) to take, again and again up to 24, instead of the sample last's sizes.
The ratio is that of the batch, from its POST until archive and table are here, to the single jobs, from the first POST
until the last has ended, in the same run. Exit 0: it is at most 1.05.
"""

import argparse
import base64
import io
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import zipfile

from service import Service, fresh_folder, program

SIZES = [33 + 0.5 * i for i in range(24)]
JSON = {"Content-Type": "application/json"}


def lasts_of(folder):
    files = sorted(pathlib.Path(folder).glob("*.obj"))
    return [{"model": {"data": base64.b64encode(files[i % len(files)].read_bytes()).decode()}, "request": {"tag": f"last-{i}"}}
            for i in range(len(SIZES))]


def sizes():
    """A job for each size of the sample last."""
    jobs = []
    for size in SIZES:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program(), "sample-last", "--size", str(size), "--out", folder], check=True, capture_output=True)
            model = open(folder + "/last.obj", "rb").read()
            request = json.load(open(folder + "/last.request.json"))
        jobs.append({"model": {"data": base64.b64encode(model).decode()}, "request": {**request, "tag": f"size-{size}"}})
    return jobs


def as_jobs(service, jobs):
    begun = time.monotonic()
    paths = [json.loads(service.ask("POST", "/v1/jobs", json.dumps(job), JSON)[2])["links"]["self"] for job in jobs]

    def wait(path):
        while json.loads(service.ask("GET", path, None, {"Prefer": "wait=30"})[2])["state"] != "succeeded":
            pass
    threads = [threading.Thread(target=wait, args=(path,)) for path in paths]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return time.monotonic() - begun


def as_batch(service, jobs):
    begun = time.monotonic()
    status, _, content = service.ask("POST", "/v1/jobs:batch", json.dumps({"jobs": jobs}), {**JSON, "Prefer": "wait=60"})
    batch = json.loads(content)
    assert status == 200 and batch["states"] == {"succeeded": len(jobs)}, content[:300]
    archive = service.ask("GET", batch["links"]["archive"])[2]
    table = service.ask("GET", batch["links"]["table"])[2]
    elapsed = time.monotonic() - begun
    with zipfile.ZipFile(io.BytesIO(archive)) as files:
        assert files.testzip() is None and len(files.namelist()) == 4 * len(jobs) + 2
    return elapsed, len(archive), table.count(b"\n") - 1


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("folder", nargs="?")
    options = parser.parse_args()
    jobs = lasts_of(options.folder) if options.folder else sizes()
    ratios = []
    for run in range(options.runs):
        with fresh_folder() as folder:
            service = Service(folder).start()
            single = as_jobs(service, jobs)
            whole, archive, rows = as_batch(service, jobs)
            service.kill()
        ratios.append(whole / single)
        print(f"{len(jobs)} lasts: {single:.2f} s as jobs; {whole:.2f} s as a batch with an archive of {archive / 1e6:.1f} MB and {rows} rows", flush=True)
    print(f"ratio {statistics.median(ratios):.3f}, at most 1.05")
    sys.exit(0 if statistics.median(ratios) <= 1.05 else 1)


if __name__ == "__main__":
    main()
