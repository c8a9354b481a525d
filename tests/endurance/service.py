"""A service under test: started, asked, stopped, killed."""

import base64
import http.client
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "client-examples" / "sample-last"


def program():
    path = os.environ.get("LASTFLAT", str(ROOT / "build" / "release" / "lastflat"))
    if not os.access(path, os.X_OK):
        sys.exit("LASTFLAT must name the program to test, such as build/release/lastflat")
    return path


def submission(tag, model=None, request=None):
    """The body of a job: the sample last, or another model."""
    if model is None:
        model = (SAMPLE / "last.obj").read_bytes()
        request = json.loads((SAMPLE / "last.request.json").read_text())
    return json.dumps({"model": {"data": base64.b64encode(model).decode()}, "request": {**(request or {}), "tag": tag}}).encode()


class Service:
    def __init__(self, data, *flags):
        self.data, self.flags = data, flags
        self.process = self.port = self.admin = None

    def start(self):
        self.log = open(pathlib.Path(self.data) / "log.json", "ab") if os.path.isdir(self.data) else subprocess.DEVNULL
        self.process = subprocess.Popen([program(), "serve", "--listen", "127.0.0.1:0", "--admin", "127.0.0.1:0", "--data", self.data,
                                         *self.flags], stdout=subprocess.PIPE, stderr=self.log, text=True)
        for name in ("admin on", "listening on"):
            line = self.process.stdout.readline()
            assert line.startswith(name), f"the service does not start: {line!r}"
            port = urllib.parse.urlsplit(line.split()[-1]).port
            if name == "admin on":
                self.admin = port
            else:
                self.port = port
        return self

    def kill(self, how=signal.SIGKILL):
        self.process.send_signal(how)
        code = self.process.wait()
        self.process.stdout.close()
        return code

    def connect(self, admin=False, timeout=60):
        return http.client.HTTPConnection("127.0.0.1", self.admin if admin else self.port, timeout=timeout)

    def ask(self, method, path, body=None, headers=None, connection=None):
        """Status, headers, body; a job is run even if its answer is there. Raises OSError or HTTPException if the service is
        not there."""
        own = connection or self.connect()
        own.request(method, path, body, {"Cache-Control": "no-cache", **(headers or {})})
        answer = own.getresponse()
        content = answer.read()
        if connection is None:
            own.close()
        return answer.status, answer.headers, content

    def doctor(self):
        return subprocess.run([program(), "doctor", "--data", self.data], capture_output=True, text=True)


def fresh_folder():
    return tempfile.TemporaryDirectory(prefix="lastflat-endurance-")
