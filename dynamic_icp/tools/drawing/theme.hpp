// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/tools/drawing/colour_map.hpp"

namespace dynamic_icp::drawing {

/// Every colour a picture uses, as CSS takes them. The drawing functions know no other colours, so one function draws
/// for paper and for a dark background.
struct Theme {
  std::string background;  ///< behind the whole picture
  std::string panel;       ///< behind a drawing area
  std::string ink;         ///< titles, labels, the sensor
  std::string muted;       ///< tick labels, less important text
  std::string grid;
  std::string truth;                 ///< the ground truth, which no series has the colour of
  std::vector<std::string> series;   ///< lines and objects, in the order of use
  std::vector<std::string> doppler;  ///< bins from -limit to +limit; an odd number
};

/// Colours for pictures that stand alone.
Theme theme(Ground ground);

}  // namespace dynamic_icp::drawing
