// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"

namespace dynamic_icp::drawing {

/// An interval of values, minimum <= maximum.
struct Range {
  double minimum = 0.0;
  double maximum = 1.0;

  [[nodiscard]] double length() const { return maximum - minimum; }
};

/// The smallest range that holds every finite value of `values`; empty when there is none.
std::optional<Range> range_of(std::span<const double> values);

/// The range made longer at both ends by `share` of its length; a range without length gets some around its value.
Range padded(Range range, double share);

/// The step of 1, 2 or 5 times a power of ten that divides `length` (> 0) into at most `most` steps (>= 1).
double nice_step(double length, int most);

/// The multiples of `nice_step` in the range, ascending: at most `most` + 1 of them.
std::vector<double> nice_ticks(Range range, int most);

/// Powers of ten in the range (> 0); with fewer than two of them also 2 and 5 times powers of ten.
std::vector<double> log_ticks(Range range);

enum class Scale { kLinear, kLogarithmic };

struct Axis {
  std::string label;  ///< what and in which unit: "time (s)"
  Range range;        ///< > 0 where the scale is logarithmic
  Scale scale = Scale::kLinear;
  bool whole_numbers = false;  ///< no ticks in between
  bool with_numbers = true;    ///< at its ticks; without them another axis has them
};

/// A drawing area with two axes: maps values to pixels and draws frame, grid, ticks and labels.
class Axes {
 public:
  /// `area` is inside of the axes; ticks and labels are drawn to the left of it (about 70 px) and below (40 px).
  Axes(const PixelBox& area, Axis x, Axis y);

  [[nodiscard]] const PixelBox& area() const { return area_; }
  [[nodiscard]] Pixel at(double x, double y) const;

  void draw(Svg& svg, const Theme& theme) const;

  /// What ticks and label of the vertical axis take to the left of the area, px.
  [[nodiscard]] double left_margin() const;

 private:
  void draw_x_ticks(Svg& svg, const Theme& theme) const;
  /// Gives the width of the widest label, px.
  double draw_y_ticks(Svg& svg, const Theme& theme) const;

  PixelBox area_;
  Axis x_;
  Axis y_;
};

/// Makes one of the ranges longer, around its middle, so that a metre is as many pixels along x as along y.
void make_aspect_equal(const PixelBox& area, Range& x, Range& y);

struct LegendEntry {
  std::string text;
  std::string colour;
};

/// A legend of samples and texts from `at` (left end, baseline of the first line) to the right, in as many lines of
/// kLegendLine px as it takes to stay within `width`. Gives the number of lines, also without a picture to draw into.
constexpr double kLegendLine = 18.0;
int draw_legend(Svg* svg, const Theme& theme, Pixel at, double width, std::span<const LegendEntry> entries);

}  // namespace dynamic_icp::drawing
