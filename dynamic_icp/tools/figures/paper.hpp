// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::figures {

/// What a picture is drawn for.
enum class Medium {
  kScreen,  ///< px of the screen, with titles
  kPaper,   ///< the columns of a paper: letters of 7 to 9 pt, no titles, which captions give
};

/// px of the drawing a mm on paper: letters of 12 to 15 px, which all pictures have, are 7.2 to 9 pt high.
constexpr double kPaperPxPerMm = 12.0 / (7.2 * 25.4 / 72.0);

// px of the drawing; papers of two columns, as IEEE's: 88 mm for one of them, 181 mm for both.
constexpr double kColumnWidth = 88.0 * kPaperPxPerMm;
constexpr double kTextWidth = 181.0 * kPaperPxPerMm;

}  // namespace dynamic_icp::figures
