#!/usr/bin/env bash
# Installs what is missing, from Debian 12's packages alone. Usage: install.sh run|build|client|test ...
#   run      what the program needs to run
#   build    what it needs to be built
#   client   what the client examples need
#   test     what its tests, client examples and checks need beside that
set -euo pipefail

run=(libcpp-httplib0.11 libtinygltf2d libdraco7 libmeshoptimizer2d libopenmesh1 libspdlog1.10 libsqlite3-0 libssl3 libdeflate0 libcurl4
     librsvg2-bin fonts-dejavu-core curl ca-certificates)
build=(g++ cmake ninja-build pkg-config libeigen3-dev libopenmesh-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev
       nlohmann-json3-dev libcpp-httplib-dev libspdlog-dev libcli11-dev libsqlitecpp-dev libsqlite3-dev libssl-dev libdeflate-dev libcurl4-openssl-dev doctest-dev)
client=(curl jq)
# Whoever has a Node of another origin keeps it.
command -v npm >/dev/null && node=() || node=(nodejs npm)
test=("${client[@]}" "${node[@]}" bats python3 python3-jsonschema procps nginx-light zlib1g-dev clang-format-14 clang-tidy-14 libcgal-dev)

wanted=()
for set in "$@"; do
    case "$set" in
        run) wanted+=("${run[@]}") ;;
        build) wanted+=("${build[@]}") ;;
        client) wanted+=("${client[@]}") ;;
        test) wanted+=("${test[@]}") ;;
        *) echo "install.sh: unknown set '$set' (run, build, client, test)" >&2; exit 2 ;;
    esac
done

missing=()
for package in "${wanted[@]}"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "installing: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
export DEBIAN_FRONTEND=noninteractive
if ! { "${as_root[@]}" apt-get update -qq &&
       "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    cat "$log" >&2
    echo "install.sh: the packages could not be installed" >&2
    exit 1
fi
