#!/usr/bin/env bats
# The sample last, from file to pattern, over HTTP and by the client examples.

load helper

setup_file() { require_program; make_sample; }
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    cd "$BATS_TEST_TMPDIR" || return 1
}
teardown() { stop_servers; }

# Runs a client on a model and checks everything that it wrote.
check_client() {  # client, model, request
    start_server
    OUT=out run --separate-stderr "$1" "$2" "$3"
    assert_equal "$status" 0
    certify "$2" "$3" out/result.json
    check_drawing out/pattern.svg out/result.json
    check_glb out/flat.glb out/result.json
    [[ $output =~ lateral\ +heel\ +78\.710\ +78\.710\ +0\.000000\ +0\.000\ +pass ]] || assert_equal "$output" "a row for the heel"
    [[ $output =~ medial\ +-\ joint\ +[0-9.]+\ +[0-9.]+\ +1\.[0-9]+\ +2\.[0-9]+\ +-$'\n' ]] || assert_equal "$output" "a row for the joint"
    [[ $output == *"pair heel: lateral and medial differ by 0.000000 mm  pass"* ]] || assert_equal "$output" "a pair"
    "$LASTFLAT" flatten "$2" --request "$3" --out by_hand
    assert_same_result out/result.json by_hand/result.json
    cmp out/pattern.svg by_hand/pattern.svg
    cmp out/flat.glb by_hand/flat.glb
    OUT=again "$1" "$2" "$3"
    assert_same_result out/result.json again/result.json
    cmp out/pattern.svg again/pattern.svg
    cmp out/flat.glb again/flat.glb
}

@test "flatten.sh: the sample last as OBJ keeps its locked curves, as the command line does" {
    check_client "$examples/curl/flatten.sh" "$sample/last.obj" "$sample/last.request.json"
}

@test "flatten.sh: the sample last as GLB keeps its locked curves, as the command line does" {
    check_client "$examples/curl/flatten.sh" "$sample/last.glb" "$sample/last.no_units.json"
}

@test "flatten.py: the sample last as OBJ keeps its locked curves, as the command line does" {
    check_client "$examples/python/flatten.py" "$sample/last.obj" "$sample/last.request.json"
}

@test "flatten.py: the sample last as GLB keeps its locked curves, as the command line does" {
    check_client "$examples/python/flatten.py" "$sample/last.glb" "$sample/last.no_units.json"
}

@test "the sample request fits the sample last in both of its formats" {
    "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out obj
    "$LASTFLAT" flatten "$sample/last.glb" --request "$sample/last.request.json" --out glb
    jq -se '.[0].regions[0].curves[0].length_3d_mm - .[1].regions[0].curves[0].length_3d_mm | fabs < 0.01' \
        obj/result.json glb/result.json
}

@test "a glTF file with its buffer inside gives what the GLB gives" {
    python3 - "$sample/last.glb" last.gltf <<'PYTHON'
import base64, json, struct, sys
data = open(sys.argv[1], "rb").read()
size = struct.unpack("<I", data[12:16])[0]
gltf = json.loads(data[20:20 + size])
blob = data[28 + size:][:gltf["buffers"][0]["byteLength"]]
gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
json.dump(gltf, open(sys.argv[2], "w"))
PYTHON
    start_server
    OUT=glb "$examples/curl/flatten.sh" "$sample/last.glb" "$sample/last.no_units.json"
    OUT=gltf "$examples/curl/flatten.sh" last.gltf "$sample/last.no_units.json"
    assert_same_result glb/result.json gltf/result.json
}

@test "a glTF file whose buffer is sent beside it gives what the GLB gives" {
    python3 - "$sample/last.glb" <<'PYTHON'
import json, struct, sys
data = open(sys.argv[1], "rb").read()
size = struct.unpack("<I", data[12:16])[0]
gltf = json.loads(data[20:20 + size])
open("last.bin", "wb").write(data[28 + size:][:gltf["buffers"][0]["byteLength"]])
gltf["buffers"][0]["uri"] = "last.bin"
json.dump(gltf, open("last.gltf", "w"))
PYTHON
    start_server
    OUT=glb "$examples/curl/flatten.sh" "$sample/last.glb" "$sample/last.no_units.json"
    ask -F model=@last.gltf -F "request=@$sample/last.no_units.json" "$url/v1/jobs"
    job=$(jq -r .links.self "$body")
    wait_until 20 has_ended_job "$job"
    assert_equal "$(curl -sS "$url$job" | jq -r .error.code)" unsupported_model
    ask -H 'Prefer: wait=30' -F model=@last.gltf -F buffers=@last.bin -F "request=@$sample/last.no_units.json" "$url/v1/jobs"
    assert_equal "$status" 200
    curl -sSf "$url$(jq -r .links.result "$body")" -o beside.json
    assert_same_result glb/result.json beside.json
}

