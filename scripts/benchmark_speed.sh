#!/usr/bin/env bash
# How fast it is: single steps beside the floor of the machine, whole scans of every simulated scene, growth with the
# points of a scan, memory of a long run, and others on the same scans where they are installed
# (scripts/install_dependencies.sh benchmarks peers). What the figures mean: docs/performance.md. Drives that are there
# are kept. Nothing else should run on the machine.
# usage: scripts/benchmark_speed.sh DIR [--quick] [--long]   (half an hour on two cores, 3 GB)
#   --quick   few scenes, scans and repetitions: to see that everything works
#   --long    also memory over 1,000 scans (some minutes more)
set -euo pipefail
start=$PWD
cd "$(dirname "$0")/.."
[[ $# -ge 1 && $1 != -* ]] || { echo "usage: scripts/benchmark_speed.sh DIR [--quick] [--long]" >&2; exit 2; }
folder=$(cd "$start" && mkdir -p "$1" && cd "$1" && pwd)
shift
scenes=(city street highway tunnel curved-walls bridge traffic-jam roundabout parking off-road stationary)
sizes=(10k:450x24 30k:800x40 70k:1200x64 200k:2000x110 500k:3450x160 1M:4950x226)
scans=40 size_scans=12 long_scans=1000 repeat=3 kernel_repetitions=5 kernel_seconds=0.1
long=no
for option in "$@"; do
  case $option in
    --quick)
      scenes=(city traffic-jam) sizes=(10k:450x24 30k:800x40 70k:1200x64)
      scans=8 size_scans=5 long_scans=60 repeat=1 kernel_repetitions=1 kernel_seconds=0.01 ;;
    --long) long=yes ;;
    *) echo "unknown option '$option'; known are: --quick, --long" >&2; exit 2 ;;
  esac
done
python=/usr/bin/python3  # Debian's, which has Debian's Open3D
skipped=()
sensor=(--set lidar.doppler_noise_mps=0.05 --set lidar.doppler_outlier_rate=0.005 --set lidar.dropout_rate=0.03)

build() {
  scripts/install_dependencies.sh benchmarks
  echo "== Building"
  local options=(-DDYNAMIC_ICP_BUILD_BENCHMARKS=ON)
  [[ -e build/CMakeCache.txt ]] || options+=(-DDYNAMIC_ICP_BUILD_TESTS=OFF)
  { cmake --preset release "${options[@]}" &&
    cmake --build build --target dynamic-icp dynamic-icp-speed dynamic-icp-kernels; } >"$folder/build-log.txt" 2>&1 ||
    { cat "$folder/build-log.txt"; exit 1; }
}

# A fixed work outside the project, if it lies beside it: ratios to it travel between machines.
build_reference() {
  reference=()
  local source=${REFERENCE_WORK:-../shared/tools/reference_work.cpp}
  if [[ -e $source ]]; then
    g++ -O2 "$source" -o "$folder/reference-work"
    reference=(--reference "$folder/reference-work")
  else
    skipped+=("reference work: $source is not there (name it by REFERENCE_WORK=FILE.cpp); no ratios")
  fi
}

simulate() {  # drive, scene, then options
  local drive=$folder/drives/$1 scene=$2
  shift 2
  [[ -e $drive/scene.json ]] ||
    build/dynamic-icp simulate "$scene" --seed 31 --quiet "${sensor[@]}" "$@" --output "$drive"
}

