#!/usr/bin/env bash
# Installs what is missing, builds and runs every test. Safe to run again; fast when nothing changed.
# usage: scripts/test.sh              the whole suite, optimised
#        scripts/test.sh sanitizers   the suite under the address and undefined-behaviour sanitizers, and the threaded
#                                     rooms under the thread sanitizer (a quarter of an hour on two cores)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh tests

build_and_test() {  # preset, then arguments for ctest
  local preset=$1
  shift
  echo "== Building ($preset)"
  cmake --preset "$preset" -DDYNAMIC_ICP_BUILD_TESTS=ON | grep -iE 'warning|error' || true
  cmake --build --preset "$preset"
  echo "== Testing ($preset)"
  ctest --preset "$preset" -j "$(nproc)" "$@"
}

if [[ "${1:-}" == sanitizers ]]; then
  build_and_test asan
  build_and_test tsan -R '^(base|preprocess|ego_motion|dynamics|registration|odometry|simulation)\.'
else
  build_and_test release
fi
