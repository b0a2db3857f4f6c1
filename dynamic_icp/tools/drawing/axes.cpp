// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/axes.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/tools/drawing/markup.hpp"

namespace dynamic_icp::drawing {
namespace {

constexpr double kTickSize = 12.0;       // px, font
constexpr double kLabelSize = 13.0;      // px, font
constexpr double kLabelDistance = 18.0;  // px, from the area to the label, without the numbers between

/// Tick marks of an axis that is `pixels` long, at least `spacing` px apart.
std::vector<double> ticks_of(const Axis& axis, double pixels, double spacing) {
  const int most = std::max(1, static_cast<int>(pixels / spacing));
  std::vector<double> ticks = axis.scale == Scale::kLinear ? nice_ticks(axis.range, most) : log_ticks(axis.range);
  if (axis.whole_numbers) {
    std::erase_if(ticks, [](double tick) { return std::abs(tick - std::round(tick)) > 1e-6; });
  }
  return ticks;
}

/// Decimals that distinguish ticks one step from each other.
int decimals_for(double step) { return std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9); }

std::string tick_label(const Axis& axis, const std::vector<double>& ticks, std::size_t k) {
  const bool linear = axis.scale == Scale::kLinear;
  const double step = !linear ? ticks[k] : ticks.size() > 1 ? ticks[1] - ticks[0] : nice_step(axis.range.length(), 1);
  return compact_number(ticks[k], decimals_for(step));
}

/// Where `value` lies along the axis: 0 at the minimum, 1 at the maximum.
double share_along(const Axis& axis, double value) {
  const Range& range = axis.range;
  if (axis.scale == Scale::kLogarithmic) {
    return std::log(value / range.minimum) / std::log(range.maximum / range.minimum);
  }
  return (value - range.minimum) / range.length();
}

}  // namespace

std::optional<Range> range_of(std::span<const double> values) {
  std::optional<Range> range;
  for (const double value : values) {
    if (std::isfinite(value)) {
      range = range ? Range{std::min(range->minimum, value), std::max(range->maximum, value)} : Range{value, value};
    }
  }
  return range;
}

Range padded(Range range, double share) {
  // Ticks need room to differ by more than rounding.
  const double least = 1e-6 * std::max({std::abs(range.minimum), std::abs(range.maximum), 1e-3});
  const double margin = range.length() > least ? share * range.length() : std::max(0.5, 1e3 * least);
  return {range.minimum - margin, range.maximum + margin};
}

double nice_step(double length, int most) {
  const double least = length / most;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

std::vector<double> nice_ticks(Range range, int most) {
  if (!(range.length() > 0.0) || !std::isfinite(range.length())) {
    return {};
  }
  const double step = nice_step(range.length(), most);
  const double first = std::ceil(range.minimum / step - 1e-6);
  const double last = std::floor(range.maximum / step + 1e-6);
  std::vector<double> ticks;
  for (double k = first; k <= last; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

std::vector<double> log_ticks(Range range) {
  std::vector<double> powers;
  std::vector<double> all;
  const int last = static_cast<int>(std::floor(std::log10(range.maximum) + 1e-9));
  for (int exponent = static_cast<int>(std::floor(std::log10(range.minimum))); exponent <= last; ++exponent) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, exponent);
      if (tick >= range.minimum * (1.0 - 1e-9) && tick <= range.maximum * (1.0 + 1e-9)) {
        all.push_back(tick);
        if (factor == 1.0) {
          powers.push_back(tick);
        }
      }
    }
  }
  return powers.size() < 2 ? all : powers;
}

Axes::Axes(const PixelBox& area, Axis x, Axis y) : area_(area), x_(std::move(x)), y_(std::move(y)) {}

Pixel Axes::at(double x, double y) const {
  return {area_.left + area_.width * share_along(x_, x), area_.bottom() - area_.height * share_along(y_, y)};
}

void Axes::draw_x_ticks(Svg& svg, const Theme& theme) const {
  constexpr double kNarrow = 400.0;
  const std::vector<double> ticks = ticks_of(x_, area_.width, area_.width < kNarrow ? 48.0 : 70.0);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const double x = at(ticks[k], y_.range.minimum).x;
    svg.line({x, area_.top}, {x, area_.bottom()}, {.stroke = theme.grid});
    if (x_.with_numbers) {
      svg.text({x, area_.bottom() + 17.0}, tick_label(x_, ticks, k),
               {.colour = theme.muted, .size = kTickSize, .anchor = Anchor::kMiddle});
    }
  }
}

double Axes::draw_y_ticks(Svg& svg, const Theme& theme) const {
  double widest = 0.0;
  const std::vector<double> ticks = ticks_of(y_, area_.height, 34.0);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const double y = at(x_.range.minimum, ticks[k]).y;
    svg.line({area_.left, y}, {area_.right(), y}, {.stroke = theme.grid});
    const std::string label = tick_label(y_, ticks, k);
    widest = std::max(widest, estimated_width(label, kTickSize));
    svg.text({area_.left - 7.0, y + 4.0}, label, {.colour = theme.muted, .size = kTickSize, .anchor = Anchor::kEnd});
  }
  return widest;
}

double Axes::left_margin() const {
  double widest = 0.0;
  const std::vector<double> ticks = ticks_of(y_, area_.height, 34.0);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    widest = std::max(widest, estimated_width(tick_label(y_, ticks, k), kTickSize));
  }
  return widest + kLabelDistance + kLabelSize;
}

void Axes::draw(Svg& svg, const Theme& theme) const {
  svg.rectangle(area_, {.fill = theme.panel});
  draw_x_ticks(svg, theme);
  const double label_width = draw_y_ticks(svg, theme);
  svg.rectangle(area_, {.stroke = theme.grid, .width = 1.2});
  svg.text({area_.left + 0.5 * area_.width, area_.bottom() + 36.0}, x_.label,
           {.colour = theme.ink, .size = kLabelSize, .anchor = Anchor::kMiddle});
  svg.text({area_.left - label_width - kLabelDistance, area_.top + 0.5 * area_.height}, y_.label,
           {.colour = theme.ink, .size = kLabelSize, .anchor = Anchor::kMiddle, .vertical = true});
}

void make_aspect_equal(const PixelBox& area, Range& x, Range& y) {
  const double metres_per_pixel = std::max(x.length() / area.width, y.length() / area.height);
  const auto widen = [&](Range& range, double pixels) {
    const double missing = metres_per_pixel * pixels - range.length();
    range = {range.minimum - 0.5 * missing, range.maximum + 0.5 * missing};
  };
  widen(x, area.width);
  widen(y, area.height);
}

int draw_legend(Svg* svg, const Theme& theme, Pixel at, double width, std::span<const LegendEntry> entries) {
  constexpr double kSample = 20.0;
  constexpr double kGap = 6.0;
  Pixel place = at;
  int lines = 1;
  for (const LegendEntry& entry : entries) {
    const double entry_width = kSample + kGap + estimated_width(entry.text, kTickSize);
    if (place.x > at.x && place.x + entry_width > at.x + width) {
      place = {at.x, place.y + kLegendLine};
      ++lines;
    }
    if (svg != nullptr) {
      svg->line({place.x, place.y - 4.0}, {place.x + kSample, place.y - 4.0}, {.stroke = entry.colour, .width = 2.5});
      svg->text({place.x + kSample + kGap, place.y}, entry.text, {.colour = theme.ink, .size = kTickSize});
    }
    place.x += entry_width + 2.0 * kGap;
  }
  return lines;
}

}  // namespace dynamic_icp::drawing
