#!/usr/bin/env bash
# Feeds the readers with damaged files, and every method with scans of any numbers (target `scans`) and changed states (`states`), until
# something breaks, under the address and undefined-behaviour sanitizers: libFuzzer, two targets at a time. Installs clang when it is missing.
# usage: scripts/fuzz.sh [--deep] [--runs N] [SECONDS] [TARGET...]     default: all targets
#   SECONDS   at most so long for each target (default 60; with --runs as long as it takes)
#   --runs N  until the target has had N executions in all, those of earlier calls counted
#   --deep    without sanitizers, several times as many executions a second; then the inputs that reached new code once more with them
# The random numbers begin with SEED (environment, default 1) and differ from call to call, as all executions are counted
# (build-fuzz/executions.tsv; of a run that was killed those that it had told of). Findings stay in build-fuzz/findings, inputs that reach new
# code in build-fuzz/corpus; scripts/fuzz_table.py makes a table of what was tried. Status 1 after a finding. JOBS (environment, default 2):
# targets at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  echo "usage: scripts/fuzz.sh [--deep] [--runs N] [SECONDS] [TARGET...]" >&2
  exit 2
}

kind=sanitized
runs=
while [[ ${1:-} == --* ]]; do
  case $1 in
    --deep) kind=plain ;;
    --runs)
      runs=${2:-}
      [[ $runs =~ ^[1-9][0-9]*$ ]] || usage
      shift ;;
    *) usage ;;
  esac
  shift
done
seconds=60
[[ -z $runs ]] || seconds=0  # as long as it takes
if [[ ${1:-} =~ ^[0-9] ]]; then
  [[ $1 =~ ^[1-9][0-9]*$ ]] || usage
  seconds=$1
  shift
fi
known=(npy npz pcd ply tum xyzd records aevascenes columns csv texts rosbag mcap db3 messages settings live scans states)
targets=("$@")
[[ $# -eq 0 ]] && targets=("${known[@]}")
for target in "${targets[@]}"; do
  [[ " ${known[*]} " == *" $target "* ]] || { echo "unknown target '$target'; known are: ${known[*]}" >&2; exit 2; }
done

scripts/install_dependencies.sh fuzzing tests

results=build-fuzz
mkdir -p "$results/running"
exec {lock}>"$results/running/lock"  # fuzzers have it open as long as they run
flock --nonblock $lock || { echo "another scripts/fuzz.sh, or a fuzzer of one, is at work in $results" >&2; exit 1; }
# The files that are read lie in memory. A call that was killed has left its folder, whose lock nobody holds any more; one just made may
# have none yet.
memory=/dev/shm
[[ -w $memory ]] || memory=${TMPDIR:-/tmp}
find "$memory" -maxdepth 1 -type d -user "$(id -u)" -name 'dynamic-icp-fuzz.??????' -mmin +1 2>/dev/null | while read -r left; do
  flock --nonblock "$left" rm -rf "$left" || true
done
TMPDIR=$(mktemp -d -p "$memory" dynamic-icp-fuzz.XXXXXX)
export TMPDIR
exec {held}<"$TMPDIR"
flock $held
trap 'rm -rf "$TMPDIR"' EXIT
interrupted=72  # the status of a stopped fuzzer
echo "== Configuring and building"
build() {  # preset target...
  cmake --preset "$1" | grep -iE 'warning|error' || true
  cmake --build --preset "$1" --target "${@:2}"
}
build method fuzz_seeds "${targets[@]/#/fuzz_}"
[[ $kind == sanitized ]] || build deep "${targets[@]/#/fuzz_}"
rm -rf "$results/seeds"  # made anew: databases are not written twice
build-method/fuzz/fuzz_seeds "$results/seeds"
mkdir -p "$results/findings"
touch "$results/executions.tsv"

# Notes how many executions a run had: what it says at its end, or what it told last.
count() {  # target kind log
  local executions
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p; s/^#\([0-9]\+\)\t.*/\1/p' "$3" | sort -n | tail -1)
  printf '%s\t%s\t%s\n' "$1" "${executions:-0}" "$2" >>"$results/executions.tsv"
  mv "$3" "$results/$1.$2.log"
}

counted() { awk -F '\t' -v target="$1" '$1 == target { sum += $2 } END { printf "%.0f\n", sum }' "$results/executions.tsv"; }

fuzz() {  # target kind [option of libFuzzer...]
  local target=$1 kind=$2 folder=build-method status=0 longest=8192
  shift 2
  if [[ $kind == plain ]]; then
    folder=build-deep
    case $target in settings | live) longest=1024 ;; esac  # with longer texts far fewer executions a second
    set -- "$@" -entropic_feature_frequency_threshold=20  # where all is rare, looking for what is rarest takes most of the time
  fi
  [[ ! -e $results/seeds/$target.dict ]] || set -- "$@" -dict="$results/seeds/$target.dict"
  local log=$results/running/$target.$kind.log
  local earlier
  earlier=$(grep -c "^$target	" "$results/executions.tsv" || true)
  "$folder/fuzz/fuzz_$target" -seed=$((${SEED:-1} + earlier)) -timeout=60 -rss_limit_mb=1024 -malloc_limit_mb=512 -max_len=$longest \
    -print_final_stats=1 -artifact_prefix="$results/findings/$target-" "$@" "$results/corpus/$target" "$results/seeds/$target" >"$log" 2>&1 &
  fuzzer=$!
  while true; do  # a stopped one says at its end how far it came
    status=0
    wait "$fuzzer" || status=$?
    if ((status <= 128)) || ! kill -0 "$fuzzer" 2>/dev/null; then break; fi
  done
  count "$target" "$kind" "$log"
  if [[ -n $stopped ]] || ((status == interrupted)); then
    echo "$target: stopped"
    return 1
  fi
  if ((status)); then
    echo "$target: FINDING, see $results/$target.$kind.log"
    return 1
  fi
  echo "$target: $(grep -E '^Done' "$results/$target.$kind.log" || echo "done")"
}

run() {  # target
  local more=()
  stopped=
  fuzzer=
  trap 'stopped=1; [[ -z $fuzzer ]] || kill -TERM "$fuzzer" 2>/dev/null || true' TERM
  mkdir -p "$results/corpus/$1"
  for log in "$results/running/$1".*.log; do  # of runs that were killed
    [[ ! -e $log ]] || count "$1" "$(basename "$log" .log | sed 's/.*\.//')" "$log"
  done
  if [[ -n $runs ]]; then
    local left=$((runs - $(counted "$1")))
    ((left > 0)) || { echo "$1: has had $(counted "$1") executions"; return 0; }
    more=("-runs=$left")
  fi
  fuzz "$1" $kind -max_total_time="$seconds" "${more[@]}" || return 1
  [[ $kind == sanitized ]] || fuzz "$1" sanitized -runs=0
}

echo "== Fuzzing"
trap 'kill -TERM $(jobs -p) 2>/dev/null || true; wait; exit 1' INT TERM
status=0
running=0
for target in "${targets[@]}"; do
  if ((running == ${JOBS:-2})); then
    wait -n || status=1
    running=$((running - 1))
  fi
  run "$target" &
  running=$((running + 1))
done
for ((; running > 0; --running)); do
  wait -n || status=1
done
exit $status
