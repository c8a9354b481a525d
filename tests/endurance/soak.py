#!/usr/bin/env python3
"""Full load for a long time, good and bad traffic mixed: does memory stay flat, does health answer?

    tests/endurance/soak.py [--minutes 20] [--clients 6]

Clients post good jobs, broken models and broken requests, fetch results, follow events, cancel, delete, hold slow heads
open and hang up in the middle of bodies. Meanwhile health is asked ten times a second on both listeners and the
service's memory is looked at. Exit 0: health's 99th percentile is below 50 ms, memory at the end is within 5 % of that
after the first fifth, and nothing was answered that should not be.
"""

import argparse
import collections
import http.client
import json
import pathlib
import random
import signal
import socket
import statistics
import sys
import threading
import time

from service import Service, fresh_folder, submission

HOSTILE = pathlib.Path(__file__).resolve().parents[3] / "shared" / "hostile"
JSON = {"Content-Type": "application/json"}


class Soak:
    def __init__(self, service):
        self.service = service
        self.ended = threading.Event()
        self.lock = threading.Lock()
        self.answers = collections.Counter()
        self.faults = []
        self.health, self.memory = [], []
        self.hostile = [p.read_bytes() for p in sorted(HOSTILE.rglob("*")) if p.is_file() and 0 < p.stat().st_size < 300_000] or [b"hello"]

    def ask(self, expected, method, path, body=None, headers=None):
        status, _, content = self.service.ask(method, path, body, headers)
        with self.lock:
            self.answers[f"{method} {status}"] += 1
            if status not in expected:
                self.faults.append(f"{method} {path}: {status} {content[:200]}")
        return status, content

    def good(self, chance):
        status, content = self.ask((200, 202, 503), "POST", "/v1/jobs", submission(f"soak-{chance.random()}"), {**JSON, "Prefer": "wait=30"})
        if status == 200:
            path = json.loads(content)["links"]["self"]
            kind = chance.choice(("json", "svg", "glb", "obj"))
            self.ask((200,), "GET", f"{path}/result.{kind}", None, {"Accept-Encoding": chance.choice(("gzip", "identity"))})
            self.ask((200,), "GET", f"{path}/metrics")
            self.ask((200,), "GET", f"{path}/events")
            if chance.random() < 0.5:
                self.ask((204,), "DELETE", path)

    def broken(self, chance):
        self.ask((200, 202, 503), "POST", "/v1/jobs", submission("broken", chance.choice(self.hostile)), {**JSON, "Prefer": "wait=20"})
        self.ask((422,), "POST", "/v1/jobs", b'{"model": {"data": "AA"}, "request": {"lock": []}}', JSON)
        self.ask((404,), "GET", "/v1/jobs/" + "0" * 26)
        self.ask((200, 422, 413, 415, 503), "POST", "/v1/validate", chance.choice(self.hostile))

    def canceled(self, chance):
        status, content = self.ask((202, 503), "POST", "/v1/jobs", submission("canceled"), JSON)
        if status == 202:
            path = json.loads(content)["links"]["self"]
            time.sleep(chance.uniform(0, 0.3))
            self.ask((200, 202, 409), "POST", path + "/cancel")
            self.ask((200,), "GET", "/v1/jobs?limit=20")

    def rude(self, chance):
        with socket.create_connection(("127.0.0.1", self.service.port), timeout=30) as connection:
            connection.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000\r\n\r\nv 0 0 0\n")
            time.sleep(chance.uniform(0, 0.5))
        held = [socket.create_connection(("127.0.0.1", self.service.port), timeout=30) for _ in range(20)]
        for connection in held:
            connection.sendall(b"GET /v1/jobs HTTP/1.1\r\nX: ")
        time.sleep(chance.uniform(0, 0.5))
        for connection in held:
            connection.close()

    def client(self, number):
        chance = random.Random(number)
        while not self.ended.is_set():
            act = chance.choices((self.good, self.broken, self.canceled, self.rude), (6, 3, 2, 1))[0]
            try:
                act(chance)
            except (OSError, http.client.HTTPException) as error:
                with self.lock:
                    self.faults.append(f"{act.__name__}: {error!r}")

    def watch_health(self):
        main, admin = self.service.connect(), self.service.connect(admin=True)
        while not self.ended.is_set():
            for connection, path in ((main, "/healthz"), (admin, "/readyz")):
                begun = time.monotonic()
                status, _, content = self.service.ask("GET", path, connection=connection)
                self.health.append(1000 * (time.monotonic() - begun))
                if status != 200:
                    self.faults.append(f"{path}: {status} {content[:200]}")
            time.sleep(0.1)

    def watch_memory(self):
        while not self.ended.is_set():
            status = pathlib.Path(f"/proc/{self.service.process.pid}/status").read_text()
            self.memory.append(int(status.split("VmRSS:")[1].split()[0]) / 1024)
            time.sleep(1)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--clients", type=int, default=6)
    options = parser.parse_args()
    with fresh_folder() as folder:
        service = Service(folder, "--keep-results", "1m", "--keep-jobs", "2m").start()
        soak = Soak(service)
        threads = [threading.Thread(target=soak.client, args=(n,)) for n in range(options.clients)]
        threads += [threading.Thread(target=soak.watch_health), threading.Thread(target=soak.watch_memory)]
        for thread in threads:
            thread.start()
        for minute in range(int(options.minutes * 4)):
            time.sleep(15)
            if minute % 8 == 7:
                print(f"{(minute + 1) / 4:.0f} min: {sum(soak.answers.values())} answers, {soak.memory[-1]:.1f} MiB", flush=True)
        soak.ended.set()
        for thread in threads:
            thread.join()
        code = service.kill(signal.SIGTERM)
        doctor = service.doctor()
    warm = len(soak.memory) // 5
    begin, end = (statistics.median(part) for part in (soak.memory[warm:2 * warm], soak.memory[-warm:]))
    p99 = statistics.quantiles(soak.health, n=100)[98]
    print(f"answers: {dict(sorted(soak.answers.items()))}")
    print(f"health: {len(soak.health)} asked, median {statistics.median(soak.health):.1f} ms, 99 % below {p99:.1f} ms, most {max(soak.health):.1f} ms")
    print(f"memory: {begin:.1f} MiB after the first fifth, {end:.1f} MiB in the last ({100 * (end / begin - 1):+.1f} %), most {max(soak.memory):.1f}")
    print(f"doctor: {doctor.stdout.strip().splitlines()[-1]}")
    if code != 0:
        soak.faults.append(f"it ended with {code}")
    for fault in soak.faults[:20]:
        print("FAULT", fault)
    good = not soak.faults and doctor.returncode == 0 and p99 < 50 and end <= 1.05 * begin
    print("all is well" if good else f"not well: {len(soak.faults)} faults")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
