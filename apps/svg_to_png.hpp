// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynamic_icp::apps {

/// Whether this program was built with librsvg.
bool has_png();

/// Throws DataError when this program was built without librsvg, saying how to get it.
void require_png();

/// An SVG document as the bytes of a PNG file, `scale` pixels for each px of the picture. Throws DataError when it
/// cannot be drawn, or as `require_png` does.
std::string png_of_svg(const std::string& document, double scale);

}  // namespace dynamic_icp::apps
