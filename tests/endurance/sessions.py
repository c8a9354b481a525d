#!/usr/bin/env python3
"""How long the answer to a change of a live session takes, over HTTP on loopback.

    tests/endurance/sessions.py HALF.obj HALF.request.json [--changes 200]

The model is one half, locked along vertex paths. Changes come 30 a second, or when the one before is done. Prints
median and 95th percentile of: a pin dragged in steps of 0.2 mm, a weight and a lock changed, a drawn line of 21 points
dragged in one session and in three at once; and the pin again on the half with every triangle cut into four.
"""

import argparse
import json
import math
import pathlib
import statistics
import threading
import time

from service import Service, fresh_folder

POINTS = "application/vnd.lastflat.points"


PACE = 1 / 30  # seconds from one change to the next: a hand that drags


class Session:
    def __init__(self, service, model, request):
        self.service, self.connection = service, service.connect()
        self.sequence, self.due = 0, 0.0
        digest = self.send("POST", "/v1/assets", model, "application/octet-stream")["id"]
        body = json.dumps({"model": {"asset_id": digest}, "request": request})
        self.state = self.send("POST", "/v1/sessions", body, "application/json")
        self.path = "/v1/sessions/" + self.state["id"]

    def send(self, method, path, body, media_type, accept="application/json"):
        status, _, content = self.service.ask(method, path, body, {"Content-Type": media_type, "Accept": accept},
                                              self.connection)
        if status >= 300:
            raise SystemExit(f"{method} {path}: {status} {content[:300]}")
        return json.loads(content) if accept != POINTS and content else content

    def change(self, patch):
        """Seconds until the points are here; at the pace of a hand."""
        time.sleep(max(0.0, self.due - time.perf_counter()))
        self.sequence += 1
        begin = time.perf_counter()
        self.due = begin + PACE
        self.send("PATCH", f"{self.path}?sequence={self.sequence}", json.dumps(patch), "application/merge-patch+json",
                  POINTS)
        return time.perf_counter() - begin

    def close(self):
        self.send("DELETE", self.path, None, "application/json")


def told(what, seconds):
    seconds = sorted(seconds)
    print(f"{what:58} median {1000 * statistics.median(seconds):6.1f} ms"
          f"   95 % below {1000 * seconds[math.ceil(0.95 * len(seconds)) - 1]:6.1f} ms", flush=True)


def extremes(region):
    """Vertices of the file at the left, right and upper end of the piece, with their places."""
    known = [(uv, id) for uv, id in zip(region["uv_mm"], region["source_vertices"]) if id is not None]
    for key in (lambda p: p[0][0], lambda p: -p[0][0], lambda p: -p[0][1]):
        yield min(known, key=key)


def drag_pin(service, model, request, changes, what):
    session = Session(service, model, request)
    pins = [{"kind": "pin", "vertex": id, "at_mm": uv} for uv, id in extremes(session.state["pattern"]["regions"][0])]
    locks = request.get("constraints", [])
    session.change({"constraints": locks + pins})
    taken = []
    for step in range(changes):
        sign = 1 if step // 20 % 2 == 0 else -1
        pins[2]["at_mm"] = [pins[2]["at_mm"][0] + 0.14 * sign, pins[2]["at_mm"][1] + 0.14 * sign]
        taken.append(session.change({"constraints": locks + pins}))
    told(what, taken)
    session.close()


def change_demands(service, model, request, changes):
    session = Session(service, model, request)
    told("a weight changed", [session.change({"weights": {"stretch": 1.0 + 0.1 * (step % 10 + 1)}})
                              for step in range(changes)])
    session.change({"weights": None})
    locks = request["locks"]
    told("a lock taken away and set again",
         [session.change({"locks": locks if step % 2 else locks[1:]}) for step in range(changes)])
    session.close()


def drag_line(session, changes):
    """A line of 21 points between two places of the piece, moved a little each time."""
    region = session.state["pattern"]["regions"][0]
    (_, _), (high, _) = min(zip(region["uv_mm"], range(10**9))), max(zip(region["uv_mm"], range(10**9)))
    middle = [sum(p[k] for p in region["uv_mm"]) / len(region["uv_mm"]) for k in (0, 1)]
    ask = {"to_last": {"region": region["name"],
                       "points": [[middle[0] + 0.02 * i * (high[0] - middle[0]), middle[1] + 0.3 * i] for i in range(21)]}}
    places = session.send("POST", session.path + "/map", json.dumps(ask), "application/json")["to_last"]["points"]
    line = [place["position"] for place in places]
    taken = []
    for step in range(changes):
        line[10][1] += 0.1 if step // 10 % 2 == 0 else -0.1
        taken.append(session.change({"curves": {"line": {"polyline": line}}}))
    return taken


def subdivided(obj, request):
    """Every triangle cut into four, and the vertex paths that go along."""
    vertices, faces, middles = [], [], {}
    for text in obj.decode().splitlines():
        words = text.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        if words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(vertices)
            vertices.append([0.5 * (p + q) for p, q in zip(vertices[a], vertices[b])])
        return middles[key]

    fine = []
    for a, b, c in faces:
        x, y, z = middle(a, b), middle(b, c), middle(c, a)
        fine += [(a, x, z), (x, b, y), (z, y, c), (x, y, z)]
    request = json.loads(json.dumps(request))
    for curve in request["curves"].values():
        path = curve["vertices"]
        curve["vertices"] = [path[0]] + [v for a, b in zip(path, path[1:]) for v in (middle(a, b), b)]
    lines = ["v {!r} {!r} {!r}".format(*v) for v in vertices] + ["f {} {} {}".format(*(v + 1 for v in f)) for f in fine]
    return "\n".join(lines).encode() + b"\n", request


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("request", type=pathlib.Path)
    parser.add_argument("--changes", type=int, default=200)
    asked = parser.parse_args()
    model, request = asked.model.read_bytes(), json.loads(asked.request.read_text())
    with fresh_folder() as folder:
        service = Service(folder).start()
        drag_pin(service, model, request, asked.changes, "a pin dragged in steps of 0.2 mm")
        change_demands(service, model, request, asked.changes)
        alone = Session(service, model, request)
        told("a line of 21 points dragged", drag_line(alone, asked.changes))
        alone.close()
        sessions = [Session(service, model, request) for _ in range(3)]
        taken = []
        threads = [threading.Thread(target=lambda s=s: taken.extend(drag_line(s, asked.changes)))
                   for s in sessions]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        told("the same in three sessions at once", taken)
        for session in sessions:
            session.close()
        fine, request = subdivided(model, request)
        drag_pin(service, fine, request, asked.changes, "the pin, every triangle cut into four")
        service.kill()


if __name__ == "__main__":
    main()
