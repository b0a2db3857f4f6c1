// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/drawing/colour_map.hpp"

namespace dynamic_icp::drawing {

/// Every colour a picture uses, as CSS takes them. The drawing functions know no other colours, so one function draws
/// for paper, for a dark background and for a page that follows its reader's preference.
struct Theme {
  std::string background;  ///< behind the whole picture
  std::string panel;       ///< behind a drawing area
  std::string ink;         ///< titles, labels, the sensor
  std::string muted;       ///< tick labels, less important text
  std::string grid;
  std::vector<std::string> series;   ///< lines and objects, in the order of use
  std::vector<std::string> doppler;  ///< bins from -limit to +limit; an odd number
};

/// Colours for pictures that stand alone.
Theme theme(Ground ground);

/// Colours that are CSS variables ("var(--ink)"), for pictures inside of a page that defines them by `css_variables`.
Theme page_theme();

/// The definitions "--ink:#1b2430;..." of the variables of `page_theme`, with the colours for a background.
std::string css_variables(Ground ground);

}  // namespace dynamic_icp::drawing
