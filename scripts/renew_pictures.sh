#!/usr/bin/env bash
# Draws the pictures of README and documents again: docs/scenes/, street.svg, steps.svg, trajectories.svg and, where
# chromium and the viewer's packages are there, report.png. Needs the program at build/dynamic-icp, and an idle machine: the
# page shows the time per scan. Takes minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

echo "== Scenes"
scripts/draw_scenes.sh

echo "== Figures of the paper"
scripts/paper_figures.sh "$work/paper" svg screen >/dev/null
cp "$work/paper/steps.svg" docs/steps.svg
cp "$work/paper/trajectory.svg" docs/trajectories.svg

echo "== A scan of a street"
build/dynamic-icp simulate street --quiet --output "$work/street"
build/dynamic-icp run "$work/street" --save-labels --quiet --output "$work/street-run"
build/dynamic-icp plot "$work/street-run" --output "$work/street-plots" >/dev/null
cp "$work/street-plots/scan.svg" docs/street.svg

echo "== The page of a run"
if [[ ! -d viewer/node_modules/playwright-core ]] || ! command -v chromium >/dev/null; then
  echo "docs/report.png is left as it is: run scripts/install_viewer.sh tests, and install chromium" >&2
  exit 0
fi
build/dynamic-icp simulate city --frames 60 --quiet --output "$work/city"
build/dynamic-icp run "$work/city" --quiet --report --output "$work/city-run"
node viewer/test/take_picture.mjs "$work/city-run/report.html" docs/report.png 'frame=30&theme=light' 1280 800
