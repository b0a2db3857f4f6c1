#!/usr/bin/env bash
# Installs what is missing, builds and runs every test. Safe to run again; fast when nothing changed.
# usage: scripts/test.sh              the whole suite, optimised
#        scripts/test.sh format       whether every source is formatted as .clang-format says
#        scripts/test.sh method       the tests of the method, built by clang with assertions, under the address and
#                                     undefined-behaviour sanitizers; without the drives that take minutes there
#        scripts/test.sh threads      every method with several threads, under the thread sanitizer
# scripts/check.sh runs what takes longer.
set -euo pipefail
cd "$(dirname "$0")/.."

if [[ "${1:-}" == format ]]; then
  scripts/install_dependencies.sh format
  git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
  exit
fi

scripts/install_dependencies.sh tests
scripts/install_viewer.sh tests
python=OFF  # only the whole suite has it

configure() {  # preset
  echo "== Configuring and building ($1)"
  local benchmarks=OFF  # the kernels are tried where Google Benchmark is installed
  dpkg-query -W libbenchmark-dev >/dev/null 2>&1 && benchmarks=ON
  cmake --preset "$1" -DDYNAMIC_ICP_BUILD_TESTS=ON -DDYNAMIC_ICP_BUILD_BENCHMARKS=$benchmarks \
    -DDYNAMIC_ICP_BUILD_PYTHON=$python | grep -iE 'warning|error' || true
}

run_tests() {  # preset, then arguments for ctest
  local preset=$1
  shift
  echo "== Testing ($preset)"
  ctest --preset "$preset" -j "$(nproc)" "$@"
}

if [[ "${1:-}" == threads ]]; then
  configure tsan  # the workers, and all that is given to them
  cmake --build --preset tsan --target dynamic_icp_base_test dynamic_icp_odometry_test
  run_tests tsan -R '^(base|odometry)\..*(Workers|Threads)'
elif [[ "${1:-}" == method ]]; then
  scripts/install_dependencies.sh fuzzing
  modules=(base spatial estimation preprocess ego_motion motion dynamics tracking registration mapping window odometry)
  configure method
  cmake --build --preset method --target $(printf 'dynamic_icp_%s_test ' "${modules[@]}") dynamic_icp_library_test
  # Drives of the baselines, and many drives in one test, take minutes each here. Other tests reach the same code (saved states: the
  # fuzz target `states`), and check.sh runs them.
  long=(KissIcp ScanToScanIcp Symmetry SavedState CraftedState StatesHowWellTheMotionIsKnown StartsAtAnySpeed UndoesSweeps
    TheDopplerAloneShows GoesOnForLong EveryAblationRuns LearnsWhetherStamps)
  run_tests method -R "^($(IFS='|'; echo "${modules[*]}")|library)\\." -E "\\.($(IFS='|'; echo "${long[*]}"))"
else
  if scripts/install_dependencies.sh python; then
    python=ON
  else
    echo "== The Python package is not built and its tests are skipped"
  fi
  configure release
  cmake --build --preset release
  run_tests release
fi
