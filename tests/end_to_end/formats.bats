#!/usr/bin/env bats
# Which format of a result is given.

load helper

setup_file() { require_program; make_sample; }
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    start_server
    flatten "$sample/last.obj" "$sample/last.request.json"
}
teardown() { stop_servers; }

# assert_given TYPE CURL_ARGUMENTS...
assert_given() {
    ask "${@:2}"
    assert_equal "$status ${*:2:2}: $(header Content-Type)" "200 ${*:2:2}: $1"
    assert_equal "$(header Vary)" "Accept, Accept-Encoding"
    assert_equal "$(header Content-Length)" "$(stat -c %s "$body")"
}

@test "Accept chooses the format, by its weights and the most specific match" {
    result=$url$job/result
    assert_given application/json -H 'Accept: */*' "$result"
    assert_given application/json -H 'Accept:' "$result"
    assert_given application/json -H 'Accept: application/json' "$result"
    assert_given image/svg+xml -H 'Accept: image/svg+xml' "$result"
    assert_given image/svg+xml -H 'Accept: image/*' "$result"
    assert_given model/gltf-binary -H 'Accept: model/gltf-binary' "$result"
    assert_given model/obj -H 'Accept: model/obj' "$result"
    assert_given model/gltf-binary -H 'Accept: image/svg+xml;q=0.8, model/gltf-binary;q=0.9' "$result"
    assert_given image/svg+xml -H 'Accept: image/svg+xml;q=0.9, model/gltf-binary;q=0.8' "$result"
    assert_given image/svg+xml -H 'Accept: application/json;q=0.1, */*;q=0.5' "$result"
    assert_given image/svg+xml -H 'Accept: application/json;q=0, */*' "$result"
    assert_given model/obj -H 'Accept: text/html, model/*;q=0.2, model/obj;q=0.3' "$result"
    assert_given image/svg+xml -H 'Accept: IMAGE/SVG+XML ; Q=1.0' "$result"
}

@test "format goes before Accept" {
    assert_given model/gltf-binary -H 'Accept: image/svg+xml' "$url$job/result?format=glb"
    head -c 4 "$body" | grep -q '^glTF$'
    assert_given image/svg+xml -H 'Accept: text/html' "$url$job/result?format=svg"
    assert_given application/json -H 'Accept: image/svg+xml' "$url$job/result?format=json"
    assert_given model/obj -H 'Accept: image/svg+xml' "$url$job/result?format=obj"
    assert_equal "$(header Content-Disposition)" "inline; filename=\"${job##*/}.obj\""
}

@test "a format that there is not is refused with those there are" {
    ask -H 'Accept: text/html' "$url$job/result"
    assert_problem 406 not_acceptable
    for type in application/json image/svg+xml model/gltf-binary model/obj; do grep -qF "$type" "$body"; done
    ask -H 'Accept: application/json;q=0' "$url$job/result"
    assert_problem 406 not_acceptable
    ask "$url$job/result?format=dxf"
    assert_problem 400 format_unknown
}

@test "HEAD says what GET would give, without giving it" {
    for format in json svg glb obj; do
        ask "$url$job/result?format=$format"
        size=$(stat -c %s "$body") type=$(header Content-Type)
        ask -I "$url$job/result?format=$format"
        assert_equal "$status $(header Content-Length) $(header Content-Type)" "200 $size $type"
        printf 'HEAD %s/result?format=%s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' "$job" "$format" > "$BATS_TEST_TMPDIR/head"
        exec 4<> "/dev/tcp/127.0.0.1/${url##*:}"
        cat "$BATS_TEST_TMPDIR/head" >&4
        assert_equal "$(timeout 10 cat <&4 | tr -d '\r' | sed '1,/^$/d' | wc -c)" 0
        exec 4>&-
    done
    ask -I -H 'Accept: text/html' "$url$job/result"
    assert_equal "$status" 406
}

@test "who takes gzip gets it, with a tag of its own" {
    for format in json svg glb obj; do
        ask "$url$job/result?format=$format"
        cp "$body" "$BATS_TEST_TMPDIR/plain"
        tag=$(header ETag)
        ask -H 'Accept-Encoding: gzip' "$url$job/result?format=$format"
        assert_equal "$status $(header Content-Encoding)" "200 gzip"
        [[ $(header ETag) != "$tag" ]]
        gunzip -c < "$body" | cmp - "$BATS_TEST_TMPDIR/plain"
        ask -H 'Accept-Encoding: gzip' -H "If-None-Match: $(header ETag)" "$url$job/result?format=$format"
        assert_equal "$status" 304
    done
}
