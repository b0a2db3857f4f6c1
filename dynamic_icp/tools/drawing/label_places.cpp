// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/label_places.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dynamic_icp::drawing {
namespace {

double common_area(const PixelBox& a, const PixelBox& b) {
  const double width = std::min(a.right(), b.right()) - std::max(a.left, b.left);
  const double height = std::min(a.bottom(), b.bottom()) - std::max(a.top, b.top);
  return std::max(width, 0.0) * std::max(height, 0.0);
}

}  // namespace

void LabelPlaces::block_line(Pixel from, Pixel to) {
  constexpr double kStep = 8.0;  // px: a line is a row of small boxes
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double longest = area_.width + area_.height;
  if (!std::isfinite(length)) {
    return;
  }
  for (double done = 0.0; done <= std::min(length, longest); done += kStep) {
    const double share = length > 0.0 ? done / length : 0.0;
    const Pixel middle{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    block({middle.x - 0.5 * kStep, middle.y - 0.5 * kStep, kStep, kStep});
  }
}

double LabelPlaces::overlap(const PixelBox& box) const {
  double sum = 0.0;
  for (const PixelBox& other : blocked_) {
    sum += common_area(box, other);
  }
  return sum + 4.0 * (box.width * box.height - common_area(box, area_));  // outside is worse than on top of something
}

Pixel LabelPlaces::place(const PixelBox& thing, std::string_view text, double size) {
  const double width = estimated_width(text, size);
  const double height = 1.2 * size;
  // Above and below it moves aside as far as it takes to stay in the area.
  const double middle =
      std::clamp(thing.left + 0.5 * (thing.width - width), area_.left, std::max(area_.left, area_.right() - width));
  const double level = thing.top + 0.5 * (thing.height - height);
  std::optional<PixelBox> best;
  for (const double gap : {4.0, 16.0, 32.0}) {
    const double right = thing.right() + gap;
    const double left = thing.left - width - gap;
    const double above = thing.top - height - gap;
    const double below = thing.bottom() + gap;
    for (const Pixel& corner : {Pixel{middle, above}, Pixel{middle, below}, Pixel{right, level}, Pixel{left, level},
                                Pixel{right, above}, Pixel{right, below}, Pixel{left, above}, Pixel{left, below}}) {
      const PixelBox box{corner.x, corner.y, width, height};
      if (!best || overlap(box) < overlap(*best)) {
        best = box;
      }
    }
  }
  block(*best);
  return {best->left, best->top + 0.8 * height};
}

}  // namespace dynamic_icp::drawing
