#!/usr/bin/env python3
"""Ten keys misbehave at once, each in a way of its own; what does an eleventh notice?

    tests/endurance/misbehaving.py [--seconds 20]

Slow bodies, answers that nobody reads, a queue full of slow jobs, a full batch, long polls that hang up, event streams,
large JSON of small objects, heavy validations, half heads, dead receivers of webhooks. Beside them one key posts a
small job, again and again, and is told of its end; health is asked all the time. Exit 0: health's 99th percentile is
below 20 ms and never fails, no small job takes longer than 30 s (two others are running when it comes), no webhook
more than 5 s, and nothing that the key asks is refused.
"""

import argparse
import base64
import http.client
import http.server
import json
import multiprocessing
import os
import signal
import socket
import statistics
import subprocess
import sys
import threading
import time

from rates import slow_model
from service import Service, fresh_folder, program, submission

JSON = "application/json"


class Misbehaviour:
    """One key's, in a process of its own."""

    def __init__(self, port, key, dead):
        self.port, self.key, self.dead = port, key, dead

    def open(self, head, body=b""):
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=30)
        connection.sendall(f"{head}\r\nHost: localhost\r\nAuthorization: Bearer {self.key}\r\n".encode() + body)
        return connection

    def ask(self, method, path, body=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, path, body, {"Authorization": "Bearer " + self.key, "Cache-Control": "no-cache", **named})
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def crowd(self, act, count=64):
        """`act` again and again on so many threads; what the service does to it is its own affair."""
        def again():
            while True:
                try:
                    act()
                except (OSError, http.client.HTTPException):
                    time.sleep(0.05)
        threads = [threading.Thread(target=again, daemon=True) for _ in range(count)]
        for thread in threads:
            thread.start()
        threads[0].join()

    def waiting_job(self, before=0):
        """A job that takes about a second alone, behind so many of its own kind."""
        model = slow_model(70)
        return [json.loads(self.ask("POST", "/v1/jobs", model)[1]) for _ in range(before + 1)][-1]

    def slow_bodies(self):
        def act():
            with self.open("POST /v1/assets HTTP/1.1", b"Content-Length: 100000\r\n\r\nv 0 0 0\n") as connection:
                while True:
                    connection.sendall(b" ")
                    time.sleep(1)
        self.crowd(act)

    def unread_answers(self):
        job = self.waiting_job()
        while json.loads(self.ask("GET", job["links"]["self"], Prefer="wait=60")[1])["state"] != "succeeded":
            pass
        path = job["links"]["result"]

        def act():
            with socket.socket() as connection:
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                connection.connect(("127.0.0.1", self.port))
                asked = f"GET {path} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {self.key}\r\n\r\n"
                connection.sendall(20 * asked.encode())
                time.sleep(30)
        self.crowd(act)

    def full_queue(self):
        model = slow_model(70)
        self.crowd(lambda: self.ask("POST", "/v1/jobs", model) or time.sleep(0.1), 4)

    def full_batch(self):
        model = base64.b64encode(slow_model(60)).decode()
        body = json.dumps({"jobs": [{"model": {"data": model}}] * 200})
        self.crowd(lambda: self.ask("POST", "/v1/jobs:batch", body, Content_Type=JSON), 2)

    def polls_that_hang_up(self):
        job = self.waiting_job(50)

        def act():
            with self.open(f"GET {job['links']['self']} HTTP/1.1", b"Prefer: wait=60\r\n\r\n"):
                time.sleep(0.2)
        self.crowd(act)

    def event_streams(self):
        job = self.waiting_job(50)

        def act():
            with self.open(f"GET {job['links']['events']} HTTP/1.1", b"\r\n") as connection:
                while connection.recv(1000):
                    pass
        self.crowd(act)

    def large_json(self):
        body = b'{"model": {"data": "' + b'AA", "x": [' + b'{"a":1},' * 120_000 + b"0]}}"
        self.crowd(lambda: self.ask("POST", "/v1/jobs", body, Content_Type=JSON), 16)

    def heavy_validations(self):
        model = slow_model(100)
        self.crowd(lambda: self.ask("POST", "/v1/validate", model), 16)

    def half_heads(self):
        def act():
            with socket.create_connection(("127.0.0.1", self.port)) as connection:
                connection.sendall(b"GET /v1/jobs HTTP/1.1\r\nX: ")
                time.sleep(5)
        self.crowd(act, 300)

    def dead_receivers(self):
        for path in range(16):
            hook = json.dumps({"url": f"http://127.0.0.1:{self.dead}/{path}"})
            self.ask("POST", "/v1/webhooks", hook, Content_Type=JSON)
        self.crowd(lambda: self.ask("POST", "/v1/jobs", b"v 0 0 0\nf 1 2 3\n") and time.sleep(0.2), 1)


KINDS = [name for name in vars(Misbehaviour) if not name.startswith("_") and name not in ("open", "ask", "crowd", "waiting_job")]


