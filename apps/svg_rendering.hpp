// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynamic_icp::apps {

/// Whether this program was built with librsvg, which makes PNG and PDF files.
bool renders_svg();

/// An SVG document as the bytes of a PNG file, `scale` pixels for each px of the picture. Throws DataError when it
/// cannot be drawn, or when this program was built without librsvg, saying how to get it.
std::string png_of_svg(const std::string& document, double scale);

/// The same as a PDF file of one page, 0.75 pt for each px; lines and letters stay what they are. Equal documents give
/// equal bytes.
std::string pdf_of_svg(const std::string& document);

}  // namespace dynamic_icp::apps
