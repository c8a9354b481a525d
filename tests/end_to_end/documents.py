#!/usr/bin/env python3
"""Runs every example of every document on the sample last.

    LASTFLAT=build/release/lastflat tests/end_to_end/documents.py

An example is a fenced block of a Markdown file of the repository, or a command `lastflat flatten`, `inspect` or
`sample-last` with arguments between backticks. JSON is a request: the sample last is flattened by it, without a warning.
Shell is run line by line, in a folder that looks like the repository with the sample last in it, against a service of its
own. Left out are the lines that install and build (INSTALLS), which are a test run of their own, and the one that starts
the service. The examples of openapi.json are run by contract.py. Ends with 1 if an example does not do what it shows.
"""

import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from contract_service import Server

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["LASTFLAT"]).resolve()
INSTALLS = ("client-examples/quickstart.sh", "tests/run.sh")
WORDS = {"LAST": "last.obj", "MODEL": "last.obj", "REQUEST.json": "last.request.json", "REQUEST": "last.request.json",
         "DIR": "made"}
COMMAND = re.compile(r"`((?:build/release/)?lastflat (?:flatten|inspect|sample-last) [^`]+)`")


def documents():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.md"], capture_output=True, text=True, check=False).stdout
    return [ROOT / name for name in listed.split()] or sorted(ROOT.rglob("*.md"))


def examples(path):
    """(line number, language, text) of every fenced block, (line number, "sh", text) of every command in the prose."""
    language, begin, block = None, 0, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("```"):
            if language is None:
                language, begin, block = line[3:].strip(), number, []
            else:
                yield begin, language, "\n".join(block)
                language = None
        elif language is not None:
            block.append(line)
        else:
            for command in COMMAND.findall(line):
                yield number, "sh", command


class Bench:
    """A folder that looks like the repository, and a service."""

    def __init__(self, folder, url):
        self.folder, self.url, self.job = folder, url, None
        (folder / "build/release").mkdir(parents=True)
        (folder / "build/release/lastflat").symlink_to(PROGRAM)
        (folder / "client-examples").symlink_to(ROOT / "client-examples")
        for file in (ROOT / "client-examples/sample-last").iterdir():
            (folder / file.name).write_bytes(file.read_bytes())
        tools = folder / "tools"
        tools.mkdir()
        (tools / "lastflat").symlink_to(PROGRAM)
        (tools / "curl").write_text(f'#!/bin/sh\nexec {shlex.quote(self.real_curl())} -sS -f "$@"\n')  # an error ends it
        (tools / "curl").chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "LASTFLAT_URL": url}

    @staticmethod
    def real_curl():
        return subprocess.run(["sh", "-c", "command -v curl"], capture_output=True, text=True, check=True).stdout.strip()

    def run(self, command):
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=120, check=False)
        return done.stdout if done.returncode == 0 else None, done.stderr

    def flatten(self, request):
        """Why the request does not run on the sample last; nothing: it does."""
        (self.folder / "example.json").write_text(request)
        said, fault = self.run("lastflat flatten last.obj --request example.json --out made --json")
        if said is None:
            return fault
        return json.dumps(json.loads(said)["warnings"]) if json.loads(said)["warnings"] else None

    def shell(self, line):
        command = line.replace("http://127.0.0.1:8080", self.url)
        for word, value in WORDS.items():
            command = re.sub(rf"(?<![\w/.]){re.escape(word)}(?![\w.])", value, command)
        if self.job:
            command = re.sub(r"/ID\b", "/" + self.job, command)
        said, fault = self.run(command)
        if said is None:
            return fault or "it failed"
        if said.startswith('{"id":'):
            self.job = json.loads(said)["id"]
        return None


def main():
    faults, seen = 0, 0
    with tempfile.TemporaryDirectory(prefix="lastflat-documents-") as folder:
        server = Server(PROGRAM)
        bench = Bench(pathlib.Path(folder), f"http://127.0.0.1:{server.port}")
        for path in documents():
            for number, language, text in examples(path):
                where = f"{path.relative_to(ROOT)}:{number}"
                if language == "json":
                    outcomes = [(text, bench.flatten(text))]
                elif language == "sh":
                    lines = [line for line in text.splitlines() if line.strip() and not line.startswith(INSTALLS)
                             and not line.startswith("lastflat serve ")]
                    outcomes = [(line, bench.shell(line)) for line in lines]
                else:
                    outcomes = [(text, f"a block of '{language}', which nobody runs")]
                for example, fault in outcomes:
                    seen += 1
                    if fault:
                        faults += 1
                        print(f"FAULT {where}: {example}\n  {fault.strip()}")
        server.stop()
    print(f"{seen} examples, {faults} faults")
    return 1 if faults or seen < 8 else 0


if __name__ == "__main__":
    sys.exit(main())
