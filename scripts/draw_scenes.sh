#!/usr/bin/env bash
# Draws the pictures of docs/scenes/ again: every scene from above and as the default sensor sees it. Needs the program
# at build/dynamic-icp.
set -euo pipefail
cd "$(dirname "$0")/.."

drives=$(mktemp -d)
trap 'rm -rf "$drives"' EXIT
mkdir -p docs/scenes
for scene in street city highway tunnel curved-walls bridge traffic-jam roundabout freight parking off-road stationary; do
  build/dynamic-icp simulate "$scene" --quiet --output "$drives/$scene"
  cp "$drives/$scene/overview.svg" "docs/scenes/$scene.svg"
done
