#!/usr/bin/env bash
# Installs the packages of scripts/packages.sh into a fresh Debian 12 of its own and uses them there: demo, Python where that is
# packaged, and a project that links the library. Then builds the archive of the sources there, without network. Needs root,
# debootstrap and Debian's servers.
# usage: scripts/check_packages.sh [installed] [sources]     default: both
set -euo pipefail
cd "$(dirname "$0")/.."
parts=("$@")
[[ $# -eq 0 ]] && parts=(installed sources)
mirror=http://deb.debian.org/debian

command -v debootstrap >/dev/null || { echo "needs debootstrap (apt-get install debootstrap)" >&2; exit 1; }
root=$(mktemp -d)
trap 'rm -rf "$root" "$root.log"' EXIT
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || { cat "$root.log"; exit 1; }
rm -f "$root.log"
install -D -t "$root/packages" build/packages/*
inside() { unshare --mount --pid --fork --mount-proc="$root/proc" chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root bash -euc "$1"; }

installed() {
  echo "== Installing, and a drive from nothing to its errors"
  local begin=$SECONDS
  inside 'apt-get install -y -qq --no-install-recommends /packages/dynamic-icp_*.deb $(ls /packages/python3-*.deb 2>/dev/null) >/dev/null 2>&1
    ! command -v cc
    dynamic-icp --version
    cd /tmp
    dynamic-icp simulate street --frames 20 --quiet --output drive
    dynamic-icp run drive --output run --report
    ! ls /packages/python3-*.deb 2>/dev/null || python3 -c "import dynamic_icp; print(dynamic_icp.__file__, len(dynamic_icp.open(\"drive\")))"'
  echo "took $((SECONDS - begin)) s"

  echo "== A project that links the library"
  cp -r tests/consumer "$root/tmp/consumer"
  inside 'apt-get install -y -qq --no-install-recommends /packages/libdynamic-icp-dev_*.deb g++ cmake make >/dev/null 2>&1
    cmake -S /tmp/consumer -B /tmp/consumer-build >/dev/null
    cmake --build /tmp/consumer-build >/dev/null
    /tmp/consumer-build/consumer /tmp/drive | tail -2'
}

sources() {
  echo "== The archive of the sources, without network"
  cp scripts/install_dependencies.sh "$root/tmp"
  inside '/tmp/install_dependencies.sh; cd /tmp; tar -xf /packages/dynamic-icp-*.tar.gz'
  unshare --net chroot "$root" bash -euc 'cd /tmp/dynamic-icp-*
    cmake --preset release -DDYNAMIC_ICP_BUILD_TESTS=OFF >/dev/null
    cmake --build build
    build/dynamic-icp --version'
}

for part in "${parts[@]}"; do
  case $part in
    installed | sources) "$part" ;;
    *)
      echo "unknown part '$part'; known are: installed, sources" >&2
      exit 2 ;;
  esac
done
