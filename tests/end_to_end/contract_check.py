#!/usr/bin/env python3
"""Holds one answer of the server against api/openapi.json: status declared, headers declared, present and well-formed,
content type declared, body as its schema says.

    tests/end_to_end/contract_check.py FOLDER     (answers that other tests have kept)

Without python3-jsonschema it says so and ends with 77 (skipped).
"""

import gzip
import json
import pathlib
import re
import sys
import urllib.parse

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: python3-jsonschema 4 or later is not installed")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
TYPES = {"json": "application/json", "svg": "image/svg+xml", "glb": "model/gltf-binary", "obj": "model/obj"}


def load_contract():
    return Contract(json.loads((ROOT / "api" / "openapi.json").read_text()))


class Contract:
    """The document, and which of its answers were seen."""

    def __init__(self, document):
        self.document = document
        self.seen = set()
        self.faults = []
        self.validators = {}

    def resolve(self, node):
        while "$ref" in node:
            target = self.document
            for name in node["$ref"][2:].split("/"):
                target = target[name]
            node = target
        return node

    def operations(self):
        for path, item in self.document["paths"].items():
            for method in ("get", "head", "post", "put", "patch", "delete", "options"):
                if method in item:
                    yield method.upper(), path, item[method]

    def declared(self):
        return {(m, p, int(status)) for m, p, o in self.operations() for status in o["responses"]}

    def complain(self, where, what):
        self.faults.append(f"{where}: {what}")
        print(f"FAULT {where}: {what}")

    def check_value(self, where, schema, value):
        key = json.dumps(schema, sort_keys=True)
        if key not in self.validators:
            self.validators[key] = Draft202012Validator({**schema, "components": self.document["components"]})
        for error in list(self.validators[key].iter_errors(value))[:3]:
            self.complain(where, f"/{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")

    def check(self, method, path, answer):
        """Validates one answer to a declared operation, or to a method or path that is none."""
        status, headers, body = answer
        where = f"{method} {path} {status}"
        item = self.document["paths"].get(path, {})
        if method.lower() in item:
            self.seen.add((method, path, status))
            response = item[method.lower()]["responses"].get(str(status))
            if response is None:
                return self.complain(where, f"this status is not declared: {body[:200]!r}")
        else:
            like = any(re.fullmatch(re.sub(r"\{.*?\}", "[^/]+", known), path) for known in self.document["paths"])
            name, wanted = ("NotFound", 405) if item else ("BadRequest", 400) if like else ("NotFound", 404)
            response = self.document["components"]["responses"][name]
            if item:
                response = {**response, "headers": {**response["headers"], "Allow": {"$ref": "#/components/headers/Allow"}}}
            if status != wanted:
                return self.complain(where, "expected 405 for a method, 400 for an id that is none, 404 for any other path")
        response = self.resolve(response)
        self.check_headers(where, response.get("headers", {}), headers)
        content = response.get("content")
        if not content:
            if body:
                self.complain(where, f"a body that is not declared: {body[:200]!r}")
            return headers
        if headers.get("content-encoding") == "gzip":
            body = gzip.decompress(body)
        media_type = headers.get("content-type", "").split(";")[0]
        if media_type not in content:
            return self.complain(where, f"the content type {media_type!r} is not declared")
        if media_type.endswith("json"):
            value = json.loads(body)
            self.check_value(where, content[media_type]["schema"], value)
            if media_type == "application/problem+json" and value["status"] != status:
                self.complain(where, f"the problem says {value['status']}")
            return value
        return body

    def check_headers(self, where, declared, headers):
        for name, header in declared.items():
            header = self.resolve(header)
            value = headers.get(name.lower())
            if value is None:
                if header.get("required"):
                    self.complain(where, f"the header {name} is missing")
                continue
            if header["schema"].get("type") == "integer":
                value = int(value)
            self.check_value(f"{where}, header {name}", header["schema"], value)
        for name in headers:
            if name not in {n.lower() for n in declared} | {"content-type"}:
                self.complain(where, f"the header {name} is not declared")

    def check_itself(self):
        """Every reference leads somewhere; every example is what its schema says."""
        def walk(node, where):
            if isinstance(node, dict):
                if "$ref" in node:
                    self.resolve(node)
                if isinstance(node.get("schema"), dict) and isinstance(node.get("examples"), dict):
                    for name, example in node["examples"].items():
                        self.check_value(f"example {where}/{name}", node["schema"], example["value"])
                for name, child in node.items():
                    walk(child, f"{where}/{name}")
            elif isinstance(node, list):
                for i, child in enumerate(node):
                    walk(child, f"{where}/{i}")
        walk(self.document, "")
        for name, schema in self.document["components"]["schemas"].items():
            Draft202012Validator.check_schema(schema)
            for example in schema.get("examples", []):
                self.check_value(f"example of {name}", {"$ref": f"#/components/schemas/{name}"}, example)


def template_of(contract, path):
    """The path of the contract that a path is an instance of; itself if there is none."""
    groups = {"{id}": "(?:[0-9A-Z]{26}|[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})", "{digest}": "[0-9a-f]{64}"}
    for template in contract.document["paths"]:
        pattern = re.escape(template)
        for name, group in groups.items():
            pattern = pattern.replace(re.escape(name), group)
        if re.fullmatch(pattern, path):
            return template
    return path


def check_answers(folder):
    """Holds answers that were kept (asked: status, method, URL; headers; body) against the contract."""
    contract = load_contract()
    kept = [path for path in sorted(pathlib.Path(folder).iterdir()) if (path / "asked").exists()]
    for path in kept:
        status, method, url = (path / "asked").read_text().split(maxsplit=2)
        lines = (path / "headers").read_text("latin-1").replace("\r", "").strip().split("\n\n")[-1].splitlines()
        headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines[1:])}
        body = path / "body"
        if int(status) == 0 or (not body.exists() and headers.get("content-length", "0") != "0" and method != "HEAD"):
            continue  # no answer at all, or one too large to be kept
        content = body.read_bytes() if body.exists() and method != "HEAD" else b""
        contract.check(method, template_of(contract, urllib.parse.urlsplit(url.strip()).path), (int(status), headers, content))
    if contract.faults:
        print(f"{len(kept)} answers, {len(contract.faults)} faults")
    sys.exit(1 if contract.faults else 0)


if __name__ == "__main__":
    check_answers(sys.argv[1])
