// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/ground_view.hpp"

#include <algorithm>

namespace dynamic_icp::figures {

std::vector<GroundView> arrange_panels(const Region& region, std::size_t count, double width,
                                       const PanelSpacing& spacing) {
  constexpr double kLong = 1.6;  // longer than wide
  const double aspect = region.x.length() / region.y.length();
  const bool stacked = count < 2 || aspect > kLong;
  const double columns = stacked ? 1.0 : static_cast<double>(count);
  const double panel_width = (width - spacing.margin * (columns + 1.0)) / columns;
  const double min_height = stacked ? 190.0 : 300.0;
  const double max_height = stacked ? 420.0 : 620.0;
  const double panel_height = std::clamp(panel_width / aspect, min_height, max_height);
  Region shown = region;
  drawing::make_aspect_equal({0.0, 0.0, panel_width, panel_height}, shown.x, shown.y);
  std::vector<GroundView> panels;
  for (std::size_t k = 0; k < count; ++k) {
    const double row = stacked ? static_cast<double>(k) : 0.0;
    const double column = stacked ? 0.0 : static_cast<double>(k);
    const drawing::PixelBox box{spacing.margin + column * (panel_width + spacing.margin),
                                spacing.head + row * (panel_height + spacing.head), panel_width, panel_height};
    panels.push_back({box, shown});
  }
  return panels;
}

}  // namespace dynamic_icp::figures
