#!/usr/bin/env python3
"""How much memory the service takes for one upload: at most 1.2 times its bytes, however they are sent.

    upload_memory.py [MIB]

$LASTFLAT is the program. Each row is one POST /v1/assets: the most memory (VmHWM) above that of the idle service.
Exit status 0: every upload was taken and stayed within the bound; 77: not measured, as the program is sanitized.
"""
import json
import os
import pathlib
import shutil
import socket
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "endurance"))
from service import Service  # noqa: E402

MOST = 1.2
PIECE = bytes(range(256)) * 4096
BOUNDARY = b"--------a-boundary"


def memory(process, name):
    for line in open(f"/proc/{process}/status", encoding="ascii"):
        if line.startswith(name + ":"):
            return int(line.split()[1]) << 10
    raise ValueError(f"/proc/{process}/status has no {name}")


def pieces(size):
    for _ in range(size // len(PIECE)):
        yield PIECE
    yield PIECE[:size % len(PIECE)]


def raw(size):
    return b"Content-Length: %d\r\n" % size, pieces(size)


def chunked(size):
    def body():
        for piece in pieces(size):
            if piece:
                yield b"%x\r\n" % len(piece) + piece + b"\r\n"
        yield b"0\r\n\r\n"
    return b"Transfer-Encoding: chunked\r\n", body()


def multipart(size):
    begin = b"--" + BOUNDARY + b'\r\nContent-Disposition: form-data; name="model"; filename="last.obj"\r\n\r\n'
    end = b"\r\n--" + BOUNDARY + b"--\r\n"

    def body():
        yield begin
        yield from pieces(size)
        yield end
    length = len(begin) + size + len(end)
    return b"Content-Type: multipart/form-data; boundary=%s\r\nContent-Length: %d\r\n" % (BOUNDARY, length), body()


def upload(port, head, body):
    with socket.create_connection(("127.0.0.1", port), 60) as client:
        client.sendall(b"POST /v1/assets HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + head + b"\r\n")
        for piece in body:
            client.sendall(piece)
        answer = b""
        while step := client.recv(65536):
            answer += step
    head, _, content = answer.partition(b"\r\n\r\n")
    return int(head.split()[1]), json.loads(content)


def measure(service, name, size, wanted, form):
    process = service.process.pid
    with open(f"/proc/{process}/clear_refs", "w", encoding="ascii") as peak:
        peak.write("5")  # the peak starts again
    idle, begun = memory(process, "VmRSS"), time.monotonic()
    status, asset = upload(service.port, *form(size))
    taken = (memory(process, "VmHWM") - idle) / size
    good = status == wanted and asset.get("bytes") == size and taken <= MOST
    print(f"{'ok  ' if good else 'FAIL'} {name} of {size} bytes: {status}, {taken:.3f} times its bytes "
          f"({time.monotonic() - begun:.2f} s)")
    return good


def main():
    program = pathlib.Path(os.environ.get("LASTFLAT", "build/release/lastflat"))
    contents = program.read_bytes()
    if b"__asan_init" in contents or b"__tsan_init" in contents:
        return 77
    mebibytes = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    size = mebibytes << 20
    # In memory if that can be: what a disk is worth is not measured here.
    shared = "/dev/shm" if shutil.disk_usage("/dev/shm").free > 6 * size else None
    with tempfile.TemporaryDirectory(prefix="lastflat-upload-", dir=shared) as folder:
        limits = ["--max-body-mb", str(mebibytes + 1), "--assets-per-key-mb", str(10 * mebibytes)]
        service = Service(folder, *limits).start()
        rows = [("raw", size, 201, raw), ("raw, known already", size, 200, raw), ("raw", size + 5, 201, raw),
                ("multipart", size + 7, 201, multipart), ("multipart, known already", size, 200, multipart),
                ("chunked", size + 3, 201, chunked)]
        try:
            return 0 if all([measure(service, *row) for row in rows]) else 1
        finally:
            service.kill()


if __name__ == "__main__":
    sys.exit(main())