def misbehave(kind, port, key, dead):
    os.nice(19)  # it stands for another machine
    getattr(Misbehaviour(port, key, dead), kind)()


class Receiver(http.server.ThreadingHTTPServer):
    """Of the eleventh key's webhook: notes when it is told of which job."""

    daemon_threads = True

    def __init__(self):
        told = self.told = {}

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                message = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                told[message["data"].get("id")] = time.monotonic()
                self.send_response(204)
                self.end_headers()

            def log_message(self, *_):
                pass
        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Eleventh:
    def __init__(self, service, key, receiver):
        self.service, self.receiver = service, receiver
        self.bearer = {"Authorization": "Bearer " + key}
        self.jobs, self.hooks, self.gets, self.refused = [], [], [], []

    def ask(self, expected, method, path, body=None, **headers):
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        status, _, content = self.service.ask(method, path, body, {**self.bearer, **named})
        if status not in expected:
            self.refused.append(f"{method} {path} {status} {content[:200]}")
        return content

    def small_job(self, count):
        begun = time.monotonic()
        job = json.loads(self.ask((200,), "POST", "/v1/jobs", submission(f"small-{count}"), Content_Type=JSON, Prefer="wait=60"))
        ended = time.monotonic()
        self.jobs.append(ended - begun)
        while job.get("id") not in self.receiver.told and time.monotonic() - ended < 30:
            time.sleep(0.02)
        self.hooks.append(self.receiver.told.get(job.get("id"), ended + 30) - ended)
        begun = time.monotonic()
        self.ask((200,), "GET", "/v1/jobs?limit=1")
        self.gets.append(time.monotonic() - begun)

    def run(self, seconds):
        hook = json.dumps({"url": f"http://127.0.0.1:{self.receiver.server_address[1]}/"})
        self.ask((201,), "POST", "/v1/webhooks", hook, Content_Type=JSON)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.small_job(len(self.jobs))


def ask_health(service, ended, times, failures):
    connection = service.connect()
    while not ended.is_set():
        begun = time.monotonic()
        try:
            connection.request("GET", "/healthz")
            answer = connection.getresponse()
            failed = answer.status != 200 or not answer.read()
        except (OSError, http.client.HTTPException):
            failed = True
            connection.close()
        if failed:
            failures.append(time.monotonic())
        times.append(time.monotonic() - begun)
        time.sleep(0.02)


def percentile(times, part):
    return sorted(times)[min(len(times) - 1, int(len(times) * part))]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20)
    options = parser.parse_args()
    dead = socket.create_server(("127.0.0.1", 0), backlog=512)  # accepts, as the kernel does, and never answers
    receiver = Receiver()
    with fresh_folder() as folder:
        keys = [subprocess.run([program(), "keys", "add", name, "--data", folder], check=True, capture_output=True, text=True).stdout.strip()
                for name in [*KINDS, "eleventh"]]
        service = Service(folder, "--webhooks", "any", "--rate", "0").start()
        others = [multiprocessing.Process(target=misbehave, args=(kind, service.port, key, dead.getsockname()[1]), daemon=True)
                  for kind, key in zip(KINDS, keys)]
        for other in others:
            other.start()
        time.sleep(3)
        health, failures, ended = [], [], threading.Event()
        prober = threading.Thread(target=ask_health, args=(service, ended, health, failures))
        prober.start()
        eleventh = Eleventh(service, keys[-1], receiver)
        eleventh.run(options.seconds)
        ended.set()
        prober.join()
        died = [kind for kind, other in zip(KINDS, others) if not other.is_alive()]
        for other in others:
            other.kill()
        code = service.kill(signal.SIGTERM)
    p99 = 1000 * percentile(health, 0.99)
    print(f"{len(KINDS)} keys misbehave: {', '.join(KINDS)}")
    print(f"health: {len(health)} times, median {1000 * statistics.median(health):.1f} ms, 99 % below {p99:.1f} ms, most {1000 * max(health):.1f} ms")
    print(f"the eleventh key: {len(eleventh.jobs)} jobs, median {statistics.median(eleventh.jobs):.2f} s, most {max(eleventh.jobs):.2f} s; "
          f"its webhook after {statistics.median(eleventh.hooks):.2f} s, most {max(eleventh.hooks):.2f} s; list: most {1000 * max(eleventh.gets):.0f} ms")
    print(f"{len(eleventh.refused)} refusals {eleventh.refused[:3]}, the service ended with {code}")
    print(f"{len(failures)} failures of health; of those who misbehave {len(died)} died {died}")
    good = not failures and not died and not eleventh.refused and code == 0 and len(eleventh.jobs) > 0
    sys.exit(0 if good and p99 < 20 and max(eleventh.jobs) < 30 and max(eleventh.hooks) < 5 else 1)


if __name__ == "__main__":
    main()