simulate_drives() {
  echo "== Simulating drives"
  scene_drives=() size_drives=()
  local scene size grid
  for scene in "${scenes[@]}"; do
    simulate "instant-$scans/instant/$scene-31" "$scene" --frames $scans --instant
    scene_drives+=("$folder/drives/instant-$scans/instant/$scene-31")
  done
  for scene in "${scenes[@]}"; do
    simulate "swept-$scans/swept/$scene-31" "$scene" --frames $scans
    scene_drives+=("$folder/drives/swept-$scans/swept/$scene-31")
  done
  for size in "${sizes[@]}"; do
    grid=${size#*:}
    simulate "sizes-$size_scans/city-${size%:*}" city --frames $size_scans --instant \
      --set "lidar.columns=${grid%x*}" --set "lidar.rows=${grid#*x}"
    size_drives+=("$folder/drives/sizes-$size_scans/city-${size%:*}")
  done
}

time_steps() {
  echo "== Single steps"
  # Others on one thread, like our own with threads:1.
  OMP_NUM_THREADS=1 build/dynamic-icp-kernels --benchmark_min_time=$kernel_seconds \
    --benchmark_repetitions=$kernel_repetitions --benchmark_enable_random_interleaving=true \
    --benchmark_out="$folder/kernels.json" --benchmark_out_format=json >"$folder/kernels.txt" 2>&1
  local peer
  for peer in nanoflann open3d pcl; do
    grep -q "^$peer" "$folder/kernels.txt" ||
      skipped+=("steps of $peer: not installed (scripts/install_dependencies.sh benchmarks peers)")
  done
}

time_scans() {
  echo "== Whole scans"
  build/dynamic-icp-speed "${scene_drives[@]}" --presets default,paper --threads 1,2 --repeat $repeat \
    "${reference[@]}" --output "$folder/scenes.json" 2>"$folder/scenes.log" | tee "$folder/scenes.txt"
  echo "== Scans of different sizes"
  build/dynamic-icp-speed "${size_drives[@]}" --presets default,paper --threads 1,2 --repeat $repeat --growth \
    --output "$folder/sizes.json" 2>"$folder/sizes.log" | tee "$folder/sizes.txt"
}

time_open3d() {
  echo "== Open3D on the same scans"
  rm -f "$folder/open3d.json"
  local status=0
  "$python" benchmarks/open3d_peer.py --threads 2 --repeat $repeat --output "$folder/open3d.json" \
    "${scene_drives[@]}" 2>"$folder/open3d.log" || status=$?
  [[ $status -ne 77 && $status -ne 127 ]] || { skipped+=("Open3D on whole scans: python3-open3d is not installed"); return; }
  [[ $status -eq 0 ]] || { cat "$folder/open3d.log"; exit 1; }
}

# Resident memory of `run` over a long drive, several times a second: seconds, MiB.
sample_memory() {  # preset
  local samples=$folder/memory-$1.txt kib began now
  build/dynamic-icp run "$folder/drives/long-$long_scans/highway" --preset "$1" --threads 2 --quiet --force \
    --output "$folder/long-$1" &
  local run=$!
  began=$(date +%s%N)
  echo "# seconds, MiB" >"$samples"
  while kib=$(awk '/^VmRSS/ {print $2}' "/proc/$run/status" 2>/dev/null) && [[ -n $kib ]]; do
    now=$(date +%s%N)
    echo "$(((now - began) / 1000000)) $kib" | awk '{printf "%.2f %.1f\n", $1 / 1000, $2 / 1024}' >>"$samples"
    sleep 0.2
  done
  wait $run
}

watch_memory() {
  echo "== Memory over $long_scans scans"
  simulate "long-$long_scans/highway" highway --frames $long_scans --set lidar.columns=740 --set lidar.rows=40
  local preset
  for preset in default paper; do
    sample_memory $preset
    echo "$preset (seconds, MiB; about ten of all samples):"
    awk '!/^#/ {row[n++] = $0} END {for (i = 0; i < 10; ++i) print "  " row[int(i * (n - 1) / 9)]}' "$folder/memory-$preset.txt"
  done
}

build
build_reference
simulate_drives
time_steps
time_scans
time_open3d
rm -f "$folder"/memory-*.txt
if [[ $long == yes ]]; then
  watch_memory
else
  skipped+=("memory of a long run: asked for with --long")
fi
echo
echo "== Summary"
"$python" benchmarks/summary.py "$folder" | tee "$folder/summary.txt"
if [[ ${#skipped[@]} -gt 0 ]]; then
  echo
  printf 'skipped: %s\n' "${skipped[@]}" | tee -a "$folder/summary.txt"
fi
