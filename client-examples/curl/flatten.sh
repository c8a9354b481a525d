#!/usr/bin/env bash
# Flattens a last: sends it, waits, saves the pattern and prints what became of every curve.
#
#   flatten.sh LAST [REQUEST]      LAST: OBJ, STL, PLY, glTF or GLB; REQUEST: the constraint JSON
#
# LASTFLAT_URL  the server; default http://127.0.0.1:8080
# LASTFLAT_KEY  the API key, if the server asks for one
# OUT           the folder for result.json, pattern.svg and flat.glb; default: a folder with the last's name, here
#
# Ends with 0; with 2 if the last or the request is at fault; with 1 if anything else is. Needs curl and jq.
set -euo pipefail

[[ $# -ge 1 && $# -le 2 ]] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
last=$1 request=${2:-}
url=${LASTFLAT_URL:-http://127.0.0.1:8080}
name=$(basename -- "$last")
out=${OUT:-./${name%.*}}
for file in "$last" ${request:+"$request"}; do
    [[ -f $file && -r $file ]] || { echo "flatten.sh: cannot read $file" >&2; exit 2; }
done
temporary=$(mktemp -d)
trap 'rm -rf -- "$temporary"' EXIT

# In a file, so that the key is in no list of processes.
echo "${LASTFLAT_KEY:+Authorization: Bearer $LASTFLAT_KEY}" > "$temporary/key"

# A number to so many places; what rounds to nothing has no sign.
places() {  # places, number
    local text
    LC_ALL=C printf -v text "%.$1f" "$2"
    if [[ $text =~ ^-[0.]*$ ]]; then text=${text#-}; fi
    echo "$text"
}

# Prints a problem document and ends: 2 if the request is at fault, 1 if the server is.
fail() {  # status, file
    jq -r '"flatten.sh: \(.detail)", (.pointer // empty | "  at: \(.)"), "  code: \(.code)"' "$2" >&2 2>/dev/null ||
        echo "flatten.sh: the server answered with $1" >&2
    if [[ $1 == 4* ]]; then exit 2; fi
    exit 1
}

# Runs curl; the body goes to a file, the headers to another, the status to $status.
ask() {  # body file, curl's arguments...
    status=$(curl -sS -g -o "$1" -D "$temporary/headers" -H "@$temporary/key" -w '%{http_code}' "${@:2}") || exit 1
}

retry_after() {
    sed -n 's/^[Rr]etry-[Aa]fter: *\([0-9]*\).*/\1/p' "$temporary/headers" | tail -n 1
}

# curl gives ; and , and " in a file's name a meaning of their own, so it gets the bytes by another name.
ln -s -- "$(realpath -- "$last")" "$temporary/model"
parts=(-F "model=@$temporary/model;filename=model;type=application/octet-stream")
if [[ $request ]]; then
    ln -s -- "$(realpath -- "$request")" "$temporary/request"
    parts+=(-F "request=@$temporary/request;filename=request.json;type=application/json")
fi

once=$$-$EPOCHREALTIME-$RANDOM  # makes it one job, however often it is sent
for (( attempt = 1; ; attempt++ )); do
    ask "$temporary/job" -H "Idempotency-Key: $once" "${parts[@]}" "$url/v1/jobs"
    [[ $status == 503 && $attempt -lt 5 ]] || break  # the queue is full: come back when told
    sleep "$(retry_after)"
done
[[ $status == 202 ]] || fail "$status" "$temporary/job"
job=$url$(jq -r .links.self "$temporary/job")

while :; do
    case $(jq -r .state "$temporary/job") in
        succeeded) break ;;
        failed) jq .error "$temporary/job" > "$temporary/problem"; fail 422 "$temporary/problem" ;;
        canceled) echo "flatten.sh: the job was canceled" >&2; exit 1 ;;
    esac
    sleep 0.1  # answered at once when all places to wait are taken
    ask "$temporary/job" -H 'Prefer: wait=30' "$job"
    [[ $status == 200 ]] || fail "$status" "$temporary/job"
done

mkdir -p -- "$out"
for format in json:result.json svg:pattern.svg glb:flat.glb; do
    ask "$temporary/result" "$job/result?format=${format%%:*}"
    [[ $status == 200 ]] || fail "$status" "$temporary/result"
    mv -- "$temporary/result" "$out/${format#*:}"
done

echo "flat - last: above 0 a curve is gathered when it is lasted, below 0 stretched"
row='%-16s %-16s %10s %10s %14s %8s  %s\n'
# shellcheck disable=SC2059
printf "$row" region curve "last mm" "flat mm" "flat - last mm" % verdict
jq -r '.regions[] | .name as $region | .curves[] | (., (.zones // [])[] + {zone: true})
       | [$region, (if .zone then "- " else "" end) + .name, .length_3d_mm, .length_2d_mm,
          .error_mm // .ease_mm, .ease_percent // 0, .verdict // "-"] | @tsv' "$out/result.json" |
    while IFS=$'\t' read -r region curve length_3d length_2d difference percent verdict; do
        # shellcheck disable=SC2059
        printf "$row" "$region" "$curve" "$(places 3 "$length_3d")" "$(places 3 "$length_2d")" \
            "$(places 6 "$difference")" "$(places 3 "$percent")" "$verdict"
    done
jq -r '.pairs[] | [.a, .b, .curve, .difference_mm, .verdict] | @tsv' "$out/result.json" |
    while IFS=$'\t' read -r a b curve difference verdict; do
        echo "pair $curve: $a and $b differ by $(places 6 "$difference") mm  $verdict"
    done
jq -r '.warnings[] | "warning: \(.detail)"' "$out/result.json"
echo "written to $out: result.json pattern.svg flat.glb"
