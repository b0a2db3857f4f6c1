#!/usr/bin/env bash
# Compares two builds of the program: the same trajectories and objects, to the last bit, for all scenes as instant and
# as swept scans, both presets and all baselines, with one thread and with two. For changes that must not change results.
# usage: scripts/compare_programs.sh BEFORE AFTER DIR [RECORDING...]   drives and runs are written to DIR, drives are
#        kept for the next time; RECORDING: real ones to compare on as well. Status 1 where something differs.
set -euo pipefail
before=$1 after=$2 folder=$3
shift 3
scenes=(street city highway tunnel curved-walls bridge jam roundabout car-park off-road standing)
sensor=(--frames 12 --seed 5 --set lidar.columns=300 --set lidar.rows=32 --calibration --quiet)
recordings=("$@")
for scene in "${scenes[@]}"; do
  for mode in instant swept; do
    drive=$folder/drives/$scene-$mode
    options=("${sensor[@]}")
    [[ $mode == instant ]] && options+=(--instant)
    [[ -e $drive/scene.json ]] || "$before" simulate "$scene" "${options[@]}" --output "$drive"
    recordings+=("$drive")
  done
done

run() {  # program, threads, recording, method, preset: a checksum of what it finds
  rm -rf "$folder/run"
  "$1" run "$3" --output "$folder/run" --method "$4" --preset "$5" --threads "$2" --quiet >/dev/null 2>&1 || true
  cat "$folder"/run/trajectory.tum "$folder"/run/objects.jsonl 2>/dev/null | md5sum
}

differing=0
compared=0
for recording in "${recordings[@]}"; do
  for pipeline in "dynamic-icp default" "dynamic-icp paper" "doppler-icp default" "point-to-point default" \
    "point-to-plane default" "gicp default" "kiss-icp default"; do
    read -r method preset <<<"$pipeline"
    expected=$(run "$before" 2 "$recording" "$method" "$preset")
    for threads in 1 2; do
      compared=$((compared + 1))
      if [[ $(run "$after" "$threads" "$recording" "$method" "$preset") != "$expected" ]]; then
        echo "different: $recording, $pipeline, $threads threads"
        differing=$((differing + 1))
      fi
    done
  done
done
echo "$compared runs compared, $differing differ"
[[ $differing -eq 0 ]]
