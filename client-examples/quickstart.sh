#!/usr/bin/env bash
# From a bare Debian 12 to a flat pattern: installs what is missing, builds, starts the service,
# flattens a last (the sample, or the one named) and says where the pattern is.
# Usage: quickstart.sh [LAST [REQUEST.json]]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
last=$(realpath "${1:-$here/sample-last/last.obj}")
request=${2:-}
[ $# -eq 0 ] && request=$here/sample-last/last.request.json
[ -n "$request" ] && request=$(realpath "$request")
cd "$root"

tests/install.sh run build client
echo "building (a few minutes the first time) ..."
log=$(mktemp)
if ! { cmake --preset release && cmake --build --preset release --target lastflat; } >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "the build failed" >&2
    exit 1
fi

echo "starting the service ..."
build/release/lastflat serve --listen 127.0.0.1:0 --data build/quickstart/data >"$log" 2>&1 &
service=$!
trap 'kill "$service" 2>/dev/null || true; wait "$service" 2>/dev/null || true; rm -f "$log"' EXIT
for _ in $(seq 100); do
    grep -q '^listening on ' "$log" && break
    kill -0 "$service" 2>/dev/null || { cat "$log" >&2; exit 1; }
    sleep 0.05
done
LASTFLAT_URL=$(sed -n 's/^listening on //p' "$log")
export LASTFLAT_URL

OUT=${OUT:-$root/build/quickstart}
export OUT
"$here/curl/flatten.sh" "$last" ${request:+"$request"}

cat <<EOF

done: the pattern is $OUT/pattern.svg (1 unit = 1 mm), the metrics are in $OUT/result.json
to keep the service running: build/release/lastflat serve
EOF
