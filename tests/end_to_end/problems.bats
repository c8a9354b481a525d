#!/usr/bin/env bats
# What the service says when something is wrong.

load helper

setup_file() {
    require_program
    make_sample
    cat > "$BATS_FILE_TMPDIR/bad_requests.txt" <<'TABLE'
/lock	{"lock": []}
/locks/0/kep	{"locks": [{"curve": "heel", "kep": "edges"}]}
/curves/heel/vertices/1	{"curves": {"heel": {"vertices": [1, 2.5]}}}
/curves/heel/vertices/1	{"curves": {"heel": {"vertices": [1, -2]}}}
/curves/heel/vertices	{"curves": {"heel": {"vertices": [1]}}}
/curves/heel	{"curves": {"heel": {}}}
/curves/heel	{"curves": {"heel": {"vertices": [1, 2], "polyline": [[0,0,0],[1,1,1]]}}}
/curves/a~1b~0c	{"curves": {"a/b~c": {}}}
/regions/lateral/contains	{"regions": {"lateral": {"contains": {}}}}
/units	{"units": "feet"}
/holes	{"holes": "fill"}
/seams/0	{"seams": [7]}
/curves/vent/border_at	{"curves": {"vent": {"border_at": {"vertex": 1, "position": [1, 2, 3]}}}}
/method/name	{"method": {"name": "magic"}}
/method/angles	{"method": {"name": "isometric", "angles": "curvature"}}
/weld/tolerance_mm	{"weld": {"tolerance_mm": 2}}
/tag	{"tag": 4711}
/locks/1	{"locks": [{"curve": "heel"}, {"curve": "heel"}]}
	[]
	{"units": "mm"
	{"units": "mm", "units": "cm"}
	{"curves": {"heel": {"vertices": [1, 2]}, "heel": {"vertices": [3, 4]}}}
TABLE
}
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    request=$BATS_TEST_TMPDIR/request.json
}
teardown() { stop_servers; }

# fails_with REQUEST CODE POINTER: the job fails, and its result says so with 409.
fails_with() {
    jq -c "$1" "$sample/last.request.json" > "$request"
    post "$sample/last.obj" "$request"
    wait_until 60 has_ended_job "$job"
    ask "$url$job"
    assert_equal "$(jq -c '[.state, .error.code, .error.pointer]' "$body")" "[\"failed\",\"$2\",\"$3\"]"
    ask "$url$job/result"
    assert_problem 409 "$2" "$3"
}

