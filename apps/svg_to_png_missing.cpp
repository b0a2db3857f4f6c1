// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Stands in for svg_to_png.cpp where librsvg is not installed.
#include "dynamic_icp/method/base/error.hpp"

#include "apps/svg_to_png.hpp"

namespace dynamic_icp::apps {

bool has_png() { return false; }

void require_png() {
  throw DataError(
      "this program was built without librsvg, which makes PNG files: run 'scripts/install_dependencies.sh pictures' "
      "in the folder of the sources, then configure and build again");
}

std::string png_of_svg(const std::string& /*document*/, double /*scale*/) {
  require_png();
  return {};
}

}  // namespace dynamic_icp::apps
