#!/usr/bin/env bash
# Installs the packages the build needs, if any is missing. For Debian 12, Ubuntu 22.04 and newer; as root or with sudo.
# usage: scripts/install_dependencies.sh [clang] [tests] [pictures] [benchmarks [peers]] [fuzzing] [format] [lint] [packages]
#                                         [python] [site]
#   clang        builds in two thirds of the time of g++, if the distribution has it
#   pictures     for PNG files from dynamic-icp plot (60 MB)
#   python       for the Python package and its tests
#   site         for scripts/site.sh, the documentation as a site
#   benchmarks   for scripts/benchmark_speed.sh; peers: also the libraries it compares with (1.2 GB)
set -euo pipefail

optional=()
packages=(g++ cmake ninja-build ccache libeigen3-dev libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libfmt-dev
  libpng-dev libembree-dev libzip-dev liblzf-dev zlib1g-dev
  libsqlite3-dev libzstd-dev liblz4-dev libbz2-dev libboost-dev)
for purpose in "$@"; do
  case $purpose in
    clang)
      optional+=(clang) ;;
    tests)
      packages+=(libgtest-dev)
      # Independent implementations to compare with, random tests, and browsers for the viewer of reports; not in every
      # release.
      optional+=(python3-open3d python3-rosbag librapidcheck-dev chromium firefox-esr) ;;
    pictures)
      packages+=(librsvg2-dev pkg-config) ;;
    benchmarks)
      packages+=(libbenchmark-dev)
      optional+=(libnanoflann-dev) ;;
    peers)
      optional+=(pkg-config libopen3d-dev libpcl-dev python3-open3d) ;;
    fuzzing)
      packages+=(clang) ;;
    format)
      packages+=(clang-format) ;;
    lint)
      packages+=(clang-tidy python3-numpy python3-scipy) ;;
    packages)
      packages+=(dpkg-dev file pybind11-dev python3-dev python3-numpy)
      optional+=(lintian) ;;
    python)
      packages+=(pybind11-dev python3-dev python3-numpy python3-pytest)
      # For pip install and for those tests that compare or need more; without one they skip themselves.
      optional+=(python3-scipy python3-matplotlib python3-pandas python3-hypothesis mypy python3-skbuild python3-pip) ;;
    site)
      packages+=(mkdocs mkdocs-material doxygen)
      optional+=(libjs-katex fonts-katex) ;;  # formulas
    *)
      echo "unknown purpose '$purpose'; known are: clang, tests, pictures, benchmarks, peers, fuzzing, format, lint, packages, python, site" >&2
      exit 2 ;;
  esac
done

is_installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'install ok installed'; }
is_known() { apt-cache show "$1" >/dev/null 2>&1; }

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
wanted=()
for package in "${optional[@]}"; do
  is_installed "$package" || wanted+=("$package")
done
if [[ ${#missing[@]} -eq 0 && ${#wanted[@]} -eq 0 ]]; then
  exit 0
fi

if ! command -v apt-get >/dev/null; then
  [[ ${#missing[@]} -eq 0 ]] && exit 0
  echo "These packages are needed, and this system has no apt-get to install them: ${missing[*]}" >&2
  exit 1
fi
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || {
    [[ ${#missing[@]} -eq 0 ]] && exit 0
    echo "Run as root or install sudo: these packages are needed: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
for package in "${wanted[@]}"; do
  if is_known "$package"; then
    missing+=("$package")
  fi
done
if [[ ${#missing[@]} -gt 0 ]]; then
  echo "== Installing ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
