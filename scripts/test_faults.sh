#!/usr/bin/env bash
# Lets the machine fail under every command that writes: calls of the C library one by one, kill -9, full and read-only
# disks, limits of files and memory, input that disappears, network folders that vanish. What must hold then:
# docs/robustness.md. Status 1 if it does not.
# usage: scripts/test_faults.sh [--places N] [--calls CALL,...] [--kills N] [--parts calls,kills,resume,vanish,disk,limits,inputs] [--commands NAME,...]
#   --places  so many calls of each kind fail in turn (default 40; 0: every one, hours for malloc)
#   --calls   which calls: open,read,write,fsync,rename,mkdir,stat,malloc (default all)
#   --kills   kills of each command (default 125: more than 1000 of the nine commands that write)
# BUILD (environment): the build folder, default build.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build}

[[ -f $build/CMakeCache.txt ]] || cmake --preset release -DDYNAMIC_ICP_BUILD_TESTS=ON >/dev/null
cmake --build "$build" --target dynamic-icp failing_calls
exec /usr/bin/python3 tests/faults/faults.py "$build/dynamic-icp" --library "$build/tests/failing_calls.so" --places 40 --kills 125 "$@"
