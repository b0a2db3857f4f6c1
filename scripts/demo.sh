#!/usr/bin/env bash
# From nothing to a result: installs what is missing, builds, simulates a short FMCW LiDAR drive with exact ground truth,
# runs Dynamic-ICP on it and prints how far off it is. Safe to run again; fast when nothing changed.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh

drive=build/demo/street
run=build/demo/run
if [[ ! -e $drive/scene.json || build/dynamic-icp -nt $drive/scene.json ]]; then
  echo "== Simulating a street with moving cars, 60 scans that sweep"
  build/dynamic-icp simulate street --frames 60 --output "$drive" --force
fi

echo "== Running Dynamic-ICP on it"
build/dynamic-icp run "$drive" --output "$run" --save-labels --report --force