@test "the clients take files whose names have spaces, quotes, commas, semicolons and backslashes" {
    start_server
    odd="a last, size \"41\"; it's \\ odd =@<.obj"
    cp "$sample/last.obj" "$odd"
    cp "$sample/last.request.json" "a request; with, \"signs\".json"
    for client in curl/flatten.sh python/flatten.py; do
        "$examples/$client" "$odd" "a request; with, \"signs\".json"
        certify "$odd" "$sample/last.request.json" "${odd%.*}/result.json"
        rm -r -- "${odd%.*}"
    done
}

@test "the clients say what is wrong and end with 2 if the input is at fault, 1 if not" {
    start_server
    jq -c '.locks[1].kep = "edges"' "$sample/last.request.json" > unknown.json
    jq -c '.locks[1].curve = "hel"' "$sample/last.request.json" > no_curve.json
    for client in curl/flatten.sh python/flatten.py; do
        run --separate-stderr "$examples/$client" "$sample/last.obj" unknown.json
        assert_equal "$status" 2
        [[ $stderr == *"unknown field"*"at: /locks/1/kep"*"code: invalid_request"* ]] || assert_equal "$stderr" "the problem"
        run --separate-stderr "$examples/$client" "$sample/last.obj" no_curve.json
        assert_equal "$status" 2
        [[ $stderr == *"'hel'"*"at: /locks/1/curve"*"code: curve_invalid"* ]] || assert_equal "$stderr" "the problem"
        run --separate-stderr "$examples/$client" no_such_last.obj
        assert_equal "$status" 2
        LASTFLAT_URL=http://127.0.0.1:1 run --separate-stderr "$examples/$client" "$sample/last.obj"
        assert_equal "$status" 1
        [[ ! -e last ]]
    done
}

@test "a form, JSON and the model alone carry the same job" {
    start_server
    flatten "$sample/last.obj" "$sample/last.request.json"
    curl -sSf "$url$job/result" -o form.json

    jq -nc --rawfile model <(base64 -w 0 "$sample/last.obj") --slurpfile request "$sample/last.request.json" \
        '{model: {data: $model}, request: $request[0]}' > submission.json
    ask -H 'Content-Type: application/json' --data-binary @submission.json "$url/v1/jobs"
    assert_equal "$status" 202
    job=$(jq -r .links.self "$body")
    wait_until 60 has_ended_job "$job"
    curl -sSf "$url$job/result" -o json.json
    assert_same_result form.json json.json

    constraints=$(base64 -w 0 "$sample/last.request.json" | tr '+/' '-_' | tr -d =)
    for type in application/octet-stream model/obj application/x-www-form-urlencoded; do
        ask -H "Content-Type: $type" -H "X-Flatten-Constraints: $constraints" --data-binary "@$sample/last.obj" "$url/v1/jobs"
        assert_equal "$status" 202
        job=$(jq -r .links.self "$body")
        wait_until 60 has_ended_job "$job"
        curl -sSf "$url$job/result" -o raw.json
        assert_same_result form.json raw.json
    done
}

@test "one worker or two, alone or crowded: the same bytes" {
    "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out by_hand
    for workers in 1 2; do
        start_server --workers "$workers"
        jobs=()
        for i in 1 2 3 4; do post "$sample/last.obj" "$sample/last.request.json"; jobs+=("$job"); done
        for job in "${jobs[@]}"; do
            wait_until 60 has_ended_job "$job"
            for format in json svg glb obj; do curl -sSf "$url$job/result?format=$format" -o "result.$format"; done
            assert_same_result result.json by_hand/result.json
            cmp result.svg by_hand/pattern.svg
            cmp result.glb by_hand/flat.glb
            cmp result.obj by_hand/flat.obj
        done
    done
}

@test "every method of the contract answers with a result, and the fan is drawn when asked for" {
    start_server
    methods='tutte chord_length shape_preserving harmonic wachspress mean_value virtual_border geodesic_fan mips green_lagrange'
    for name in $methods; do
        jq -c --arg name "$name" '.method = {name: $name} | .draw = ["fan"] | .include = ["fan"]' "$sample/last.request.json" > method.json
        flatten "$sample/last.obj" method.json
        curl -sSf "$url$job/result" -o "$name.json"
        jq -e --arg name "$name" '.regions | length == 2 and all(.method == $name and .metrics.flipped_triangles == 0
            and .fan.radius_mm > .fan.a_1_mm and (.fan.spokes | length) == (.outline.points_mm | length))' "$name.json"
        curl -sSf "$url$job/result?format=svg" -o "$name.svg"
        assert_equal "$(grep -c 'class="fan"' "$name.svg")" 2
    done
    for border in square circle hull floating; do
        jq -c --arg border "$border" '.method = {name: "mean_value", border: $border}' "$sample/last.request.json" > method.json
        flatten "$sample/last.obj" method.json
    done
}

