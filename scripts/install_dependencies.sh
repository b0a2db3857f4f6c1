#!/usr/bin/env bash
# Installs the packages the build needs, if any is missing. For Debian 12, Ubuntu 22.04 and newer; as root or with sudo.
# usage: scripts/install_dependencies.sh [tests]
set -euo pipefail

packages=(g++ cmake ninja-build ccache libeigen3-dev libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libfmt-dev
  libpng-dev libembree-dev libzip-dev)
if [[ "${1:-}" == tests ]]; then
  packages+=(libgtest-dev python3-numpy python3-scipy)
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

if ! command -v apt-get >/dev/null; then
  echo "These packages are needed, and this system has no apt-get to install them: ${missing[*]}" >&2
  exit 1
fi
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "Run as root or install sudo: these packages are needed: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "== Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
