#!/usr/bin/env bash
# Builds the program optimised, without tests, in build/: installs what is missing first. Safe to run again; fast when
# nothing changed. What the build prints is shown when it fails.
# usage: scripts/build.sh [-DOPTION=VALUE...] [TARGET...]     default: dynamic-icp
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh clang
scripts/install_viewer.sh
if command -v clang++ >/dev/null; then  # builds in two thirds of the time; a build folder keeps its first compiler
  export CXX=${CXX:-clang++}
fi

options=(-DDYNAMIC_ICP_BUILD_TESTS=OFF)
while [[ "${1:-}" == -D* ]]; do
  options+=("$1")
  shift
done

echo "== Building build/dynamic-icp"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
{
  cmake --preset release "${options[@]}"
  cmake --build build --target "${@:-dynamic-icp}"
} >"$log" 2>&1 || { cat "$log"; exit 1; }
