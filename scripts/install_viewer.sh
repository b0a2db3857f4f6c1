#!/usr/bin/env bash
# Installs what the viewer of report pages is bundled with: node and npm from the distribution when they are missing, and
# the packages of viewer/package-lock.json. Does nothing when they are up to date. Never stops what calls it: without the
# viewer everything else works, and it says so.
# usage: scripts/install_viewer.sh [tests]     tests: also what the tests of the viewer need, and those of tests/interop
set -uo pipefail
cd "$(dirname "$0")/.."

give_up() {
  echo "The viewer cannot be bundled: $1. Reports will have no interactive view; everything else works." >&2
  exit 0
}

install_node() {
  command -v node >/dev/null && command -v npm >/dev/null && return
  command -v apt-get >/dev/null || return
  local as_root=() packages=()
  [[ $(id -u) -eq 0 ]] || as_root=(sudo)
  command -v node >/dev/null || packages+=(nodejs)
  command -v npm >/dev/null || packages+=(npm)
  echo "== Installing ${packages[*]}"
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null
}

is_up_to_date() {  # folder, and a package that only tests need
  # npm leaves its own list of what it put there; it is written last. Packages for tests are more than those without.
  [[ $1/node_modules/.package-lock.json -nt $1/package-lock.json && ( $purpose != tests || -d $1/node_modules/$2 ) ]]
}

install_packages() {  # folder
  echo "== Installing the packages of $1"
  npm ci --prefix "$1" --no-audit --no-fund --loglevel=error "${options[@]}" >/dev/null || give_up "npm ci failed in $1"
  touch "$1/node_modules/.package-lock.json"
}

purpose=${1:-}
folders=(viewer:playwright-core)
options=(--omit=dev)
[[ $purpose == tests ]] && options=() && folders+=(tests/interop:@mcap/core)
for entry in "${folders[@]}"; do
  folder=${entry%%:*}
  is_up_to_date "$folder" "${entry#*:}" && continue
  install_node || give_up "node and npm could not be installed"
  command -v node >/dev/null && command -v npm >/dev/null || give_up "node or npm is not installed"
  [[ $(node -p 'Number(process.versions.node.split(".")[0])') -ge 18 ]] || give_up "node $(node --version) is older than 18"
  install_packages "$folder"
done
