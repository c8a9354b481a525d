#!/usr/bin/env python3
"""Runs `lastflat flatten` on every file of a folder that breaks loaders.

    hostile.py PROGRAM [FOLDER] [--table]

FOLDER: default $LASTFLAT_HOSTILE, else ../shared/hostile beside the repository; nothing is tested if it is absent. Every run
must end within the limits with one of two outcomes: exit 0 and the four files, or exit 2, one problem document on standard
error, and nothing written. Exit 1 here if any does not.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
FILES = {"result.json", "flat.obj", "flat.glb", "pattern.svg"}

# They are there to find faults, not to be quick: a bare last takes nine times as long under them.
SANITIZERS_SLOW_DOWN = 6


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, nargs="?",
                        default=os.environ.get("LASTFLAT_HOSTILE", REPOSITORY.parent / "shared" / "hostile"))
    parser.add_argument("--seconds", type=float, default=10.0, help="for one file; sanitized programs get more")
    parser.add_argument("--megabytes", type=int, default=2048,
                        help="address space for one file; 0: no limit, as sanitizers need it")
    parser.add_argument("--table", action="store_true", help="list the outcome of every file")
    return parser.parse_args()


def is_sanitized(program):
    """Sanitizers reserve terabytes of address space that they never use."""
    contents = program.read_bytes()
    return b"__asan_init" in contents or b"__tsan_init" in contents


def limit_address_space(megabytes):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if megabytes:
        resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


def problem_of(text):
    """The problem document; raises ValueError if the text is anything else."""
    problem = json.loads(text)
    if not isinstance(problem, dict) or not 400 <= problem["status"] < 500:
        raise ValueError("no problem document of a bad input")
    for field in ("code", "title", "detail"):
        if not isinstance(problem[field], str) or not problem[field].strip():
            raise ValueError(f"the problem document has no {field}")
    return problem


def check_result(out):
    written = {path.name for path in out.iterdir()}
    if written != FILES:
        return f"exit 0, but the folder has {sorted(written)}"
    result = json.loads((out / "result.json").read_text(encoding="utf-8"))
    if not result["regions"]:
        return "exit 0 without regions"
    for region in result["regions"]:
        if region["metrics"]["flipped_triangles"] or region["metrics"]["border_crossings"]:
            return "exit 0 with flipped triangles or a border that crosses itself"
    return None


def outcome_of(program, file, seconds, megabytes):
    """(kind, detail, whether it is a failure)"""
    with tempfile.TemporaryDirectory(prefix="lastflat-hostile-") as folder:
        out = pathlib.Path(folder) / "out"
        try:
            run = subprocess.run([program, "flatten", "--json", file, "--out", out], capture_output=True, timeout=seconds, check=False,
                                 stdin=subprocess.DEVNULL, preexec_fn=lambda: limit_address_space(megabytes))
        except subprocess.TimeoutExpired:
            return "timeout", f"not done after {seconds:g} s", True
        said = run.stderr.decode("utf-8", "replace").strip()
        if run.returncode < 0 or "Sanitizer" in said or "runtime error:" in said:
            return "crash", f"exit {run.returncode}: {said[-600:]}", True
        if run.returncode == 0:
            wrong = check_result(out)
            return ("wrong success", wrong, True) if wrong else ("flattened", "", False)
        if run.returncode != 2:
            return f"exit {run.returncode}", said[-600:], True
        if out.exists():
            return "leftovers", f"exit 2, but {out.name} was made", True
        try:
            problem = problem_of(run.stderr.decode("utf-8"))
        except (ValueError, KeyError, TypeError) as error:
            return "malformed problem", f"{error}: {said[-600:]}", True
        return problem["code"], problem["detail"], False


def main():
    options = arguments()
    if not options.folder.is_dir():
        print(f"skipped: no folder {options.folder}")
        return 0
    program = options.program.resolve()
    sanitized = is_sanitized(program)
    megabytes = 0 if sanitized else options.megabytes
    seconds = options.seconds * (SANITIZERS_SLOW_DOWN if sanitized else 1)
    files = sorted(path for path in options.folder.rglob("*") if path.is_file())
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        outcomes = list(pool.map(lambda file: outcome_of(program, file, seconds, megabytes), files))

    for kind, count in sorted(collections.Counter(kind for kind, _, _ in outcomes).items()):
        print(f"{count:5d}  {kind}")
    failures = 0
    for file, (kind, detail, failed) in zip(files, outcomes):
        failures += failed
        if failed or options.table:
            print(f"{'FAILED ' if failed else ''}{file.relative_to(options.folder)}: {kind}{': ' if detail else ''}{detail}")
    print(f"{len(files)} files, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
