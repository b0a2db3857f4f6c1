// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Stands in for svg_rendering.cpp where librsvg is not installed.
#include "dynamic_icp/method/base/error.hpp"

#include "apps/svg_rendering.hpp"

namespace dynamic_icp::apps {

namespace {

[[noreturn]] void tell_missing() {
  throw DataError(
      "this program was built without librsvg, which makes PNG and PDF files: run 'scripts/install_dependencies.sh "
      "pictures' in the folder of the sources, then configure and build again");
}

}  // namespace

bool renders_svg() { return false; }

std::string png_of_svg(const std::string& /*document*/, double /*scale*/) { tell_missing(); }

std::string pdf_of_svg(const std::string& /*document*/) { tell_missing(); }

}  // namespace dynamic_icp::apps
