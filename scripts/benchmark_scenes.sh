#!/usr/bin/env bash
# The tables of docs/benchmarks.md: every simulated scene with three seeds, instant and swept scans, through every method
# and ablation. Safe to stop and to run again: what is finished is kept. Needs the program at build/dynamic-icp.
# usage: scripts/benchmark_scenes.sh DIR [SCANS]   (3 GB for 30 scans a drive)
set -euo pipefail
program=$(cd "$(dirname "$0")/.." && pwd)/build/dynamic-icp
folder=$1
scans=${2:-30}

for mode in instant swept; do
  options=(--calibration --quiet --frames "$scans")
  [[ $mode == instant ]] && options+=(--instant)
  for scene in street city highway tunnel curved-walls bridge jam roundabout car-park off-road standing; do
    for seed in 1 2 3; do
      drive=$folder/drives/$mode/$scene-$seed
      [[ -e $drive/scene.json ]] || "$program" simulate "$scene" --seed "$seed" "${options[@]}" --output "$drive"
    done
  done
  "$program" benchmark "$folder/drives/$mode" --methods all --ablations all --preset paper --output "$folder/$mode"
  "$program" benchmark "$folder/drives/$mode" --methods dynamic-icp --ablations none --output "$folder/$mode-default"
done
