#!/usr/bin/env bash
# Makes the site of the documentation, with the C++ reference, and checks every link in it. Needs no network, and the site
# needs none: open OUTPUT/index.html. (The search box needs a server: python3 -m http.server -d OUTPUT)
# usage: scripts/site.sh [OUTPUT]     default: build/site; replaced when it is a site
set -euo pipefail
cd "$(dirname "$0")/.."
output=$(realpath -m "${1:-build/site}")
if [[ -e $output && ! -e $output/site.css ]] && [[ -n $(ls -A "$output") ]]; then
  echo "$output is there and is no site: nothing is written" >&2
  exit 2
fi

scripts/install_dependencies.sh site
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

/usr/bin/python3 docs/site/collect.py . "$work"

echo "== C++ reference"
/usr/bin/python3 docs/site/reference.py . "$work/headers.txt" "$work/pages/api"

echo "== Pages"
(cd "$work" && mkdocs build --quiet --strict --config-file mkdocs.yml --site-dir "$work/site")

/usr/bin/python3 docs/site/check_links.py "$work/site"
rm -rf "$output"
mkdir -p "$(dirname "$output")"
mv "$work/site" "$output"
echo "$output/index.html"
