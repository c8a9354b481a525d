#!/usr/bin/env python3
"""Attacks a running server and checks how it answers.

    attacks.py PORT [--get PATH] [--post PATH] [--body-bytes N]

PATH of --get is a cheap route for GET, that of --post a route that takes a body of any type; N is the
server's limit for a body. Exit status 0: every attack was answered as it should be.
"""
import argparse
import gzip
import resource
import socket
import sys
import threading
import time

LIST = b"/v1/jobs"  # neither express nor cheap
failures = []


def connect(port, timeout=20.0, source="127.0.0.1"):
    return socket.create_connection(("127.0.0.1", port), timeout, (source, 0))


def receive(client):
    received = b""
    try:
        while True:
            step = client.recv(65536)
            if not step:
                break
            received += step
    except OSError:
        pass
    return received


def send_all(client, pieces):
    """Sends until the server stops it; returns how many bytes went out."""
    sent = 0
    try:
        for piece in pieces:
            client.sendall(piece)
            sent += len(piece)
    except OSError:
        pass
    return sent


def status(answer):
    return int(answer[9:12]) if answer.startswith(b"HTTP/1.1 ") else 0


def final_status(answer):
    while status(answer) == 100:
        answer = answer.partition(b"\r\n\r\n")[2]
    return status(answer)


def check(name, wanted, found, note=""):
    wanted = wanted if isinstance(wanted, tuple) else (wanted,)
    good = found in wanted
    print(f"{'ok  ' if good else 'FAIL'} {name}: {found} {note}")
    if not good:
        failures.append(name)


