#!/usr/bin/env python3
"""Kills the service again and again under load, and counts what is lost.

    tests/endurance/fault_run.py [--cycles 200] [--clients 8] [--seconds 1.0] [--stop]

Each client posts jobs with an Idempotency-Key and repeats a request until it is answered; some jobs are broken, some are
canceled. After a random time the service is killed (SIGKILL) and started again. With --stop every fourth cycle freezes
the service for longer than its lease instead. In the end every accepted job must be in a true state, every result must be
the one that an undisturbed service gives, every key must have one job, and the doctor must find nothing. Exit 0: so it is.
"""

import argparse
import collections
import http.client
import json
import random
import signal
import sys
import threading
import time

from service import Service, fresh_folder, submission

LEASE = 2


def without_times(result):
    result = json.loads(result)
    result.pop("timing_ms")
    return result


class Run:
    def __init__(self, service, options):
        self.service, self.options = service, options
        self.ended = threading.Event()
        self.lock = threading.Lock()
        self.accepted = {}  # id -> (kind, key)
        self.faults = []
        self.kills = self.repeats = 0

    def complain(self, what):
        with self.lock:
            self.faults.append(what)
        print("FAULT", what, flush=True)

    def client(self, number):
        chance = random.Random(number)
        for count in range(10**9):
            if self.ended.is_set():
                return
            kind = chance.choices(("good", "broken", "canceled"), (8, 1, 1))[0]
            key = f"client-{number}-{count}"
            body = submission(key, b"v 0 0 0\nf 1 2 3\n") if kind == "broken" else submission(key)
            job = self.insist(body, key)
            if job is None:
                return
            with self.lock:
                self.accepted[job["id"]] = (kind, key)
            if kind == "canceled":
                self.try_once("POST", f"/v1/jobs/{job['id']}/cancel")

    def insist(self, body, key):
        """Posts until there is an answer; the key makes sure that there is one job."""
        headers = {"Content-Type": "application/json", "Idempotency-Key": f'"{key}"'}
        while True:
            answer = self.try_once("POST", "/v1/jobs", body, headers)
            if answer is not None:
                status, answer_headers, content = answer
                if status == 202:
                    self.repeats += answer_headers.get("Idempotent-Replayed") == "true"
                    return json.loads(content)
                if status not in (409, 503):
                    self.complain(f"{key}: {status} {content[:200]}")
            if self.ended.is_set():
                return None
            time.sleep(0.05)

    def try_once(self, *request):
        try:
            return self.service.ask(*request)
        except (OSError, http.client.HTTPException):
            return None  # it was killed just then

    def disturb(self, cycle):
        time.sleep(random.uniform(0.2, 2 * self.options.seconds))
        if self.options.stop and cycle % 4 == 0:
            self.service.process.send_signal(signal.SIGSTOP)
            time.sleep(LEASE + 1)
            self.service.process.send_signal(signal.SIGCONT)
            return
        self.service.kill()
        self.kills += 1
        self.service.start()

    def check(self, expected):
        states, attempts = collections.Counter(), collections.Counter()
        deadline = time.monotonic() + 600
        for id, (kind, key) in self.accepted.items():
            while True:
                status, _, content = self.service.ask("GET", f"/v1/jobs/{id}")
                if status != 200:
                    self.complain(f"{id} is lost: {status} {content[:200]}")
                    break
                job = json.loads(content)
                if job["state"] in ("succeeded", "failed", "canceled"):
                    self.check_job(job, kind, key, expected)
                    code = job.get("error", {}).get("code", "")
                    states[f"{kind}: {job['state']} {code}"] += 1
                    attempts[job["attempt"]] += 1
                    break
                if time.monotonic() > deadline:
                    self.complain(f"{id} does not end: {job}")
                    break
                time.sleep(0.05)
        return states, attempts

    def check_job(self, job, kind, key, expected):
        code = job.get("error", {}).get("code")
        worn_out = code == "worker_lost" and job["attempt"] == 3
        allowed = {"good": job["state"] == "succeeded", "broken": code == "unreadable_model",
                   "canceled": job["state"] in ("canceled", "succeeded")}[kind]
        if job.get("tag") != key or not (allowed or worn_out):
            self.complain(f"wrong state: {kind} {key} {job}")
        if job["state"] == "succeeded":
            status, _, content = self.service.ask("GET", f"/v1/jobs/{job['id']}/result")
            if status != 200 or without_times(content) != expected:
                self.complain(f"wrong result: {job['id']} {status} {content[:200]}")

    def check_keys(self):
        tags, cursor = collections.Counter(), ""
        while cursor is not None:
            part = json.loads(self.service.ask("GET", "/v1/jobs?limit=200" + cursor)[2])
            tags.update(job["tag"] for job in part["items"] if "tag" in job)
            cursor = "&cursor=" + part["next_cursor"] if "next_cursor" in part else None
        twice = [tag for tag, count in tags.items() if count > 1]
        if twice:
            self.complain(f"keys with more than one job: {twice[:5]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cycles", type=int, default=200)
    parser.add_argument("--clients", type=int, default=8)
    parser.add_argument("--seconds", type=float, default=1.0, help="mean time between kills")
    parser.add_argument("--stop", action="store_true", help="freeze it for longer than its lease, too")
    options = parser.parse_args()
    random.seed(1)
    with fresh_folder() as folder:
        service = Service(folder, "--lease", f"{LEASE}s", "--queue", "40").start()
        status, _, content = service.ask("POST", "/v1/jobs", submission("expected"),
                                         {"Content-Type": "application/json", "Prefer": "wait=60"})
        assert status == 200, content
        expected = json.loads(content)["result"]
        expected.pop("timing_ms")
        run = Run(service, options)
        clients = [threading.Thread(target=run.client, args=(n,)) for n in range(options.clients)]
        for client in clients:
            client.start()
        begun = time.monotonic()
        for cycle in range(1, options.cycles + 1):
            run.disturb(cycle)
            if cycle % 20 == 0:
                print(f"{cycle} cycles, {len(run.accepted)} jobs accepted, {time.monotonic() - begun:.0f} s", flush=True)
        run.ended.set()
        for client in clients:
            client.join()
        states, attempts = run.check(expected)
        run.check_keys()
        code = service.kill(signal.SIGTERM)
        if code != 0:
            run.complain(f"it ended with {code}")
        doctor = service.doctor()
        if doctor.returncode != 0:
            run.complain(doctor.stdout)
        print(f"{run.kills} kills, {len(run.accepted)} jobs accepted, {run.repeats} answers repeated by their key")
        print("states:", dict(sorted(states.items())), "attempts:", dict(sorted(attempts.items())))
        print("doctor:", doctor.stdout.strip().splitlines()[-1])
        print(f"{len(run.faults)} faults")
        sys.exit(1 if run.faults else 0)


if __name__ == "__main__":
    main()
