#!/usr/bin/env bats
# The program without its server.

load helper

setup_file() { require_program; make_sample; }
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    cd "$BATS_TEST_TMPDIR" || return 1
}

# refuses EXIT STATUS CODE ARGUMENTS...: with a problem document on standard error, then $problem, and nothing written;
# without --json it says the same in one line.
refuses() {
    run --separate-stderr "$LASTFLAT" flatten --json "${@:4}" --out out
    assert_equal "$status" "$1"
    assert_equal "$output" ""
    assert_equal "$(jq -c '[.status, .code]' <<< "$stderr")" "[$2,\"$3\"]"
    [[ ! -d out ]] || assert_equal "$(ls -A out)" "nothing"
    problem=$stderr
    run --separate-stderr "$LASTFLAT" flatten "${@:4}" --out out
    assert_equal "$status" "$1"
    assert_equal "$output" ""
    [[ $stderr == "lastflat: $(jq -r .detail <<< "$problem")"* && $(wc -l <<< "$stderr") -eq 1 ]] || assert_equal "$stderr" "a sentence"
}

# says SENTENCE ARGUMENTS...: ends with 2 and that line on standard error.
says() {
    run --separate-stderr "$LASTFLAT" "${@:2}"
    assert_equal "$status" 2
    assert_equal "$output" ""
    assert_equal "$stderr" "lastflat: $1"
}

@test "--version and --help" {
    run -0 "$LASTFLAT" --version
    [[ $output =~ ^lastflat\ $(jq -r .info.version "$contract")(\ \(commit\ [0-9a-f]+\))?$ ]]
    run -0 "$LASTFLAT" --help
    for command in serve flatten sample-last; do [[ $output == *"$command"* ]]; done
    run -0 "$LASTFLAT" flatten --help
    [[ $output == *"--json"* ]]
}

@test "flatten ends with 0 and writes the pattern" {
    run -0 --separate-stderr "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out new/out
    assert_equal "$stderr" ""
    [[ $output =~ flat\ -\ last:\ above\ 0.*lateral\ +heel\ +78\.710\ +78\.710\ +0\.000000\ +0\.000\ +pass ]]
    [[ $output =~ lateral\ +featherline\ +[0-9.]+\ +[0-9.]+\ +\+14\.[0-9]+\ +\+4\.[0-9]+\ +- ]]
    for zone in toe joint waist seat; do [[ $output =~ medial\ +$zone\  ]]; done
    [[ $output == *"above 0 stretched, below 0 gathered"* && $output != *fail* ]]
    assert_equal "$(tail -n 1 <<< "$output")" "written to new/out: result.json flat.obj flat.glb pattern.svg"
    assert_equal "$(ls -A new/out | xargs)" "flat.glb flat.obj pattern.svg result.json"
    certify "$sample/last.obj" "$sample/last.request.json" new/out/result.json
    check_drawing new/out/pattern.svg new/out/result.json
    check_glb new/out/flat.glb new/out/result.json
    assert_equal "$(grep -c '^g ' new/out/flat.obj)" 2
    assert_equal "$(grep -c '^vt ' new/out/flat.obj)" "$(jq '[.regions[].uv_mm | length] | add' new/out/result.json)"
}

@test "for programs flatten prints the result without what grows with the mesh" {
    run -0 --separate-stderr "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out out --json
    assert_equal "$stderr" ""
    jq -e --slurpfile whole out/result.json '.pairs == $whole[0].pairs and .points == $whole[0].points
        and (.regions | map(.curves)) == ($whole[0].regions | map(.curves)) and (.regions[0] | has("uv_mm") | not)' <<< "$output"
}

@test "flatten without a request takes every default" {
    printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n' > square.obj
    "$LASTFLAT" flatten square.obj --out out
    jq -e '.regions | length == 1 and .[0].name == "region_1" and .[0].method == "isometric"
           and (.[0].metrics.area_2d_mm2 - 81 | fabs < 1e-9)' out/result.json
}

@test "bad input ends with 2, a problem document and nothing written" {
    echo '{"lock": []}' > unknown.json
    refuses 2 422 invalid_request "$sample/last.obj" --request unknown.json
    assert_equal "$(jq -r .pointer <<< "$problem")" /lock
    jq -c '.cuts = ["none"]' "$sample/last.request.json" > no_curve.json
    refuses 2 422 curve_invalid "$sample/last.obj" --request no_curve.json
    printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' > no_last.obj
    refuses 2 422 region_invalid no_last.obj
    echo 'v 1 2' > broken.obj
    refuses 2 422 unreadable_model broken.obj
    refuses 2 404 file_unreadable no_such.obj
    refuses 2 404 file_unreadable "$sample/last.obj" --request no_such.json
    mkdir out
    echo mine > out/result.json
    run "$LASTFLAT" flatten "$sample/last.obj" --request no_curve.json --out out
    assert_equal "$status $(cat out/result.json)" "2 mine"
}

