// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/figures/scan_view.hpp"

namespace dynamic_icp::figures {

/// A drawing area for a part of the ground plane, x to the right and y up, with equal scales.
struct GroundView {
  drawing::PixelBox box;
  Region region;

  [[nodiscard]] double pixels_per_metre() const { return box.width / region.x.length(); }
  [[nodiscard]] drawing::Pixel at(double x, double y) const {
    return {box.left + (x - region.x.minimum) * pixels_per_metre(),
            box.top + (region.y.maximum - y) * pixels_per_metre()};
  }
  [[nodiscard]] drawing::Pixel at(const Eigen::Vector3d& p) const { return at(p.x(), p.y()); }
};

/// Space around panels, px.
struct PanelSpacing {
  double margin = 20.0;  ///< left, right and between panels side by side
  double head = 44.0;    ///< above each panel
};

/// Lays out `count` panels of the same region in a picture of the given width: below each other when the region is
/// long, else side by side. The region grows where the panel would be too flat or too high.
std::vector<GroundView> arrange_panels(const Region& region, std::size_t count, double width,
                                       const PanelSpacing& spacing);

}  // namespace dynamic_icp::figures
