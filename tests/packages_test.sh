#!/usr/bin/env bash
# Makes the Debian packages of a build and unpacks them into a root of their own: everything lies where it belongs, and what
# lies there works. scripts/check_packages.sh installs them into a fresh Debian.
# usage: packages_test.sh BUILD_FOLDER TESTS_FOLDER CMAKE
set -euo pipefail
build=$1 tests=$2 cmake=$3
for program in dpkg-deb dpkg-shlibdeps file; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed (scripts/install_dependencies.sh packages)"; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

(cd "$build" && "$(dirname "$cmake")/cpack" -B "$folder" >"$folder/log" 2>&1) || { cat "$folder/log"; exit 1; }
declare -A deb
for file in "$folder"/*.deb; do
  deb[$(dpkg-deb -f "$file" Package)]=$file
done
[[ -n ${deb[dynamic-icp]} && -n ${deb[libdynamic-icp-dev]} ]]

if command -v lintian >/dev/null; then
  echo "== Debian's own checks"
  lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "${deb[@]}"
fi

echo "== No file outside its place, and no two packages with the same"
for package in "${!deb[@]}"; do
  dpkg-deb --fsys-tarfile "${deb[$package]}" | tar -t | grep -v '/$' >"$folder/$package.files"
  case $package in
    dynamic-icp) places='bin/dynamic-icp|share/(man/man1/dynamic-icp[a-z-]*\.1\.gz|bash-completion/completions/dynamic-icp|fish/vendor_completions\.d/dynamic-icp\.fish|zsh/vendor-completions/_dynamic-icp)' ;;
    libdynamic-icp-dev) places='include/dynamic_icp/[a-z0-9_/]+\.hpp|lib/libdynamic_icp_(core|io)\.a|lib/cmake/dynamic_icp/dynamic_icp-[a-z-]+\.cmake' ;;
    python3-dynamic-icp) places='lib/python3/dist-packages/dynamic_icp/.+' ;;
  esac
  if grep -vE "^\./usr/($places|share/doc/$package/(copyright|changelog(\.Debian)?\.gz))$" "$folder/$package.files"; then
    echo "$package has these files, which do not belong there" >&2
    exit 1
  fi
  dpkg-deb -x "${deb[$package]}" "$folder/root"
done
[[ -z $(sort "$folder"/*.files | uniq -d) ]]

echo "== The program and its manual"
program=$folder/root/usr/bin/dynamic-icp
"$program" --version
for command in $("$program" manual --list); do
  gzip -t "$folder/root/usr/share/man/man1/dynamic-icp-$command.1.gz"
done
"$program" simulate street --frames 2 --quiet --output "$folder/two"
"$program" run "$folder/two" --quiet --output "$folder/run"
[[ -s $folder/run/trajectory.tum ]]

echo "== The library"
# Links need every package that the dependencies name: headers and libraries of others come from them.
dpkg-deb -f "${deb[libdynamic-icp-dev]}" Depends | tr ',' '\n' | sed 's/(.*//; s/ //g' | xargs dpkg-query -W >/dev/null
"$cmake" -S "$tests/consumer" -B "$folder/consumer" -DCMAKE_PREFIX_PATH="$folder/root/usr" >"$folder/log" 2>&1 &&
  "$cmake" --build "$folder/consumer" >>"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
[[ $("$folder/consumer/consumer" "$folder/two" | wc -l) -eq 2 ]]
