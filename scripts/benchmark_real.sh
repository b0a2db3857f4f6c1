#!/usr/bin/env bash
# The tables of docs/results/real-sensors.md: simulated drives of seeds that were not used while developing, swept, with
# the errors of real sensors, through every method at its best published settings. Modes:
#   real        every scene with sensor aeries-ii-real: all sourced errors at their sizes, the vehicle vibrates
#   ideal       the same drives with aeries-ii, which has white noise alone
#   one-error   one scene with aeries-ii and one error at a time
# Safe to stop and to run again: what is finished is kept. Needs the program at build/dynamic-icp.
# usage: scripts/benchmark_real.sh MODE DIR [SCANS] [SEEDS] [SCENES]   (lists in quotes; 40, "41 42 43", all; city)
set -euo pipefail
program=$(cd "$(dirname "$0")/.." && pwd)/build/dynamic-icp
mode=$1
folder=$2
scans=${3:-40}
seeds=${4:-41 42 43}
scenes=${5:-street city highway tunnel curved-walls bridge traffic-jam roundabout parking off-road stationary}

simulate() {  # drive scene seed options...
  local drive=$folder/drives/$1
  [[ -e $drive/scene.json ]] || "$program" simulate "$2" --seed "$3" "${@:4}" --calibration --quiet --frames "$scans" \
    --output "$drive"
}

# All methods over the drives of a folder. Those from scan to scan start from the last motion and deskew by it, as
# KISS-ICP does; a gate of 2 m holds at 27 m/s. Doppler-ICP and preset `paper` keep their published gate of 0.3 m.
compare() {
  local moving=(--set icp.constant_velocity_start=true --set icp.deskew=true)
  "$program" benchmark "$folder/drives/$1" --methods point-to-point,point-to-plane,gicp,kiss-icp "${moving[@]}" \
    --set registration.max_correspondence_distance_m=2 --set kiss_icp.deskew=true --output "$folder/$1-geometry"
  "$program" benchmark "$folder/drives/$1" --methods doppler-icp "${moving[@]}" --output "$folder/$1-doppler"
  for preset in paper default; do
    "$program" benchmark "$folder/drives/$1" --methods dynamic-icp --ablations none --preset $preset \
      --output "$folder/$1-$preset"
  done
}

declare -A error=(
  [none]=""
  [direction]="lidar.doppler_error.direction_mps=0.15"
  [beams]="lidar.beams=4 lidar.doppler_error.beam_mps=0.1"
  [faces]="lidar.faces=6 lidar.face_per_scan=true lidar.doppler_error.face_mps=0.1"
  [range]="lidar.doppler_error.range_mps_per_100m=0.1"
  [restart]="lidar.doppler_error.restart_s=$((scans / 20)).$((scans / 2 % 10)) lidar.doppler_error.restart_mps=0.2"
  [pointing]="lidar.faces=6 lidar.face_per_scan=true lidar.pointing_error.face_deg=0.05"
  [lines]="lidar.pointing_error.line_deg=0.05"
  [stamps]="lidar.timing.stamp_jitter_s=0.001"
  [scale]="lidar.doppler_error.scale=0.002"
  [noise]="lidar.doppler_noise_mps=0.2"
  [missing]="lidar.timing.missing_scan_rate=0.2"
  [vibration]="vibration.wheel.low_hz=7 vibration.wheel.high_hz=13 vibration.wheel.amplitude_mm=1.5 vibration.wheel.amplitude_deg=0.03"
)

case $mode in
  real | ideal)
    sensor=aeries-ii
    [[ $mode == ideal ]] || sensor=aeries-ii-real
    for seed in $seeds; do
      for scene in $scenes; do
        simulate "$mode/$scene-$seed" "$scene" "$seed" --sensor "$sensor"
      done
    done
    compare "$mode"
    ;;
  one-error)
    for scene in ${5:-city}; do
      for seed in $seeds; do
        for name in "${!error[@]}"; do
          options=()
          for setting in ${error[$name]}; do options+=(--set "$setting"); done
          simulate "one-error-$scene/$name-$seed" "$scene" "$seed" "${options[@]}"
        done
      done
      compare "one-error-$scene"
    done
    ;;
  *)
    echo "$mode: expected real, ideal or one-error" >&2
    exit 2
    ;;
esac
