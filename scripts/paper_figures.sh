#!/usr/bin/env bash
# Draws the counterparts of the paper's figures from simulated drives: the steps of the method on a pair of scans with
# object velocities found and true (steps.svg), and the trajectories of the methods against the ground truth
# (trajectory.svg, errors.svg), in the sizes of a paper of two columns or, with `screen`, for documents. Needs the program at
# build/dynamic-icp.
# usage: scripts/paper_figures.sh OUT [svg|png|pdf|both|all] [paper|screen]
set -euo pipefail
[[ $# -ge 1 ]] || { echo "usage: scripts/paper_figures.sh OUT [svg|png|pdf|both|all] [paper|screen]" >&2; exit 2; }
out=$(realpath -m "$1")
format=(--format "${2:-svg}" --scale 4)
[[ ${3:-paper} == screen ]] || format+=(--paper)
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

# A voxel grid finer than the paper's: the points it keeps show the objects.
echo "== Steps: a pair of scans in a street, preset paper"
build/dynamic-icp simulate street --instant --frames 40 --quiet --output "$work/street"
build/dynamic-icp run "$work/street" --preset paper --set preprocess.voxel.voxel_size_m=0.1 --save-labels --quiet \
  --output "$work/street-paper"
build/dynamic-icp plot "$work/street-paper" --pair 37 "${format[@]}" --output "$work/steps" >/dev/null
cp "$work"/steps/steps.* "$out/"

echo "== Trajectories: a traffic jam, where most of what is seen moves"
build/dynamic-icp simulate traffic-jam --frames 100 --quiet --output "$work/traffic-jam"
runs=()
for method in dynamic-icp doppler-icp gicp kiss-icp point-to-plane; do
  build/dynamic-icp run "$work/traffic-jam" --method "$method" --quiet --output "$work/traffic-jam-$method"
  runs+=("$work/traffic-jam-$method")
done
build/dynamic-icp plot "${runs[@]}" "${format[@]}" --output "$work/compared" >/dev/null
cp "$work"/compared/trajectory.* "$work"/compared/errors.* "$out/"
ls "$out"
