"""A running service, and requests to it of which each answer is held against the contract."""

import base64
import json
import math
import pathlib
import select
import socket
import sqlite3
import subprocess
import tempfile
import urllib.parse

from eventually import eventually

NO_JOB = "0" * 26
NO_ASSET = "0" * 64


def path_of(path, id):
    return path.replace("{id}", id).replace("{digest}", id if len(id) == 64 else NO_ASSET)


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

    def open(self, data, source="127.0.0.1"):
        """A connection from one of this machine's own addresses, each of which is a client."""
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=60, source_address=(source, 0))
        connection.sendall(data)
        return connection

    @staticmethod
    def first_answered(connections):
        answered = select.select(connections, [], [], 10)[0]
        assert answered, f"none of {len(connections)} connections is answered within 10 s"
        return answered[0]

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

    def ask(self, method, path, *, id=NO_JOB, query="", headers=(), body=None, version="HTTP/1.1", host="localhost", fresh=True):
        """`fresh`: a job is run, even if the answer is there."""
        lines = [f"{method} {path_of(path, id)}{query} {version}", f"Host: {host}", "Connection: close", *self.headers, *headers]
        if fresh:
            lines.append("Cache-Control: no-cache")
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
        return eventually(60, lambda: self.expect(200, None, "GET", "/v1/jobs/{id}", id=id), lambda job: job["state"] in states)


def see_key_in_flight(walk, path, body, media_type="model/obj"):
    """Two requests with a key while the store is locked by somebody else: one waits for it, the other is told so at once."""
    held = sqlite3.connect(pathlib.Path(walk.server.folder.name, "jobs.sqlite"), isolation_level=None)
    held.execute("BEGIN IMMEDIATE")
    head = (f"POST {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Type: {media_type}\r\n"
            f'Idempotency-Key: "twice"\r\nContent-Length: {len(body)}\r\n\r\n')
    asked = [walk.server.open(head.encode() + body) for _ in range(2)]
    refused = walk.server.first_answered(asked)
    asked.remove(refused)
    problem = walk.contract.check("POST", path, walk.server.read(refused))
    assert problem.get("code") == "key_in_flight", problem
    held.execute("ROLLBACK")
    held.close()
    return walk.contract.check("POST", path, walk.server.read(asked[0]))


def form(*parts):
    body = b"".join(b'--line\r\nContent-Disposition: form-data; name="%s"\r\n\r\n%s\r\n' % part for part in parts)
    return {"headers": ["Content-Type: multipart/form-data; boundary=line"], "body": body + b"--line--\r\n"}


def bumpy_disk(n):
    def height(x, y):
        return 6 * math.sin(200 * x / n / 9) * math.cos(200 * y / n / 11)
    points = [f"v {200 * x / n:.4f} {200 * y / n:.4f} {height(x, y):.4f}" for y in range(n) for x in range(n)]
    corners = [y * n + x + 1 for y in range(n - 1) for x in range(n - 1)]
    return "\n".join(points + [f"f {a} {a + 1} {a + n + 1} {a + n}" for a in corners]).encode()
