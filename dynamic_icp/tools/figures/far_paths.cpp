// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/far_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::figures {
namespace {

using drawing::Pixel;
using drawing::PixelBox;
using Path = std::vector<Eigen::Vector3d>;

constexpr double kShrinking = 1.5;

drawing::Range united(const drawing::Range& a, const drawing::Range& b) {
  return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
}

MapRegion united(const MapRegion& a, const MapRegion& b) { return {united(a.x, b.x), united(a.y, b.y)}; }

double metres_per_px(const MapRegion& region, double width, double height) {
  return std::max(region.x.length() / width, region.y.length() / height);
}

bool is_inside(const PixelBox& box, Pixel pixel) {
  return pixel.x >= box.left && pixel.x <= box.right() && pixel.y >= box.top && pixel.y <= box.bottom();
}

/// Whether the line from a to b has a part in the box (Liang and Barsky: the shares of its way within each edge).
std::optional<std::pair<double, double>> shares_inside(Pixel a, Pixel b, const PixelBox& box) {
  double first = 0.0;
  double last = 1.0;
  const auto cut = [&](double from, double step, double low, double high) {
    if (step == 0.0) {
      return from >= low && from <= high;
    }
    const double t1 = (low - from) / step;
    const double t2 = (high - from) / step;
    first = std::max(first, std::min(t1, t2));
    last = std::min(last, std::max(t1, t2));
    return first <= last;
  };
  if (!cut(a.x, b.x - a.x, box.left, box.right()) || !cut(a.y, b.y - a.y, box.top, box.bottom())) {
    return std::nullopt;
  }
  return std::pair(first, last);
}

bool is_finite(Pixel pixel) { return std::isfinite(pixel.x) && std::isfinite(pixel.y); }

bool covers(const PixelBox& box, std::span<const Pixel> line) {
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Pixel from = line[k > 0 ? k - 1 : 0];
    if (is_finite(from) && is_finite(line[k]) && shares_inside(from, line[k], box)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::optional<MapRegion> region_of(std::span<const Path* const> paths) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Path* path : paths) {
    for (const Eigen::Vector3d& position : *path) {
      if (position.head<2>().allFinite()) {
        x.push_back(position.x());
        y.push_back(position.y());
      }
    }
  }
  const auto along_x = drawing::range_of(x);
  return along_x ? std::optional(MapRegion{*along_x, *drawing::range_of(y)}) : std::nullopt;
}

bool MapChoice::leaves_out() const { return std::find(leads_away.begin(), leads_away.end(), true) != leads_away.end(); }

MapChoice choose_map(const std::vector<Path>& estimates, const Path& ground_truth, double width, double height) {
  const Path* const truth[] = {&ground_truth};
  std::optional<MapRegion> base = region_of(truth);
  std::vector<std::optional<MapRegion>> regions;
  std::vector<double> scales;
  for (const Path& estimate : estimates) {
    const Path* const alone[] = {&estimate};
    regions.push_back(region_of(alone));
    if (regions.back()) {
      scales.push_back(metres_per_px(*regions.back(), width, height));
    }
  }
  // What a metre may shrink to. A drive that stands still hides nothing.
  const double least = base ? metres_per_px(*base, width, height) : median(std::move(scales));
  const double most = least > 0.0 ? kShrinking * least : std::numeric_limits<double>::infinity();

  MapChoice choice;
  std::optional<MapRegion> all = base;
  std::optional<MapRegion> shown = base;
  for (const std::optional<MapRegion>& region : regions) {
    const bool away = region && metres_per_px(base ? united(*base, *region) : *region, width, height) > most;
    choice.leads_away.push_back(away);
    if (region) {
      all = all ? united(*all, *region) : *region;
      shown = away ? shown : shown ? united(*shown, *region) : *region;
    }
  }
  choice.all = all.value_or(MapRegion{{0.0, 0.0}, {0.0, 0.0}});
  choice.shown = shown.value_or(choice.all);
  return choice;
}

std::optional<Pixel> exit_of(std::span<const Pixel> line, const PixelBox& box) {
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Pixel from = line[k - 1];
    const Pixel to = line[k];
    if (is_finite(from) && is_finite(to) && is_inside(box, from) && !is_inside(box, to)) {
      const auto shares = shares_inside(from, to, box);
      const double share = shares ? shares->second : 0.0;
      return Pixel{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    }
  }
  return std::nullopt;
}

std::optional<PixelBox> free_corner(const PixelBox& area, double width, double height,
                                    std::span<const std::vector<Pixel>> lines) {
  constexpr double kFromEdge = 6.0;  // px
  constexpr double kFromLines = 5.0;
  if (area.width < width + 2.0 * kFromEdge || area.height < height + 2.0 * kFromEdge) {
    return std::nullopt;
  }
  const double right = area.right() - kFromEdge - width;
  const double bottom = area.bottom() - kFromEdge - height;
  for (const Pixel corner : {Pixel{right, area.top + kFromEdge}, Pixel{area.left + kFromEdge, area.top + kFromEdge},
                             Pixel{right, bottom}, Pixel{area.left + kFromEdge, bottom}}) {
    const PixelBox with_gap{corner.x - kFromLines, corner.y - kFromLines, width + 2.0 * kFromLines,
                            height + 2.0 * kFromLines};
    if (std::none_of(lines.begin(), lines.end(), [&](const auto& line) { return covers(with_gap, line); })) {
      return PixelBox{corner.x, corner.y, width, height};
    }
  }
  return std::nullopt;
}

}  // namespace dynamic_icp::figures
