#!/usr/bin/env bash
# The tables of docs/results/accuracy.md: every simulated scene with three seeds, as instant and as swept scans, and some with a
# constant Doppler error of 0.2 m/s, through every method; ablations of both presets. Safe to stop and to run again: what
# is finished is kept. Needs the program at build/dynamic-icp.
# usage: scripts/benchmark_scenes.sh DIR [SCANS]   (5 GB for 40 scans a drive)
set -euo pipefail
program=$(cd "$(dirname "$0")/.." && pwd)/build/dynamic-icp
folder=$1
scans=${2:-40}
scenes=(street city highway tunnel curved-walls bridge traffic-jam roundabout parking off-road stationary)
sensor=(--set lidar.doppler_noise_mps=0.05 --set lidar.doppler_outlier_rate=0.005 --set lidar.dropout_rate=0.03)

for mode in instant swept biased; do
  options=(--calibration --quiet --frames "$scans" "${sensor[@]}")
  [[ $mode == swept ]] || options+=(--instant)
  [[ $mode == biased ]] && options+=(--set lidar.doppler_bias_mps=0.2)
  [[ $mode == biased ]] && scenes=(street city parking off-road stationary)
  for scene in "${scenes[@]}"; do
    for seed in 31 32 33; do
      drive=$folder/drives/$mode/$scene-$seed
      [[ -e $drive/scene.json ]] || "$program" simulate "$scene" --seed "$seed" "${options[@]}" --output "$drive"
    done
  done
  paper_parts=none
  [[ $mode == instant ]] && paper_parts=all
  default_parts=all
  [[ $mode == biased ]] && default_parts=no-bias
  "$program" benchmark "$folder/drives/$mode" --methods all --ablations $paper_parts --preset paper \
    --output "$folder/$mode"
  "$program" benchmark "$folder/drives/$mode" --methods dynamic-icp --ablations $default_parts --preset default \
    --output "$folder/$mode-default"
done