class Attacks:
    def __init__(self, options):
        self.port = options.port
        self.get = options.get.encode()
        self.post = options.post.encode()
        self.body_bytes = options.body_bytes

    def get_head(self, headers=b"Connection: close\r\n"):
        return b"GET " + self.get + b" HTTP/1.1\r\nHost: localhost\r\n" + headers + b"\r\n"

    def post_head(self, headers=b""):
        return b"POST " + self.post + b" HTTP/1.1\r\nHost: localhost\r\n" + headers + b"\r\n"

    def pipelined(self):
        """Three requests in one segment, the last of which asks to close: three answers."""
        answer = self.ask(self.get_head(b"") * 2 + self.get_head())
        check("three pipelined GETs", 3, answer.count(b"HTTP/1.1 200"))

    def ask(self, raw):
        with connect(self.port) as client:
            send_all(client, [raw])
            return receive(client)

    def row(self, name, raw, wanted):
        start = time.monotonic()
        answer = self.ask(raw)
        note = f"({(time.monotonic() - start) * 1000:.0f} ms, {answer.count(b'HTTP/1.1 ')} answers)"
        check(name, wanted, final_status(answer), note)
        if answer.replace(b"HTTP/1.1 100", b"").count(b"HTTP/1.1 ") > 1:
            failures.append(name + ": more than one answer")

    def heads(self):
        self.row("plain GET", self.get_head(), 200)
        for value in (b"abc", b"0x5", b"+5", b"5, 5", b"-1"):
            self.row(f"Content-Length {value}", self.post_head(b"Content-Length: " + value + b"\r\n"), 400)
        self.row("Content-Length 2^64", self.post_head(b"Content-Length: 18446744073709551616\r\n"), 413)
        self.row("Content-Length 1e11, no body", self.post_head(b"Content-Length: 100000000000\r\n"), 413)
        self.row("two Content-Length", self.post_head(b"Content-Length: 5\r\nContent-Length: 6\r\n"), 400)
        self.row("TE and CL", self.post_head(b"Content-Length: 4\r\nTransfer-Encoding: chunked\r\n") +
                 b"0\r\n\r\n" + self.get_head(), 400)
        self.row("xchunked", self.post_head(b"Transfer-Encoding: xchunked\r\n"), 501)
        self.row("gzip, chunked", self.post_head(b"Transfer-Encoding: gzip, chunked\r\n"), 501)
        self.row("gzip body", self.post_head(b"Content-Encoding: gzip\r\nContent-Length: 9\r\n"), 415)
        self.row("POST without length", self.post_head(b"Connection: close\r\n"), (200, 400, 411, 415, 422))
        self.row("GET with a body that is a request",
                 self.get_head(b"Content-Length: 40\r\n") + self.get_head(), 400)
        self.pipelined()
        self.row("no Host", b"GET " + self.get + b" HTTP/1.1\r\n\r\n", 400)
        self.row("absolute URI", b"GET http://localhost/ HTTP/1.1\r\nHost: localhost\r\n\r\n", 400)
        self.row("unknown method", b"BREW / HTTP/1.1\r\nHost: localhost\r\n\r\n", 501)
        self.row("wrong method", b"DELETE " + self.get + b" HTTP/1.1\r\nHost: localhost\r\n\r\n", 405)
        self.row("encoded CR LF in a header", self.get_head(b"X: a%20b%0d%0aX: y\r\n"), 400)
        self.row("NUL in a header", self.get_head(b"X: a\0b\r\n"), 400)
        for text in (b"%00", b"%0d%0a", b"%7f", b"%ff"):
            self.row(f"{text} in the path", b"GET /a" + text + b" HTTP/1.1\r\nHost: localhost\r\n\r\n", 400)
        self.row("%2f in the path", b"GET /a%2fb HTTP/1.1\r\nHost: localhost\r\n\r\n", 404)
        self.row("folded header", self.get_head(b"X: a\r\n b\r\n"), 400)
        self.row("bare LF", b"GET / HTTP/1.1\nHost: a\n\n", 400)
        self.row("TLS hello", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(500), 400)
        self.row("2600 ranges", self.get_head(b"Range: bytes=" + b"0-," * 2599 + b"0-\r\n"), 400)
        self.row("range past the end", self.get_head(b"Connection: close\r\nRange: bytes=0-9999999999\r\n"), 200)

    def sizes(self):
        self.row("URI of 8180 bytes", b"GET /" + b"a" * 8180 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n", 414)
        self.row("header of 20000 bytes", self.get_head(b"X: " + b"a" * 20000 + b"\r\n"), 431)
        self.row("101 headers", self.get_head(b"".join(b"X%d: y\r\n" % i for i in range(100))), 431)
        self.row("100000 headers", self.get_head(b"X: y\r\n" * 100000), 431)
        self.stream("request line of 1 GiB", b"GET /", b"a" * 65536, 1 << 30, (0, 414))
        self.stream("header line of 64 MiB", b"GET / HTTP/1.1\r\nX: ", b"a" * 65536, 64 << 20, (0, 431))
        chunk = b"10000\r\n" + b"x" * 65536 + b"\r\n"
        chunked = self.post_head(b"Transfer-Encoding: chunked\r\n")
        self.stream("chunked body over the limit", chunked, chunk, self.body_bytes + (64 << 20), (0, 413))
        self.stream("announced body over the limit",
                    self.post_head(b"Content-Length: %d\r\n" % (self.body_bytes + 1)), chunk,
                    self.body_bytes, (0, 413))
        for text in (b"-2\r\n", b"0x5\r\nhello\r\n0\r\n\r\n", b" 5\r\nhello\r\n0\r\n\r\n", b"5\nhello\n0\n\n",
                     b"5\r\nhello0\r\n\r\n", b"0\r\nX: y\r\n\r\n", b"ffffffffffffffff1\r\n"):
            self.row(f"chunk {text[:14]}", chunked + text, (400, 413))

    def forms(self):
        """Multipart tricks, and a compressed bomb: 300 MiB of zeros in 300 kB."""
        def form(*parts, type=b"multipart/form-data; boundary=B", end=b"--B--\r\n"):
            body = b"".join(b"--B\r\n" + head + b"\r\n\r\n" + data + b"\r\n" for head, data in parts) + end
            return self.post_head(b"Connection: close\r\nContent-Type: " + type + b"\r\nContent-Length: %d\r\n" % len(body)) + body
        model = b'Content-Disposition: form-data; name="model"'
        self.row("1100 parts", form(*[(model, b"")] * 1100), 400)
        self.row("no last boundary", form((model, b"v 0 0 0"), end=b""), 400)
        self.row("no boundary", form((model, b""), type=b"multipart/form-data"), 400)
        self.row("file name before name", form((b'Content-Disposition: form-data; filename="x"; name="model"', b"hello")), (202, 422))
        self.row("file name of 8 kB", form((model + b"; filename*=UTF-8''" + b"a" * 8000, b"hello")), (202, 400, 422))
        self.row("a path as file name", form((model + b'; filename="../../etc/passwd"', b"hello")), (202, 422))
        bomb = gzip.compress(bytes(300 << 20), 9)
        self.row("a compressed bomb", self.post_head(b"Content-Encoding: gzip\r\nContent-Length: %d\r\n" % len(bomb)) + bomb, 415)
        deep = b'{"model": {"data": "AA"}, "request": ' + b"[" * 100000 + b"]" * 100000 + b"}"
        self.row("JSON 100000 deep", self.post_head(
            b"Connection: close\r\nContent-Type: application/json\r\nContent-Length: %d\r\n" % len(deep)) + deep, (400, 422))

    def stream(self, name, head, piece, most, wanted):
        start = time.monotonic()
        with connect(self.port) as client:
            sent = send_all(client, [head] + [piece] * (most // len(piece)))
            answer = receive(client)
        note = f"({sent} bytes went out in {time.monotonic() - start:.2f} s)"
        check(name, wanted, final_status(answer), note)
        if sent > most // 2 and most > self.body_bytes * 2:
            failures.append(name + ": the server read on")

    def crowds(self):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[0] - 100
        for count in (64, 1000, 10000):
            if count > most:
                print(f"skip {count} idle connections: the limit on open files is too low")
                continue
            clients = [connect(self.port) for _ in range(count)]
            self.ping(f"GET beside {count} idle connections")
            for client in clients:
                client.close()
        slow = [connect(self.port) for _ in range(64)]
        for client in slow:
            send_all(client, [b"GET / HTTP/1.1\r\nX: "])
        self.ping("GET beside 64 slow heads")
        for client in slow:
            client.close()

    def strangers(self):
        """A web page, a name that was bound anew, a proxy: the service is this machine's user's."""
        head = lambda host, headers: b"GET " + LIST + b" HTTP/1.1\r\nConnection: close\r\nHost: " + host + b"\r\n" + headers + b"\r\n"
        self.row("asked under another name (before: 200)", head(b"evil.example", b""), 403)
        for page in (b"Origin: https://evil.example", b"Origin: null", b"Sec-Fetch-Site: cross-site"):
            self.row(f"{page} (before: 200)", head(b"localhost", page + b"\r\n"), 403)
        for proxy in (b"Via: 1.1 a", b"X-Real-IP: 192.0.2.1", b"X-Forwarded-Host: a", b"CF-Connecting-IP: 192.0.2.1", b"Forwarded: for=a"):
            self.row(f"{proxy} (before: {401 if proxy.startswith(b'Forwarded') else 200})", head(b"localhost", proxy + b"\r\n"), 401)
        self.row("an unknown parameter (before: 200)", b"GET " + self.get + b"?stat=queued HTTP/1.1\r\nConnection: close\r\nHost: localhost\r\n\r\n", 400)

    def small_values(self):
        """64 bodies of 1 MB of small objects at once (before: 20 s of a processor for each, none read in 20 s)."""
        body = b'{"model": {"asset_id": "a"}, "request": {"curves": [' + b'{"a":1},' * 125_000 + b'{"a":1}]}}'
        head = self.post_head(b"Connection: close\r\nContent-Type: application/json\r\nContent-Length: %d\r\n" % len(body))
        answers = []
        threads = [threading.Thread(target=lambda: answers.append(final_status(self.ask(head + body)))) for _ in range(64)]
        start = time.monotonic()
        for thread in threads:
            thread.start()
        self.ping("another's GET beside 64 bodies of small objects (before: 1063 ms)", LIST, "127.0.0.2")
        for thread in threads:
            thread.join()
        check("64 bodies of small objects", (422, 429), max(answers), f"({time.monotonic() - start:.1f} s, {answers.count(422)} read)")

    def hogs(self):
        """One address sends and reads so slowly that it keeps what it has."""
        hogs = [connect(self.port) for _ in range(128)]
        for i, hog in enumerate(hogs):
            send_all(hog, [self.post_head(b"Content-Length: 100000\r\n") + b"v" if i % 2 else self.get_head(b"") * 200])
        time.sleep(1.0)
        self.ping("another's GET beside 64 who send slowly and 64 who do not read (before: none in 20 s)", LIST, "127.0.0.2")
        for hog in hogs:
            hog.close()

    def ping(self, name, path=None, source="127.0.0.1"):
        start = time.monotonic()
        with connect(self.port, source=source) as client:
            send_all(client, [b"GET " + (path or self.get) + b" HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"])
            answer = receive(client)
        elapsed = time.monotonic() - start
        check(name, 200, final_status(answer), f"({elapsed * 1000:.1f} ms)")
        if elapsed > 1.0:
            failures.append(name + ": too slow")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("port", type=int)
    parser.add_argument("--get", default="/healthz")
    parser.add_argument("--post", default="/v1/jobs")
    parser.add_argument("--body-bytes", type=int, default=256 << 20)
    attacks = Attacks(parser.parse_args())
    attacks.heads()
    attacks.sizes()
    attacks.forms()
    attacks.strangers()
    attacks.small_values()
    attacks.hogs()
    attacks.crowds()
    print("\n".join(["failed: " + name for name in failures]) or "all as it should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
