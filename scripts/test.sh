#!/usr/bin/env bash
# Installs what is missing, builds and runs every test. Safe to run again; fast when nothing changed.
# usage: scripts/test.sh              the whole suite, optimised
#        scripts/test.sh method       the tests of the method, built by clang with assertions, under the address and
#                                     undefined-behaviour sanitizers
#        scripts/test.sh sanitizers   the suite under the address and undefined-behaviour sanitizers, and the threaded
#                                     modules under the thread sanitizer (a quarter of an hour on two cores)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh tests
scripts/install_viewer.sh tests

configure() {  # preset
  echo "== Configuring and building ($1)"
  local benchmarks=OFF  # the kernels are tried where Google Benchmark is installed
  dpkg-query -W libbenchmark-dev >/dev/null 2>&1 && benchmarks=ON
  cmake --preset "$1" -DDYNAMIC_ICP_BUILD_TESTS=ON -DDYNAMIC_ICP_BUILD_BENCHMARKS=$benchmarks | grep -iE 'warning|error' || true
}

run_tests() {  # preset, then arguments for ctest
  local preset=$1
  shift
  echo "== Testing ($preset)"
  ctest --preset "$preset" -j "$(nproc)" "$@"
}

if [[ "${1:-}" == sanitizers ]]; then
  configure asan
  cmake --build --preset asan
  run_tests asan
  threaded_modules=(base preprocess ego_motion dynamics registration odometry simulation report)
  configure tsan
  cmake --build --preset tsan --target $(printf 'dynamic_icp_%s_test ' "${threaded_modules[@]}")
  run_tests tsan -R "^($(IFS='|'; echo "${threaded_modules[*]}"))\\."
elif [[ "${1:-}" == method ]]; then
  scripts/install_dependencies.sh fuzzing
  modules=(base spatial estimation preprocess ego_motion dynamics tracking mapping registration odometry)
  configure method
  cmake --build --preset method --target $(printf 'dynamic_icp_%s_test ' "${modules[@]}") dynamic_icp_library_test
  run_tests method -R "^($(IFS='|'; echo "${modules[*]}")|library)\\."
else
  configure release
  cmake --build --preset release
  run_tests release
fi
