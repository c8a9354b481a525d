# What the end-to-end tests share. $LASTFLAT is the program's path; every test has a folder of its own, $BATS_TEST_TMPDIR.
# shellcheck shell=bash disable=SC2034

bats_require_minimum_version 1.5.0
examples=$(realpath "$BATS_TEST_DIRNAME/../../client-examples")
contract=$(realpath "$BATS_TEST_DIRNAME/../../api/openapi.json")

require_program() {
    if [[ -z ${LASTFLAT:-} || ! -x $LASTFLAT ]]; then
        echo "LASTFLAT must name the program to test, such as build/release/lastflat (it is '${LASTFLAT:-}')" >&2
        return 1
    fi
    LASTFLAT=$(realpath "$LASTFLAT")
    export LASTFLAT
}

# wait_until SECONDS COMMAND...: fails if the command does not succeed in time.
wait_until() {
    local end=$(( SECONDS + $1 + 1 ))
    until "${@:2}"; do
        if (( SECONDS >= end )); then
            echo "waited $1 s in vain for: ${*:2}" >&2
            return 1
        fi
        sleep 0.02
    done
}

milliseconds() { echo $(( ${EPOCHREALTIME/[.,]/} / 1000 )); }

# start_server FLAGS...: on a free port; with a data folder of its own, or $DATA; sets $url,
# $LASTFLAT_URL, $data and $server (its process).
start_server() {
    local log=$BATS_TEST_TMPDIR/server.$RANDOM
    data=${DATA:-$log.data}
    "$LASTFLAT" serve --listen 127.0.0.1:0 --data "$data" "$@" > "$log.out" 2> "$log.err" 3>&- &
    server=$!
    servers+=("$server")
    wait_until 10 grep -q '^listening on http://' "$log.out" || { cat "$log.err" >&2; return 1; }
    url=$(sed -n 's/^listening on //p' "$log.out")
    export LASTFLAT_URL=$url
}

servers=()
stop_servers() {
    local process
    for process in "${servers[@]}"; do
        kill -KILL "$process" 2> "$BATS_TEST_TMPDIR/kill" || true
        wait "$process" 2> "$BATS_TEST_TMPDIR/kill" || true
    done
    servers=()
}

# has_ended PROCESS: whether a process of ours has ended, waited for or not.
has_ended() { [[ ! -e /proc/$1/status ]] || grep -q '^State:.*Z' "/proc/$1/status"; }

# ask CURL_ARGUMENTS...: sets $status; the answer is in $body and $headers (files). Jobs are run, even if the answer is
# there, unless $cache_control says otherwise.
ask() {
    local asked
    body=$BATS_TEST_TMPDIR/body headers=$BATS_TEST_TMPDIR/headers
    rm -f "$body"  # an answer without a body makes none
    asked=$(curl -sS -g -H "Cache-Control: ${cache_control:-no-cache}" --max-time 60 -o "$body" -D "$headers" -w '%{http_code} %{method} %{url_effective}' "$@")
    status=${asked%% *}
    keep_answer "$asked"
}

# Every answer of the service is kept, and held against the contract when the file's tests are through.
keep_answer() {
    [[ -z ${BEHIND_PROXY:-} ]] || return 0  # some of its answers are its own
    local kept
    mkdir -p "$BATS_FILE_TMPDIR/answers"
    kept=$(mktemp -d "$BATS_FILE_TMPDIR/answers/XXXXXXXX")
    echo "$1" > "$kept/asked"
    cp "$headers" "$kept/headers"
    if [[ -e $body && $(stat -c %s "$body") -lt 3000000 ]]; then cp "$body" "$kept/body"; fi
}
teardown_file() {
    [[ -d $BATS_FILE_TMPDIR/answers ]] || return 0
    echo "# $(ls "$BATS_FILE_TMPDIR/answers" | wc -l) answers are held against the contract" >&3; python3 "$BATS_TEST_DIRNAME/contract_check.py" "$BATS_FILE_TMPDIR/answers" || (( $? == 77 ))
}

# header NAME: its value in the last answer.
header() { tr -d '\r' < "$headers" | sed -n "s/^$1: //Ip" | tail -n 1; }

# post MODEL [REQUEST]: sets $job to the path of the new job.
post() {
    ask -F "model=@$1" ${2:+-F "request=@$2"} "$url/v1/jobs"
    assert_equal "$status" 202
    job=$(jq -r .links.self "$body")
}

