#!/usr/bin/env bash
# What takes too long for every change: the static analysis of all sources, the whole suite by both compilers under the
# sanitizers, shared libraries, and the claims of the documents about the simulator, the diagnosis and the method. Hours
# on two cores.
# usage: scripts/check.sh [tidy] [sanitizers] [shared] [claims]     default: all; what they need is installed
set -euo pipefail
cd "$(dirname "$0")/.."
parts=("$@")
[[ $# -eq 0 ]] && parts=(tidy sanitizers shared claims)

scripts/install_dependencies.sh tests fuzzing lint
scripts/install_viewer.sh tests

tidy() {
  cmake --preset debug -DDYNAMIC_ICP_BUILD_TESTS=ON -DDYNAMIC_ICP_PRECOMPILED_HEADERS=OFF >/dev/null
  git ls-files 'dynamic_icp/*.cpp' 'apps/*.cpp' 'benchmarks/*.cpp' 'fuzz/*.cpp' 'tests/*.cpp' |
    grep -vE '_test\.cpp$|^tests/consumer|^fuzz/|^benchmarks/' |
    xargs -P "$(nproc)" -n 8 clang-tidy --quiet -p build-debug
}

suite() {  # preset
  cmake --preset "$1" -DDYNAMIC_ICP_BUILD_TESTS=ON >/dev/null
  cmake --build --preset "$1"
  ctest --preset "$1" -j "$(nproc)"
}

sanitizers() {
  suite asan    # GCC
  suite method  # clang, with assertions
  suite tsan
}

shared() {
  cmake --preset release -B build-shared -DBUILD_SHARED_LIBS=ON -DDYNAMIC_ICP_BUILD_TESTS=OFF >/dev/null
  cmake --build build-shared
  tests/install_test.sh "$PWD/build-shared" "$PWD/tests" cmake
}

claims() {
  cmake --preset release >/dev/null
  cmake --build --preset release --target dynamic-icp
  local program=build/dynamic-icp out
  out=$(mktemp -d)
  trap "rm -rf '$out'" EXIT
  for scene in street city tunnel off-road; do
    "$program" simulate "$scene" --frames 20 --point-truth --quiet --output "$out/$scene-1"
    "$program" run "$out/$scene-1" --quiet --output "$out/run-$scene"
    /usr/bin/python3 scripts/check_run.py "$out/$scene-1" "$out/run-$scene"
  done
  /usr/bin/python3 scripts/check_simulation.py "$out"/*-1
  /usr/bin/python3 scripts/check_diagnosis.py "$program" "$out/diagnosis" --scenes street,roundabout --seeds 1
}

for part in "${parts[@]}"; do
  case $part in
    tidy | sanitizers | shared | claims)
      echo "== $part"
      "$part" ;;
    *)
      echo "unknown part '$part'; known are: tidy, sanitizers, shared, claims" >&2
      exit 2 ;;
  esac
done
