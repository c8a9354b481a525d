#!/usr/bin/env bats
# What `cmake --install` makes, under a root of its own.

load helper

setup_file() {
    require_program
    export ROOT=$BATS_FILE_TMPDIR/root
    DESTDIR=$ROOT cmake --install "$(dirname "$LASTFLAT")" > "$BATS_FILE_TMPDIR/installed"
}
setup() {
    prefix=$ROOT/usr/local
    docs=$prefix/share/doc/lastflat
    built=$LASTFLAT
    LASTFLAT=$prefix/bin/lastflat
    cd "$BATS_TEST_TMPDIR" || return 1
}
teardown() { stop_servers; }

@test "the installed service flattens the installed sample as the built program does" {
    [[ ! -e $prefix/bin/lastflat-work ]]
    local last=$docs/client-examples/sample-last/last
    start_server
    OUT=served "$docs/client-examples/curl/flatten.sh" "$last.obj" "$last.request.json" > table
    "$built" flatten "$last.obj" --request "$last.request.json" --out built
    assert_same_result served/result.json built/result.json
}

@test "the unit starts the program that is installed" {
    local unit=$prefix/lib/systemd/system/lastflat.service
    [[ -x $ROOT$(sed -n 's/^ExecStart=\([^ ]*\) serve$/\1/p' "$unit") ]]
    run -1 grep -n '@[A-Z_]*@' "$unit"
}

@test "what the installed documents point to is installed" {
    local page link links=0
    cmp "$docs/api/openapi.json" "$contract"
    while read -r page; do
        for link in $(grep -oP '\]\(\K[^)#]+' "$page" | grep -v '^http'); do
            [[ -e $(dirname "$page")/$link ]] || assert_equal "$page" "a link to something, not $link"
            links=$((links + 1))
        done
    done < <(find "$docs" -name '*.md')
    (( links > 15 ))
}
