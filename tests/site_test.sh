#!/usr/bin/env bash
# The site of the documentation can be built, no link in it is dead, and it loads nothing from a network.
# usage: site_test.sh SOURCES
set -euo pipefail
for program in mkdocs doxygen; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed (scripts/install_dependencies.sh site)"; exit 77; }
done
[[ -d /usr/share/mkdocs/themes/material ]] || { echo "skipped: mkdocs-material is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$1/scripts/site.sh" "$folder/site"
for page in index start your-data concepts faq outputs tuning python cpp api/index simulator benchmarks security many-machines contributing; do
  [[ -s $folder/site/$page.html ]]
done

echo "== What is wrong is found"
check() { ! /usr/bin/python3 "$1/docs/site/check_links.py" "$folder/site" >"$folder/log" 2>&1 && grep -q "$2" "$folder/log"; }
cp "$folder/site/faq.html" "$folder/faq.html"
spoil() {  # text that a page must not have, what is said of it
  { cat "$folder/faq.html"; echo "$1"; } >"$folder/site/faq.html"
  check "$source" "faq.html: $2"
}
source=$1
spoil '<a href="no-such-page.html">x</a>' 'no-such-page.html: no such file'
spoil '<a href="start.html#no-such-place">x</a>' 'start.html#no-such-place: no such place'
spoil '<script src="https://example.org/x.js"></script>' 'loads https://example.org/x.js'
