#!/usr/bin/env bats
# Keys that may do less, and tokens for web pages.

load helper

setup_file() { require_program; make_sample; }
setup() {
    sample=$BATS_FILE_TMPDIR/sample
    DATA=$BATS_TEST_TMPDIR/data
    key=$(add_key whole)
    start_server
    with_key=(-H "Authorization: Bearer $key")
}
teardown() { stop_servers; }

add_key() { "$LASTFLAT" keys add "$@" --data "$DATA" 2> "$BATS_TEST_TMPDIR/said"; }

# make_token JSON: sets $token.
make_token() {
    ask "${with_key[@]}" -H 'Content-Type: application/json' --data "$1" "$url/v1/tokens"
    assert_equal "$status" 201
    token=$(jq -r .token "$body")
}

@test "a page with a token of one job sees its events and its pattern, and nothing is written of the token" {
    ask "${with_key[@]}" -H 'Prefer: wait=60' -F "model=@$sample/last.obj" -F "request=@$sample/last.request.json" "$url/v1/jobs"
    assert_equal "$status" 200
    job=$(jq -r .links.self "$body")
    make_token "{\"scope\": \"job:${job##*/}\"}"
    ask "$url$job/result.svg?token=$token"
    assert_equal "$status" 200
    ask "$url$job/events?token=$token"
    grep -qx 'event: done' "$body"
    ask "$url$job/result?token=$token&format=glb"
    assert_equal "$status $(header Content-Type)" "200 model/gltf-binary"
    ask "$url$job?token=$token"
    assert_problem 400 parameter_unknown
    ask -H "Authorization: BEARER $token" "$url$job"
    assert_equal "$status" 200
    ask -X DELETE -H "Authorization: Bearer $token" "$url$job"
    assert_problem 403 scope_refused
    ! grep -rqF "$token" "$DATA" "$BATS_TEST_TMPDIR"/server.*.err
    "$LASTFLAT" keys revoke "$(cut -d_ -f2 <<< "$key")" --data "$DATA"
    ask "$url$job/result.svg?token=$token"
    assert_problem 401 token_invalid
}

@test "a page with a token of one asset makes jobs of it and follows them, and touches no other" {
    ask "${with_key[@]}" --data-binary "@$sample/last.obj" "$url/v1/assets"
    asset=$(jq -r .id "$body")
    ask "${with_key[@]}" --data-binary "@$sample/last.glb" "$url/v1/assets"
    other=$(jq -r .id "$body")
    make_token "{\"scope\": \"asset:$asset\", \"expires_in_s\": 60}"
    page=(-H "Authorization: Bearer $token" -H 'Content-Type: application/json')
    jq -c --arg asset "$asset" '{model: {asset_id: $asset}, request: .}' "$sample/last.request.json" > "$BATS_TEST_TMPDIR/asked"
    ask "${page[@]}" -H 'Prefer: wait=60' --data-binary "@$BATS_TEST_TMPDIR/asked" "$url/v1/jobs"
    assert_equal "$status" 200
    job=$(jq -r .links.self "$body")
    ask "${page[@]}" "$url$job/result"
    assert_equal "$status" 200
    ask "${page[@]}" --data "{\"model\": {\"asset_id\": \"$other\"}}" "$url/v1/jobs"
    assert_problem 403 scope_refused
    ask -H "Authorization: Bearer $token" -F "model=@$sample/last.obj" "$url/v1/jobs"
    assert_problem 403 scope_refused
    ask "${page[@]}" --data "{\"model\": {\"asset_id\": \"$other\"}}" "$url/v1/validate"
    assert_problem 403 scope_refused
    ask "${page[@]}" "$url/v1/jobs"
    assert_problem 403 scope_refused
}

@test "a webhook needs a key that may do all, in whatever form the job is sent" {
    stop_servers
    start_server --webhooks any
    jobs=$(add_key jobs --scope jobs)
    ask "${with_key[@]}" --data-binary "@$sample/last.obj" "$url/v1/assets"
    asset=$(jq -r .id "$body")
    jq -nc --arg asset "$asset" \
        '{model: {asset_id: $asset}, webhook: {url: "http://127.0.0.1:9/", secret: "whsec_MDEyMzQ1Njc4OWFiY2RlZjAxMjM0NTY3ODlhYmNkZWY="}}' > "$BATS_TEST_TMPDIR/hooked"
    jq -c '{jobs: [., .]}' "$BATS_TEST_TMPDIR/hooked" > "$BATS_TEST_TMPDIR/batch"
    make_token '{"scope": "submit"}'; submit=$token
    make_token "{\"scope\": \"asset:$asset\"}"
    for bearer in "$jobs" "$submit" "$token"; do
        limited=(-H "Authorization: Bearer $bearer" -H 'Content-Type: application/json')
        ask "${limited[@]}" --data-binary "@$BATS_TEST_TMPDIR/hooked" "$url/v1/jobs"
        assert_problem 403 scope_refused
        ask "${limited[@]}" -X PUT --data-binary "@$BATS_TEST_TMPDIR/hooked" "$url/v1/jobs/01M818EZFT08H3ZKBCZV6HRD97"
        assert_problem 403 scope_refused
        ask "${limited[@]}" --data-binary "@$BATS_TEST_TMPDIR/batch" "$url/v1/jobs:batch"
        assert_problem 403 scope_refused
    done
    ask "${with_key[@]}" -H 'Content-Type: application/json' --data-binary "@$BATS_TEST_TMPDIR/hooked" "$url/v1/jobs"
    assert_equal "$status" 202
}

@test "keys have a scope and an end" {
    look=$(add_key look --scope read)
    over=$(add_key over --expires 1s)
    ask -H "Authorization: Bearer $look" "$url/v1/jobs"
    assert_equal "$status" 200
    ask -H "Authorization: Bearer $look" --data-binary "@$sample/last.obj" "$url/v1/jobs"
    assert_problem 403 scope_refused
    is_over() { [[ $(curl -sS -o "$BATS_TEST_TMPDIR/over" -w '%{http_code}' -H "Authorization: Bearer $over" "$url/v1/jobs") == 401 ]]; }
    wait_until 5 is_over
    "$LASTFLAT" keys list --data "$DATA" > "$BATS_TEST_TMPDIR/keys"
    grep -Eq '  good  all  whole$' "$BATS_TEST_TMPDIR/keys"
    grep -Eq '  good  read  look$' "$BATS_TEST_TMPDIR/keys"
    grep -Eq '  expired [0-9T:.-]+Z  all  over$' "$BATS_TEST_TMPDIR/keys"
    run -2 "$LASTFLAT" keys add more --scope write --data "$DATA"
    run -2 "$LASTFLAT" keys add more --expires soon --data "$DATA"
}
