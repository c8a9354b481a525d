#!/usr/bin/env python3
"""Loses and damages the database in every way, and looks at what the service does.

    tests/endurance/lost_database.py

Before each start the data folder of a service that had a key, a job and a result is spoilt in one way. Wherever the
database is lost, the service must not start, must say what to do and must leave every blob where it is; once the
database is put back it starts, knows its key and hands out the result. Exit 0: so it is.
"""

import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import time

from service import Service, fresh_folder, program, submission

faults = []


def check(name, good, note=""):
    print(f"{'ok  ' if good else 'FAIL'} {name} {note}", flush=True)
    if not good:
        faults.append(name)


class Case:
    """A copy of a sound data folder."""

    def __init__(self, folder, key, result):
        self.folder, self.key, self.result = pathlib.Path(folder), key, result
        self.database, self.mark = self.folder / "jobs.sqlite", self.folder / "database"

    def restore(self, sound):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(sound, self.folder)

    def blobs(self):
        return sorted(str(file) for file in (self.folder / "blobs").glob("*/*"))

    def start(self):
        """The service, or what it said when it did not start."""
        service = Service(str(self.folder))
        try:
            return service.start(), ""
        except AssertionError:
            service.process.kill()
            service.process.wait()
            return None, (self.folder / "log.json").read_text()

    def answers_as_before(self, name):
        service, said = self.start()
        if service is None:
            return check(name, False, said.strip()[-300:])
        status, _, content = service.ask("GET", self.result, None, {"Authorization": "Bearer " + self.key})
        stranger = service.ask("GET", self.result)[0]
        service.kill()
        check(name, status == 200 and len(content) > 1000 and stranger == 401, f"({status}, without the key {stranger})")


def page_of(database, number):
    size = 4096
    with open(database, "r+b") as file:
        file.seek(number * size)
        file.write(b"\xa5" * size)


def empty(case):
    case.database.write_bytes(b"")


def garbage(case):
    case.database.write_bytes(b"no database at all " * 1000)


def half(case):
    data = case.database.read_bytes()
    case.database.write_bytes(data[: len(data) // 2])


def folder_instead(case):
    case.database.unlink()
    case.database.mkdir()


def another(case):
    subprocess.run([program(), "keys", "add", "other", "--data", str(case.folder / "other")], check=True, capture_output=True)
    shutil.move(case.folder / "other" / "jobs.sqlite", case.database)


def only_blobs(case):
    case.database.unlink()
    case.mark.unlink()


def only_mark(case):
    case.database.unlink()
    shutil.rmtree(case.folder / "blobs")


def newer(case):
    with sqlite3.connect(case.database) as database:
        database.execute("PRAGMA user_version=99")


LOST = {
    "removed": lambda case: case.database.unlink(), "empty": empty, "no database": garbage, "cut in half": half,
    "its first page overwritten": lambda case: page_of(case.database, 0),
    "a page in its middle overwritten": lambda case: page_of(case.database, 5),
    "a folder in its place": folder_instead, "another service's": another, "gone with its mark": only_blobs,
    "gone with all blobs": only_mark, "of a newer program": newer,
}


def lost_before_a_start(case, sound):
    for name, spoil in LOST.items():
        case.restore(sound)
        before = case.blobs()
        spoil(case)
        kept = case.blobs() if name == "gone with all blobs" else before
        (case.folder / "log.json").unlink(missing_ok=True)
        service, said = case.start()
        if service is not None:
            service.kill()
        last = said.strip().splitlines()[-1] if said.strip() else ""
        check(name + ": it does not start", service is None and "database" in said, last[-160:])
        says_mend = "backup" in said or "newer program" in said
        check(name + ": it says what to do, and every blob stays", says_mend and case.blobs() == kept)
        shutil.rmtree(case.database) if case.database.is_dir() else case.database.unlink(missing_ok=True)
        for more in ("jobs.sqlite-wal", "jobs.sqlite-shm"):
            (case.folder / more).unlink(missing_ok=True)
        shutil.copy(pathlib.Path(sound) / "jobs.sqlite", case.database)
        if name != "gone with all blobs":
            case.answers_as_before(name + ": put back, all is there")


def harmless(case, sound):
    case.restore(sound)
    (case.folder / "jobs.sqlite-wal").write_bytes(b"torn" * 5000)
    case.answers_as_before("a log file of garbage: the database itself counts")
    case.restore(sound)
    case.mark.unlink()
    case.answers_as_before("made by a version without marks")


def lost_while_running(case, sound):
    case.restore(sound)
    service, _ = case.start()
    admin = service.connect(admin=True)
    ready = service.ask("GET", "/readyz", connection=admin)[0]
    case.database.rename(case.folder / "away")
    bearer = {"Authorization": "Bearer " + case.key, "Content-Type": "application/json"}
    gone = service.ask("GET", "/readyz", connection=admin)[0]
    health = service.ask("GET", "/healthz")[0]
    posted = service.ask("POST", "/v1/jobs", submission("late"), bearer)[0]
    log = (case.folder / "log.json").read_text()
    (case.folder / "away").rename(case.database)
    back = service.ask("GET", "/readyz", connection=admin)[0]
    taken = service.ask("POST", "/v1/jobs", submission("late"), bearer)[0]
    service.kill()
    check("removed while it runs: not ready, takes nothing, alive; put back: as before",
          (ready, gone, health, posted, back, taken) == (200, 503, 200, 503, 200, 202),
          f"(ready {ready}, {gone}, health {health}, post {posted}, then {back}, {taken})")
    check("removed while it runs: the log says the cause", "was removed or replaced" in log)


def spoilt_blobs(case, sound):
    for name, spoil in (("gone", lambda blob: blob.unlink()), ("cut", lambda blob: blob.write_bytes(blob.read_bytes()[:100]))):
        case.restore(sound)
        for blob in (case.folder / "blobs").glob("*/*"):
            spoil(blob)
        service, _ = case.start()
        status, _, content = service.ask("GET", case.result, None, {"Authorization": "Bearer " + case.key})
        service.kill()
        check(f"a blob that is {name}: 500", status == 500 and json.loads(content)["code"] == "result_corrupt", f"({status})")


def main():
    with fresh_folder() as root:
        sound = pathlib.Path(root) / "sound"
        added = subprocess.run([program(), "keys", "add", "factory", "--data", str(sound)], check=True, capture_output=True, text=True)
        key = added.stdout.strip()
        service = Service(str(sound)).start()
        headers = {"Authorization": "Bearer " + key, "Content-Type": "application/json", "Prefer": "wait=60"}
        status, _, content = service.ask("POST", "/v1/jobs", submission("sound"), headers)
        assert status == 200, content
        time.sleep(0.2)
        service.kill(15)
        case = Case(pathlib.Path(root) / "case", key, json.loads(content)["links"]["result"])
        lost_before_a_start(case, sound)
        harmless(case, sound)
        lost_while_running(case, sound)
        spoilt_blobs(case, sound)
    print(f"{len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
