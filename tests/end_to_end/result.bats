#!/usr/bin/env bats
# result.json as text: which fields it has, in which order, and how its numbers are written.

load helper

setup_file() {
    require_program
    make_sample
    cd "$BATS_FILE_TMPDIR" || return 1
    jq '.include = ["fan"]' sample/last.request.json > with_fan.json
    "$LASTFLAT" flatten sample/last.obj --request with_fan.json --out out
}
setup() {
    result=$BATS_FILE_TMPDIR/out/result.json
    cd "$BATS_TEST_TMPDIR" || return 1
}
teardown() { stop_servers; }

# fields FILE: every field of the document once, in the order of its first appearance; list items are "*".
fields() {
    python3 - "$1" <<'PYTHON'
import json, sys
seen = {}
def walk(value, path):
    if isinstance(value, dict):
        for name, member in value.items():
            seen.setdefault(f"{path}/{name}", None)
            walk(member, f"{path}/{name}")
    elif isinstance(value, list):
        for item in value:
            walk(item, path + "/*")
walk(json.load(open(sys.argv[1])), "")
print("\n".join(seen))
PYTHON
}

@test "the fields stand in the order that result_fields.txt says" {
    fields "$result" > fields
    diff "$BATS_TEST_DIRNAME/result_fields.txt" fields
}

@test "the metrics are the result without what grows with the mesh, in the same order" {
    start_server
    flatten "$BATS_FILE_TMPDIR/sample/last.obj" "$BATS_FILE_TMPDIR/sample/last.request.json"
    ask "$url$job/metrics"
    assert_equal "$status" 200
    fields "$body" > fields
    grep -vE '^/(model|layout|regions/\*/(uv_mm|triangles|source_vertices|source_points|source_triangles|outline|holes|fan))(/|$)' \
        "$BATS_TEST_DIRNAME/result_fields.txt" | diff - fields
}

@test "numbers have no more digits than they need, and nothing stands between the tokens" {
    python3 - "$result" <<'PYTHON'
import json, re, sys
text = re.sub(r'"([^"\\]|\\.)*"', lambda s: s[0] if s[0] in ('"uv_mm"', '"points_mm"') else '""', open(sys.argv[1]).read())
assert not re.search(r"\s", text.rstrip("\n")), "space between tokens"
number = r"-?[0-9][0-9.e+-]*"
every = re.findall(number, text)
assert len(every) > 10000, len(every)
for digits in every:
    mantissa = re.sub(r"[-.]", "", digits.split("e")[0]).lstrip("0")
    assert len(mantissa) <= 17, digits
coordinates = re.findall(r'"(?:uv_mm|points_mm)":\[\[(.*?)\]\]', text)
assert len(coordinates) >= 4, len(coordinates)
for digits in re.findall(number, " ".join(coordinates)):
    assert len(digits) <= len(repr(float(digits)).removesuffix(".0")), digits  # the shortest that reads back as itself
PYTHON
}

@test "the same model and request give the same bytes" {
    "$LASTFLAT" flatten "$BATS_FILE_TMPDIR/sample/last.obj" --request "$BATS_FILE_TMPDIR/with_fan.json" --out again
    assert_same_result "$result" again/result.json
}
