#!/usr/bin/env bash
# Installs the library into a folder of its own, builds a stranger's project against it and runs that.
# usage: install_test.sh BUILD_FOLDER CONSUMER_SOURCES CMAKE
set -euo pipefail
build=$1 consumer=$2 cmake=$3

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$cmake" --install "$build" --prefix "$folder/installed" >/dev/null
"$cmake" -S "$consumer" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_BUILD_TYPE=Release >/dev/null
"$cmake" --build "$folder/build"
"$folder/installed/bin/dynamic-icp" simulate street --frames 2 --quiet --output "$folder/street"
"$folder/build/consumer" "$folder/street" | tee "$folder/output"
[[ $(wc -l <"$folder/output") -eq 2 ]]
