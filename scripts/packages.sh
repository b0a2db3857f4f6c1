#!/usr/bin/env bash
# Makes the Debian packages and the archive of the sources in build/packages. Installs what is missing.
# usage: scripts/packages.sh
set -euo pipefail
cd "$(dirname "$0")/.."
# A container may have .git without git, or a .git that points to a folder outside.
is_clone() { [[ -e .git ]] && git rev-parse --verify --quiet HEAD >/dev/null 2>&1; }

scripts/install_dependencies.sh pictures packages
scripts/build.sh -DDYNAMIC_ICP_BUILD_PYTHON=ON all
if is_clone; then
  export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
fi

folder=build/packages
rm -rf "$folder"
(cd build && cpack >/dev/null)
rm -rf "$folder/_CPack_Packages"

if is_clone; then
  # What is committed, and the viewer of reports, which is bundled with packages from the network.
  name=dynamic-icp-$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' build/CMakeCache.txt)
  bundle=(build/dynamic_icp/tools/report/viewer_bundle.cpp)
  [[ -e ${bundle[0]} ]] && bundle=("--prefix=$name/viewer/" "--add-file=${bundle[0]}") || bundle=()
  git archive "${bundle[@]}" --prefix="$name/" HEAD | gzip -9n >"$folder/$name.tar.gz"
fi
if command -v lintian >/dev/null; then
  # The tag asks for a wish in Debian's own list of bugs.
  lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$folder"/*.deb
fi
ls -l "$folder"