state() { curl -sS "$url$1" | jq -r .state; }
is_in_state() { [[ $(state "$1") == "$2" ]]; }
has_ended_job() { [[ $(state "$1") =~ ^(succeeded|failed|canceled)$ ]]; }

# flatten MODEL [REQUEST]: posts and waits for success.
flatten() {
    post "$@"
    wait_until 60 has_ended_job "$job"
    assert_equal "$(state "$job")" succeeded
}

assert_equal() {
    [[ $1 == "$2" ]] && return
    printf 'expected: %s\n     got: %s\n' "$2" "$1" >&2
    [[ -z ${body:-} || ! -s $body ]] || { head -c 600 "$body"; echo; } >&2
    return 1
}

# assert_problem STATUS CODE [POINTER]: the last answer is that problem document.
assert_problem() {
    assert_equal "$status" "$1"
    assert_equal "$(header Content-Type)" application/problem+json
    assert_equal "$(jq -c '[.status, .code, .type]' "$body")" "[$1,\"$2\",\"urn:lastflat:problem:$2\"]"
    jq -e '.detail | length > 10' "$body" > "$BATS_TEST_TMPDIR/said" || assert_equal "a short detail" "a detail for people"
    if [[ $# -eq 3 ]]; then assert_equal "$(jq -c .pointer "$body")" "\"$3\""; fi
}

# assert_same_result A B: the same bytes, the times apart.
assert_same_result() {
    local a b
    a=$(sed -E 's/"timing_ms":\{[^}]*\}//' "$1" | sha256sum)
    b=$(sed -E 's/"timing_ms":\{[^}]*\}//' "$2" | sha256sum)
    grep -q '"timing_ms":{"load":[0-9]' "$1" || { echo "$1 is no result" >&2; return 1; }
    assert_equal "$a" "$b"
}

# make_sample: last.obj, last.glb, last.request.json and last.no_units.json in the file's folder.
make_sample() {
    "$LASTFLAT" sample-last --out "$BATS_FILE_TMPDIR/sample"
    jq -c 'del(.units)' "$BATS_FILE_TMPDIR/sample/last.request.json" > "$BATS_FILE_TMPDIR/sample/last.no_units.json"
}

# make_bumpy N FILE: a bumpy disk of about 2 N^2 triangles, which isometric needs long for.
make_bumpy() {
    python3 - "$1" > "$2" <<'PYTHON'
import math, sys
n = int(sys.argv[1])
for y in range(n):
    for x in range(n):
        u, v = 200 * x / (n - 1), 200 * y / (n - 1)
        print(f"v {u:.4f} {v:.4f} {6 * math.sin(u / 9) * math.cos(v / 11):.4f}")
for y in range(n - 1):
    for x in range(n - 1):
        a = y * n + x + 1
        print("f", a, a + 1, a + n + 1, a + n)
PYTHON
}

# certify MODEL REQUEST RESULT: recomputes from the model and the flat coordinates alone that locked edges keep their
# length (1e-6), sewn edges agree (0.001 mm), nothing is folded, no outline crosses itself, and the report says the same.
certify() {
    python3 - "$@" <<'PYTHON'
import json, math, struct, sys
model, request, result = sys.argv[1:]
request, result = json.load(open(request)), json.load(open(result))

def positions(path):
    data = open(path, "rb").read()
    if data[:4] != b"glTF":
        return [tuple(map(float, line.split()[1:4])) for line in data.decode().splitlines() if line.startswith("v ")]
    size = struct.unpack("<I", data[12:16])[0]
    gltf, blob = json.loads(data[20:20 + size]), data[28 + size:]
    points = []
    for a in sorted({p["attributes"]["POSITION"] for m in gltf["meshes"] for p in m["primitives"]}):
        accessor = gltf["accessors"][a]
        start = gltf["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
        flat = struct.unpack_from(f"<{3 * accessor['count']}f", blob, start)
        points += [tuple(1000 * c for c in flat[i:i + 3]) for i in range(0, len(flat), 3)]
    return points

def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

space, flat_lengths, checked = positions(model), {}, 0
for region in result["regions"]:
    name, uv = region["name"], dict(zip(region["source_vertices"], region["uv_mm"]))
    for a, b, c in region["triangles"]:
        assert cross(*(region["uv_mm"][i] for i in (a, b, c))) > 0, f"{name}: triangle {a} {b} {c} is folded"
    line = region["outline"]["points_mm"]
    sides = list(zip(line, line[1:] + line[:1]))
    for i, (a, b) in enumerate(sides):
        for c, d in sides[i + 2:len(sides) - (i == 0)]:
            assert not (cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0), f"{name} crosses itself"
    assert region["metrics"]["flipped_triangles"] == 0 and region["metrics"]["border_crossings"] == 0
    for lock in request.get("locks", []):
        path = request["curves"][lock["curve"]]["vertices"]
        total = 0.0
        for v, w in zip(path, path[1:]):
            there, here = math.dist(space[v], space[w]), math.dist(uv[v], uv[w])
            assert abs(here - there) <= 1e-6 * there, f"{name}, {lock['curve']}: edge {v} {w} is {here}, not {there} mm"
            total, checked = total + here, checked + 1
        flat_lengths[name, lock["curve"]] = total
        reported = [c for c in region["curves"] if c["name"] == lock["curve"]]
        assert reported and all(c["locked"] and c["verdict"] == "pass" for c in reported), reported
        assert math.isclose(sum(c["length_2d_mm"] for c in reported), total, abs_tol=1e-6), (reported, total)
assert checked > 0 or not request.get("locks"), "no locked edge was looked at"
assert len(result["pairs"]) == len(request["cuts"]), result["pairs"]
for pair in result["pairs"]:
    difference = flat_lengths[pair["a"], pair["curve"]] - flat_lengths[pair["b"], pair["curve"]]
    assert abs(difference) <= 0.001 and abs(pair["difference_mm"]) <= 0.001 and pair["verdict"] == "pass", pair
print(f"{checked} locked edges kept")
PYTHON
}

# check_drawing SVG RESULT: well-formed XML in millimetres with every piece of the result.
check_drawing() {
    python3 - "$@" <<'PYTHON'
import json, sys
from xml.etree import ElementTree
root = ElementTree.parse(sys.argv[1]).getroot()
assert root.tag == "{http://www.w3.org/2000/svg}svg", root.tag
assert root.get("width").endswith("mm") and root.get("viewBox").split()[2] == root.get("width")[:-2], root.attrib
ids = {e.get("id") for e in root.iter()}
names = {r["name"] for r in json.load(open(sys.argv[2]))["regions"]}
assert names <= ids, (names, ids)
PYTHON
}

# check_glb GLB RESULT: a mesh per piece whose TEXCOORD_0 is the piece's flat shape, put on the sheet, as shares of it.
check_glb() {
    python3 - "$@" <<'PYTHON'
import json, math, struct, sys
data, result = open(sys.argv[1], "rb").read(), json.load(open(sys.argv[2]))
magic, version, length = struct.unpack("<4sII", data[:12])
assert (magic, version, length) == (b"glTF", 2, len(data)), (magic, version, length, len(data))
size, kind = struct.unpack("<I4s", data[12:20])
assert kind == b"JSON"
gltf = json.loads(data[20:20 + size])
blob_size, kind = struct.unpack("<I4s", data[20 + size:28 + size])
assert kind == b"BIN\0" and 28 + size + blob_size == length
blob = data[28 + size:]

def floats(index, width):
    accessor = gltf["accessors"][index]
    assert accessor["componentType"] == 5126
    start = gltf["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = struct.unpack_from(f"<{width * accessor['count']}f", blob, start)
    return [values[i:i + width] for i in range(0, len(values), width)]

meshes = {m["name"]: m for m in gltf["meshes"]}
for region, placement in zip(result["regions"], result["layout"]["placements"]):
    attributes = meshes[region["name"]]["primitives"][0]["attributes"]
    flat = floats(attributes["TEXCOORD_0"], 2)
    assert len(flat) == len(floats(attributes["POSITION"], 3)) == len(region["uv_mm"]) > 0
    width, height = gltf["asset"]["extras"]["sheet_mm"]
    turn, move = math.radians(placement["rotation_deg"]), placement["translation_mm"]
    for (u, v), (x, y) in zip(flat, region["uv_mm"]):
        y = -y if placement["mirrored"] else y
        there = (x * math.cos(turn) - y * math.sin(turn) + move[0], x * math.sin(turn) + y * math.cos(turn) + move[1])
        assert math.dist((u * width, (1 - v) * height), there) < 1e-3, (region["name"], (u, v), there)
PYTHON
}
