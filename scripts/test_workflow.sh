#!/usr/bin/env bash
# Whether a benchmark gives the same tables on many machines as on one: workflow/ with Snakemake on this machine, killed
# half-way and started again, and on a Slurm cluster of two nodes that this script starts on this machine, one of which is
# lost half-way. Prints what was done and how long it took. With `quiet-machine` the times of one and of two workers, too,
# which mean something when nothing else runs.
# usage: scripts/test_workflow.sh [PROGRAM] [quiet-machine]   (build/dynamic-icp)
# Needs snakemake, and for the second part slurmctld, slurmd and munge; says what is missing.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "${1:-$root/build/dynamic-icp}")
snakemake=$(command -v snakemake) || { echo "skipped: no snakemake (apt install snakemake)"; exit 0; }

work=$(mktemp -d)
stop_slurm() { :; }
trap 'stop_slurm; rm -rf "$work"' EXIT
say() { printf '%s\n' "$*"; }
fail() { say "FAILED: $*"; exit 1; }

methods="--methods dynamic-icp,kiss-icp,gicp"
frames=40
[[ ${2:-} == quiet-machine ]] && frames=200  # so that a cell takes longer than to start it
for drive in street:1 street:2 city:3 traffic-jam:4; do
  "$program" simulate "${drive%:*}" --seed "${drive#*:}" --frames $frames --instant --set lidar.columns=450 --quiet \
    --output "$work/data/${drive/:/-}"
done

start=$(date +%s)
"$program" benchmark "$work/data" $methods --threads 1 --quiet --output "$work/one" > "$work/one.log" 2>&1
say "one machine, one run at a time: $(grep -c '"folder"' "$work/one/results.json") cells in $(($(date +%s) - start)) s"

flow() {  # output options...
  "$snakemake" --snakefile "$root/workflow/Snakefile" --directory "$work" "${@:2}" \
    --config output="$1" inputs="$work/data" program="$program" arguments="$methods"
}

# Everything but the times; tables.md is all tables together.
compare_tables() {
  local table
  for table in "$work"/one/tables/*; do
    [[ $table == */runtime.* ]] || cmp "$table" "$1/tables/${table##*/}" || fail "$1: ${table##*/} differs"
  done
  say "$2: tables equal byte for byte, $(ls "$work/one/tables" | grep -vc runtime) files"
}
cells_done() { find "$1" -name cell.json 2>/dev/null | wc -l; }
wait_for_cells() {  # folder number process
  while (($(cells_done "$1") < $2)); do
    kill -0 "$3" 2>/dev/null || fail "$1: ended before $2 cells were done"
    sleep 0.2
  done
}

# --- This machine, killed half-way -----------------------------------------------------------------------------------
local_profile=$root/workflow/profiles/local
export -f flow
export snakemake root work program methods
setsid --wait bash -c "flow '$work/local' --profile '$local_profile' --cores 2" > "$work/killed.log" 2>&1 &
wait_for_cells "$work/local" 4 $!
session=$(ps -o sid= -p "$(pgrep -f -o "$work/local")" | tr -d ' ')
pkill -9 -s "$session" || true
wait || true
before=$(cells_done "$work/local")
flow "$work/local" --profile "$local_profile" --cores 2 > "$work/local.log" 2>&1 || fail "$(tail -20 "$work/local.log")"
say "killed (SIGKILL) with $before cells done; the second start ran $(grep -c '^rule cell' "$work/local.log") of 12"
compare_tables "$work/local" "two at a time on this machine, killed and started again"

if [[ ${2:-} == quiet-machine ]]; then
  # A processor is slower while the other one works, too. On equal processors: one worker, beside another benchmark of one.
  for round in 1 2 3; do
    start=$(date +%s.%N)
    flow "$work/beside-$round" --profile "$local_profile" --cores 1 --directory "$work/beside" > "$work/beside.log" 2>&1 &
    flow "$work/one-$round" --profile "$local_profile" --cores 1 > "$work/speed.log" 2>&1
    one=$(echo "$(date +%s.%N) - $start" | bc)
    wait
    start=$(date +%s.%N)
    flow "$work/two-$round" --profile "$local_profile" --cores 2 > "$work/speed.log" 2>&1
    say "one worker beside another benchmark: $one s, two workers: $(echo "$(date +%s.%N) - $start" | bc) s"
  done
fi

# --- Slurm, one node lost half-way -----------------------------------------------------------------------------------
for needed in munged slurmctld slurmd sbatch; do
  command -v $needed > /dev/null || PATH=$PATH:/usr/sbin command -v $needed > /dev/null ||
    { say "skipped: no $needed (apt install slurm-wlm munge)"; exit 0; }
done
PATH=$PATH:/usr/sbin
mkdir -m 755 "$work/munge"
mkdir "$work/slurm"
chmod 755 "$work"
(umask 077 && head -c 1024 /dev/urandom > "$work/munge/key")
munged --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" || fail "munged does not start"
host=$(hostname -s)
memory=$(awk '/MemTotal/ { print int($2 / 1024 * 0.9) }' /proc/meminfo)
cat > "$work/slurm/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
SlurmctldPort=16817
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd-%n.pid
SlurmdSpoolDir=$work/slurm/spool-%n
StateSaveLocation=$work/slurm/state
SlurmctldLogFile=$work/slurm/slurmctld.log
SlurmdLogFile=$work/slurm/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdTimeout=10
NodeName=node[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[16818-16819] CPUs=1 RealMemory=$memory State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
mkdir "$work/slurm/state"
export SLURM_CONF=$work/slurm/slurm.conf
stop_slurm() {
  scontrol shutdown > /dev/null 2>&1 || true
  sleep 1
  kill "$(cat "$work/munge/pid")" 2>/dev/null || true
}
slurmctld || fail "slurmctld does not start: $(tail -3 "$work/slurm/slurmctld.log")"
for node in node1 node2; do
  slurmd -N $node || fail "slurmd does not start: $(tail -3 "$work/slurm/slurmd-$node.log")"
done
for _ in $(seq 50); do
  [[ $(sinfo --noheader --format=%D --states=idle) == 2 ]] && break
  sleep 0.2
done
[[ $(sinfo --noheader --format=%D --states=idle) == 2 ]] || fail "the nodes are not there: $(sinfo)"

# What a power cut does: the daemon of the node, those that watch over its jobs, and the jobs are gone at once.
lose_node() {
  local job process
  kill -9 "$(cat "$work/slurm/slurmd-$1.pid")"
  for job in $(squeue --noheader --nodelist="$1" --format=%A); do
    pkill -9 -f "^slurmstepd: \[$job\." || true
  done
  for process in $(grep -lsz "^SLURMD_NODENAME=$1\$" /proc/[0-9]*/environ | cut -d/ -f3); do
    kill -9 "$process" 2>/dev/null || true
  done
}

flow "$work/cluster" --profile "$root/workflow/profiles/slurm" --latency-wait 10 > "$work/cluster.log" 2>&1 &
wait_for_cells "$work/cluster" 4 $!
running_there=$(squeue --noheader --nodelist=node2 --states=running --format=%A | wc -l)
lose_node node2
say "Slurm: node2 lost with $(cells_done "$work/cluster") cells done and $running_there running on it"
wait $! || fail "$(tail -20 "$work/cluster.log")"
say "Slurm: $(sinfo --noheader --nodes=node2 --format='node2 is %T'), $(grep -c 'Trying to restart' "$work/cluster.log") jobs sent again"
compare_tables "$work/cluster" "two nodes of Slurm, one lost half-way"