@test "a field that breaks the contract is named by its pointer, in all three forms" {
    start_server
    base64 -w 0 "$sample/last.obj" > "$BATS_TEST_TMPDIR/model"
    while IFS= read -r row; do
        pointer=${row%%$'\t'*} bad=${row#*$'\t'}
        echo "$bad"
        printf '%s' "$bad" > "$request"
        ask -F "model=@$sample/last.obj" -F "request=@$request" "$url/v1/jobs"
        assert_problem 422 invalid_request "$pointer"
        ask -H 'Content-Type: model/obj' -H "X-Flatten-Constraints: $(base64 -w 0 "$request")" --data-binary 'v 0 0 0' "$url/v1/jobs"
        assert_problem 422 invalid_request "$pointer"
        jq -e . "$request" > "$BATS_TEST_TMPDIR/parsed" || continue
        { printf '{"model": {"data": "dg"}, "request": '; cat "$request"; printf '}'; } > "$BATS_TEST_TMPDIR/submission"
        ask -H 'Content-Type: application/json' --data-binary "@$BATS_TEST_TMPDIR/submission" "$url/v1/jobs"
        twice=$(grep -c 'units.*units\|heel.*"heel": {"v.*3' "$request") || true
        if (( twice )); then assert_problem 422 invalid_request ""; else assert_problem 422 invalid_request "/request$pointer"; fi
    done < "$BATS_FILE_TMPDIR/bad_requests.txt"
}

@test "JSON that cannot be read, or that says a thing twice, is told where" {
    start_server
    printf '{"units": "mm",\n "tag" "x"}' > "$request"
    ask -F "model=@$sample/last.obj" -F "request=@$request" "$url/v1/jobs"
    assert_problem 422 invalid_request ""
    grep -q 'line 2' "$body"
    printf '{"units": "mm", "units": "cm"}' > "$request"
    ask -F "model=@$sample/last.obj" -F "request=@$request" "$url/v1/jobs"
    assert_problem 422 invalid_request ""
    grep -q "'units' stands twice" "$body"
}

@test "a cut or lock on a curve that there is not is named" {
    start_server
    fails_with '.locks[1].curve = "hel"' curve_invalid /locks/1/curve
    fails_with '.cuts[0] = "center_front"' curve_invalid /cuts/0
    jq -e '.detail | contains("center_front")' "$body"
}

@test "a path that leaves the mesh's edges is named with the item and the place" {
    start_server
    fails_with '.curves.centre_front.vertices |= (.[5] = .[20])' curve_invalid /curves/centre_front/vertices/5
    jq -e '.position | length == 3' "$body"
    ask "$url$job"
    vertex=$(jq '.curves.centre_front.vertices[4]' "$request")
    read -r x y z < <(grep '^v ' "$sample/last.obj" | sed -n "$(( vertex + 1 ))s/^v //p")
    jq -e --argjson x "$x" --argjson y "$y" --argjson z "$z" \
        '.error.position as $p | [($p[0] - $x), ($p[1] - $y), ($p[2] - $z)] | map(. * .) | add | sqrt < 200' "$body"
}

@test "a model that is missing, empty or none is refused" {
    start_server
    ask -F "request=@$sample/last.request.json" "$url/v1/jobs"
    assert_problem 422 model_missing
    : > "$BATS_TEST_TMPDIR/empty.obj"
    ask -F "model=@$BATS_TEST_TMPDIR/empty.obj" "$url/v1/jobs"
    assert_problem 422 model_missing
    ask -X POST "$url/v1/jobs"
    assert_problem 422 model_missing
    ask -H 'Content-Type: application/json' --data '{}' "$url/v1/jobs"
    assert_problem 422 invalid_request /model
    echo 'hello' > "$BATS_TEST_TMPDIR/hello.obj"
    post "$BATS_TEST_TMPDIR/hello.obj"
    wait_until 60 has_ended_job "$job"
    ask "$url$job/result"
    assert_problem 409 unreadable_model
}

@test "a part that nobody knows, or that is there twice, is refused" {
    start_server
    ask -F "model=@$sample/last.obj" -F 'constraints={}' "$url/v1/jobs"
    assert_problem 400 part_unknown
    grep -q "'constraints'" "$body"
    ask -F "model=@$sample/last.obj" -F "model=@$sample/last.obj" "$url/v1/jobs"
    assert_problem 400 part_repeated
    ask -H 'Content-Type: model/obj' -H 'X-Flatten-Constraints: {}' --data-binary "@$sample/last.obj" "$url/v1/jobs"
    assert_problem 400 header_invalid
}

@test "a wrong method gets 405 and the right ones, a wrong path 404" {
    start_server
    id=00000000000000000000000000
    while read -r method path allowed; do
        ask -X "$method" "$url$path"
        assert_problem 405 method_not_allowed
        assert_equal "$method $path $(header Allow)" "$method $path $allowed"
        ask -X OPTIONS "$url$path"
        assert_equal "$status $(header Allow)" "204 $allowed"
    done <<TABLE
DELETE /v1/jobs POST, GET, HEAD, OPTIONS
PATCH /v1/jobs/$id PUT, GET, HEAD, DELETE, OPTIONS
DELETE /v1/jobs/$id/result GET, HEAD, OPTIONS
GET /v1/jobs/$id/cancel POST, OPTIONS
DELETE /healthz GET, HEAD, OPTIONS
PATCH /openapi.json GET, HEAD, OPTIONS
TABLE
    for path in / /v1 /v1/job /v1/jobs/ /v1/jobs/$id/results; do
        ask "$url$path"
        assert_problem 404 not_found
    done
    for path in /v1/jobs/short /v1/jobs/short/result /v1/assets/short; do
        ask "$url$path"
        assert_problem 400 id_malformed
    done
    for path in "/v1/jobs/$id" "/v1/jobs/$id/result"; do
        ask "$url$path"
        assert_problem 404 job_not_found
    done
    ask -X POST "$url/v1/jobs/$id/cancel"
    assert_problem 404 job_not_found
    ask -X DELETE "$url/v1/jobs/$id"
    assert_problem 404 job_not_found
}

@test "the contract is given out as it stands in the repository" {
    start_server
    ask "$url/openapi.json"
    assert_equal "$status $(header Content-Type)" "200 application/json"
    cmp "$body" "$contract"
}