@test "curves may be drawn in space, be shortest paths, or where groups meet" {
    start_server
    model=$sample/last.obj
    jq -c --rawfile model "$model" '
        ($model | split("\n") | map(select(startswith("v ")) | split(" ")[1:] | map(tonumber))) as $at
        | .curves.centre_front.vertices as $front | .curves.heel.vertices as $heel
        | .points = {toe: {position: $at[$front[0]]}, cone: {vertex: $front[-1]}, over: {vertex: $front[($front | length) / 2 | floor]}}
        | .curves.centre_front = {from: "toe", to: "cone", via: ["over"]}
        | .curves.heel = {polyline: [$heel[range(0; $heel | length; 3)], $heel[-1] | $at[.]]}
        | .curves.featherline = {border_of: {groups: ["upper", "sole"]}}' "$sample/last.request.json" > "$BATS_TEST_TMPDIR/request.json"
    flatten "$model" "$BATS_TEST_TMPDIR/request.json"
    ask "$url$job/result"
    jq -e '[.regions[].curves[] | select(.locked)] | length == 4 and all(.verdict == "pass")' "$body"
    jq -e '[.regions[].curves[] | select(.name == "featherline")] | length == 2' "$body"
    jq -e '.pairs | map(select(.curve == "heel" or .curve == "centre_front")) | length == 2 and all(.difference_mm < 0.001)' "$body"
    jq -e '.regions | all((.source_vertices | map(select(. == null)) | length) == (.source_points | length))' "$body"
}

@test "a whole upper is opened at the heel, a hole is locked, a dart is sewn" {
    start_server
    model=$sample/last.obj
    echo '{"surface": {"groups": ["upper"]}}' > "$BATS_TEST_TMPDIR/ring.json"
    flatten "$model" "$BATS_TEST_TMPDIR/ring.json"
    ask "$url$job/result"
    jq -e '(.warnings | map(.code)) == ["seam_added"] and (.pairs | length) == 1 and (.pairs[0] | .curve == "seam_1" and .a == .b and .verdict == "pass")' "$body"
    jq -e '.constraints | length == 1 and (.[0] | .kind == "seam" and .verdict == "pass" and (.residual_mm | fabs) < 1e-6)' "$body"
    heel=$(jq '.pairs[0].length_mm' "$body")
    curl -sSN "$url$job/events" | grep -A2 '^event: log' | grep '^data: ' | cut -c7- | jq -se 'map(select(.level == "warning")) | map(.code) == ["seam_added"]'

    jq -c '. + {seams: ["heel"], locks: [{curve: "heel"}]} | del(.cuts, .regions)' "$sample/last.request.json" > "$BATS_TEST_TMPDIR/given.json"
    flatten "$model" "$BATS_TEST_TMPDIR/given.json"
    ask "$url$job/result"
    jq -e --argjson made "$heel" '.warnings == [] and (.pairs[0] | .curve == "heel" and (.length_mm - $made | fabs) < 0.02 * $made)' "$body"

    # A ring cut out of the lateral half, and a dart from the topline.
    jq -c --rawfile model "$model" '
        ($model | split("\n") | map(select(startswith("v ")) | split(" ")[1:] | map(tonumber))) as $at
        | $at[.regions.lateral.contains.vertex] as $p
        | .points = {middle: {position: $p}}
        | .curves.topline.vertices as $top | ($top | length) as $n
        | (if ($at[$top[$n / 4 | floor]][1] - $at[$top[0]][1]) * ($p[1] - $at[$top[0]][1]) > 0 then $n / 4 else $n * 3 / 4 end | floor) as $k
        | .points.rim = {vertex: $top[$k]}
        | .curves.dart = {from: "rim", to: "middle"} | .seams = ["dart"]' "$sample/last.request.json" > "$BATS_TEST_TMPDIR/dart.json"
    flatten "$model" "$BATS_TEST_TMPDIR/dart.json"
    ask "$url$job/result"
    jq -e '.pairs | length == 3 and all(.verdict == "pass") and (map(select(.curve == "dart"))[0] | .a == "lateral" and .b == "lateral" and (.difference_mm | fabs) < 1e-6)' "$body"
    jq -e '.constraints | all(.verdict == "pass") and (map(select(.kind == "seam")) | length == 1)' "$body"

    # The upper as a ring: its top is a hole of the pattern, locked by the place where it is.
    jq -c '{surface, holes: "keep", curves: {rim: {border_at: {vertex: .curves.topline.vertices[3]}}}, locks: [{curve: "rim", keep: "total"}]}' \
        "$sample/last.request.json" > "$BATS_TEST_TMPDIR/keep.json"
    flatten "$model" "$BATS_TEST_TMPDIR/keep.json"
    ask "$url$job/result"
    jq -e '.regions[0] | (.holes | length) == 1 and .holes[0].segments[0].curve == "rim" and .metrics.flipped_triangles == 0 and .metrics.border_crossings == 0' "$body"
    jq -e '.constraints[0].verdict == "pass"' "$body"
}

@test "inspect and validate say the same words, of what is right and of what is wrong" {
    start_server
    head -c 20000 "$sample/last.glb" > cut.glb
    sed '/^f/,$d' "$sample/last.obj" > points.obj
    for model in "$sample/last.obj" cut.glb points.obj; do
        run --separate-stderr "$LASTFLAT" inspect --json "$model"
        jq -S 'del(.instance, .request_id)' <<< "$output$stderr" > inspected
        ask --data-binary "@$model" "$url/v1/validate"
        jq -S 'del(.instance, .request_id)' "$body" | diff inspected -
    done
}
