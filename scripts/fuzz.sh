#!/usr/bin/env bash
# Feeds the readers with damaged files, and every method with scans of any numbers (target `scans`) and changed states (`states`), until
# something breaks, under the address and undefined-behaviour sanitizers: libFuzzer, two targets at a time. Installs clang when it is missing.
# usage: scripts/fuzz.sh [SECONDS] [TARGET...]     each target for SECONDS (default 60); default: all targets
# The random numbers begin with SEED (environment, default 1). Findings stay in build-fuzz/findings, inputs that reach new code in build-fuzz/corpus;
# scripts/fuzz_table.py makes a table of what was tried. Status 1 after a finding.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "usage: scripts/fuzz.sh [SECONDS] [TARGET...]" >&2; exit 2; }
shift $(($# > 0 ? 1 : 0))
known=(npy npz pcd ply tum xyzd records aevascenes columns csv texts rosbag mcap db3 messages settings live scans states)
targets=("$@")
[[ $# -eq 0 ]] && targets=("${known[@]}")
for target in "${targets[@]}"; do
  [[ " ${known[*]} " == *" $target "* ]] || { echo "unknown target '$target'; known are: ${known[*]}" >&2; exit 2; }
done

scripts/install_dependencies.sh fuzzing tests

build=build-method
results=build-fuzz
echo "== Configuring and building"
cmake --preset method | grep -iE 'warning|error' || true
cmake --build --preset method --target fuzzers
rm -rf "$results/seeds"  # made anew: databases are not written twice
$build/fuzz/fuzz_seeds "$results/seeds"
mkdir -p "$results/findings"

run() {  # target
  local status=0
  mkdir -p "$results/corpus/$1"
  "$build/fuzz/fuzz_$1" -max_total_time="$seconds" -seed="${SEED:-1}" -timeout=60 -rss_limit_mb=1024 -malloc_limit_mb=512 -max_len=8192 \
    -print_final_stats=1 -artifact_prefix="$results/findings/$1-" "$results/corpus/$1" "$results/seeds/$1" >"$results/$1.log" 2>&1 || status=1
  printf '%s\t%s\n' "$1" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$results/$1.log")" >>"$results/executions.tsv"
  if ((status)); then
    echo "$1: FINDING, see $results/$1.log"
  else
    echo "$1: $(grep -E '^Done' "$results/$1.log" || echo done)"
  fi
  return $status
}

echo "== Fuzzing, $seconds s each"
status=0
for ((i = 0; i < ${#targets[@]}; i += 2)); do
  jobs=()
  for target in "${targets[@]:i:2}"; do
    run "$target" &
    jobs+=($!)
  done
  for job in "${jobs[@]}"; do
    wait "$job" || status=1
  done
done
exit $status
