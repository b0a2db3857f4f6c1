#!/usr/bin/env bash
# Installs what the viewer of report pages is bundled with: node and npm from the distribution when they are missing, and
# the packages of viewer/package-lock.json. Does nothing when they are up to date. Never stops what calls it: without the
# viewer everything else works, and it says so.
# usage: scripts/install_viewer.sh [tests]     tests: also what the tests of the viewer need
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

is_up_to_date() {
  # npm leaves its own list of what it put there; it is written last. Packages for tests are more than those without.
  [[ $installed -nt viewer/package-lock.json && ( $purpose != tests || -d viewer/node_modules/playwright-core ) ]]
}

purpose=${1:-}
installed=viewer/node_modules/.package-lock.json
options=(--omit=dev)
[[ $purpose == tests ]] && options=()
is_up_to_date && exit 0

install_node || give_up "node and npm could not be installed"
command -v node >/dev/null && command -v npm >/dev/null || give_up "node or npm is not installed"
[[ $(node -p 'Number(process.versions.node.split(".")[0])') -ge 18 ]] || give_up "node $(node --version) is older than 18"
echo "== Installing the viewer's packages"
npm ci --prefix viewer --no-audit --no-fund --loglevel=error "${options[@]}" >/dev/null || give_up "npm ci failed"
touch "$installed"