@test "what is misspelt gets a sentence with the nearest name" {
    says "there is no command 'flaten'; did you mean 'flatten'?" flaten "$sample/last.obj"
    says "there is no command 'ad'; did you mean 'add'?" keys ad
    says "there is no option '--requst' of 'flatten'; did you mean '--request'?" flatten "$sample/last.obj" --requst r.json --out out
    says "--toe: must be one of: almond, pointed, round, square; did you mean 'round'?" sample-last --toe rund --out out
    says "cannot read the model $sample/lst.obj: there is no such file; did you mean 'last.obj'?" flatten "$sample/lst.obj" --out out
    says "cannot read the request nothing.json: there is no such file" flatten "$sample/last.obj" --request nothing.json --out out
    jq -c '.locks[1].kep = "edges"' "$sample/last.request.json" > misspelt.json
    says "/locks/1/kep: unknown field; did you mean 'keep'? Known here: curve, keep, priority, region" \
        flatten "$sample/last.obj" --request misspelt.json --out out
    jq -c '.locks[1].curve = "hel"' "$sample/last.request.json" > no_curve.json
    says "lock of hel: there is no curve 'hel'; there are: centre_front, featherline, heel, topline (/locks/1/curve of the request)" \
        flatten "$sample/last.obj" --request no_curve.json --out out
    [[ ! -e out ]]
}

@test "with --json what is wrong with the arguments is a problem document" {
    run --separate-stderr "$LASTFLAT" flaten --json
    assert_equal "$status" 2
    assert_equal "$(jq -c '[.status, .code, .detail]' <<< "$stderr")" \
        "[400,\"arguments_invalid\",\"there is no command 'flaten'; did you mean 'flatten'?\"]"
}

@test "inspect counts each face once" {
    printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\ng b a\nf 1 2 3\ng a\nf 1 3 4\n' > square.obj
    "$LASTFLAT" inspect square.obj > square.json
    jq -e '.file.groups == [{names: ["a"], triangles: 1}, {names: ["a", "b"], triangles: 1}]' square.json
    for model in "$sample/last.obj" "$sample/last.glb"; do
        "$LASTFLAT" inspect "$model" | jq -e '.file | (.groups | map(.triangles) | add) == .triangles'
    done
}

@test "a region that the request leaves out is warned of" {
    jq -c 'del(.regions.medial)' "$sample/last.request.json" > half.json
    run -0 "$LASTFLAT" flatten "$sample/last.obj" --request half.json --out out
    [[ $output == *"warning: a piece of "*" is none of the regions and is left out; name it in \"regions\" if it is wanted"* ]]
    jq -e '.warnings | map(.code) == ["piece_left_out"]' out/result.json
}

@test "arguments that are wrong end with 2" {
    for arguments in "" "flatten" "flatten a.obj" "flaten" "serve --listen nowhere" "serve --workers many" "sample-last"; do
        # shellcheck disable=SC2086
        run --separate-stderr "$LASTFLAT" $arguments
        assert_equal "$arguments: $status" "$arguments: 2"
        [[ -n $stderr ]]
    done
}

@test "output that cannot be written ends with 1 and a problem document" {
    echo > file
    run --separate-stderr "$LASTFLAT" flatten --json "$sample/last.obj" --request "$sample/last.request.json" --out file/out
    assert_equal "$status" 1
    assert_equal "$output" ""
    assert_equal "$(jq -c '[.status, .code]' <<< "$stderr")" '[500,"file_unwritable"]'
    mkdir -p out/flat.glb/taken
    run --separate-stderr "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out out
    assert_equal "$status" 1
    assert_equal "$(ls -A out | xargs)" flat.glb
}

@test "an address that is taken ends serve with 1" {
    start_server
    run --separate-stderr timeout 10 "$LASTFLAT" serve --listen "${url#http://}"
    stop_servers
    assert_equal "$status" 1
    [[ $stderr == *"cannot listen"* ]]
}

@test "sample-last gives the same bytes each time, and the last of the client examples" {
    "$LASTFLAT" sample-last --out again
    for file in last.obj last.glb last.request.json; do cmp "$sample/$file" "again/$file"; done
    "$LASTFLAT" sample-last --size 36 --toe pointed --out other
    run ! cmp -s "$sample/last.obj" other/last.obj
    shipped=()
    for file in "$examples"/sample-last/last.*; do [[ -f $file ]] && shipped+=("$file"); done
    (( ${#shipped[@]} )) || skip "client-examples/sample-last has no files"
    for file in "${shipped[@]}"; do cmp "$file" "again/${file##*/}"; done
}

@test "a bare last needs no request, and what is found may be sent back" {
    grep -v '^g ' "$sample/last.obj" > bare.obj
    "$LASTFLAT" flatten bare.obj --out bare
    jq -e '.found.foot == "right" and (.regions | map(.name)) == ["lateral", "medial"] and .warnings == []' bare/result.json
    jq -e '[.regions[].curves[] | select(.locked)] | length == 4 and all(.verdict == "pass")' bare/result.json
    jq .found.request bare/result.json > found.json
    "$LASTFLAT" flatten bare.obj --request found.json --out again
    jq -e '.warnings == []' again/result.json
    jq -e --slurpfile first bare/result.json '[.regions[].metrics.symmetric_dirichlet] as $b
        | [$first[0].regions[].metrics.symmetric_dirichlet] | [., $b] | transpose | all((.[0] - .[1]) | fabs < 1e-6)' again/result.json
    "$LASTFLAT" inspect bare.obj | jq -e '.flattens and .found.confidence.featherline > 0.9 and .surface.closed'
}

@test "points of the last are found on the pattern, and the way back" {
    "$LASTFLAT" flatten "$sample/last.obj" --request "$sample/last.request.json" --out flat
    echo '{"to_last": {"region": "lateral", "points": [[5, 5]]}}' > there.json
    "$LASTFLAT" map flat/flat.obj there.json > there.out
    jq '{to_pattern: {region: "lateral", points: [.to_last.points[0].position]}}' there.out > back.json
    "$LASTFLAT" map flat/flat.obj back.json | jq -e '.to_pattern.points[0].uv_mm | all((. - 5) | fabs < 1e-6)'
}
