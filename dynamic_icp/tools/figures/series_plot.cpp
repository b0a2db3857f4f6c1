// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/series_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/drawing/run_colours.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kLeft = 74.0;  // px around the drawing areas
constexpr double kRight = 18.0;
constexpr double kHead = 40.0;   // title; the legend comes below
constexpr double kBare = 10.0;   // above a drawing area without title
constexpr double kNoFoot = 6.0;  // below one without times
constexpr double kEdge = 4.0;    // of the picture, left of the labels
constexpr double kFoot = 50.0;   // ticks and label of the time axis

constexpr double kTowering = 20.0;  // times as large: on a linear axis the rest lies on its foot

/// Those that a logarithmic axis can show.
std::vector<double> positive_values(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !(value > 0.0) || !std::isfinite(value); });
  return values;
}

std::vector<double> values_of(const Panel& panel) {
  std::vector<double> all;
  for (const Series& series : panel.series) {
    all.insert(all.end(), series.values.begin(), series.values.end());
  }
  for (const Level& level : panel.levels) {
    all.push_back(level.value);
  }
  return all;
}

drawing::Range linear_range(const Panel& panel) {
  drawing::Range range = drawing::range_of(values_of(panel)).value_or(drawing::Range{0.0, 1.0});
  if (!panel.from_zero) {
    return drawing::padded(range, 0.08);
  }
  const bool touches_zero = range.minimum >= 0.0;
  range = drawing::padded({std::min(range.minimum, 0.0), std::max(range.maximum, 0.0)}, 0.08);
  return touches_zero ? drawing::Range{0.0, range.maximum} : range;
}

/// At least one decade around the positive values.
drawing::Range log_range(const Panel& panel) {
  std::vector<double> positive = values_of(panel);
  std::erase_if(positive, [](double value) { return !(value > 0.0); });
  const drawing::Range range = drawing::range_of(positive).value_or(drawing::Range{0.1, 1.0});
  const double lack = std::max(1.0, std::sqrt(10.0 * range.minimum / range.maximum));
  return {range.minimum / (1.2 * lack), range.maximum * 1.2 * lack};
}

drawing::Axis vertical_axis(const Panel& panel) {
  if (panel.logarithmic) {
    return {panel.label, log_range(panel), drawing::Scale::kLogarithmic};
  }
  return {panel.label, linear_range(panel), drawing::Scale::kLinear, panel.whole_numbers};
}

/// Pixels of one column keep their first, lowest, highest and last value only: a long drive is not drawn finer than
/// the picture shows, and no peak is lost.
class ColumnThinning {
 public:
  void add(drawing::Pixel pixel) {
    const bool is_gap = !std::isfinite(pixel.y);
    if (is_gap || column_.empty() || std::floor(2.0 * pixel.x) != std::floor(2.0 * column_.front().x)) {
      flush();
    }
    if (is_gap) {
      kept_.push_back(pixel);
    } else {
      column_.push_back(pixel);
    }
  }

  std::vector<drawing::Pixel> finish() {
    flush();
    return std::move(kept_);
  }

 private:
  void flush() {
    if (column_.size() <= 4) {
      kept_.insert(kept_.end(), column_.begin(), column_.end());
    } else {
      const auto [low, high] = std::minmax_element(
          column_.begin(), column_.end(), [](const drawing::Pixel& a, const drawing::Pixel& b) { return a.y < b.y; });
      kept_.insert(kept_.end(), {column_.front(), *std::min(low, high), *std::max(low, high), column_.back()});
    }
    column_.clear();
  }

  std::vector<drawing::Pixel> column_;
  std::vector<drawing::Pixel> kept_;
};

std::vector<drawing::Pixel> pixels_of(const drawing::Axes& axes, const std::vector<double>& times, const Series& series,
                                      const drawing::Axis& vertical) {
  ColumnThinning thinning;
  for (std::size_t k = 0; k < std::min(times.size(), series.values.size()); ++k) {
    const bool below = vertical.scale == drawing::Scale::kLogarithmic && series.values[k] < vertical.range.minimum;
    thinning.add(axes.at(times[k], below ? vertical.range.minimum : series.values[k]));
  }
  return thinning.finish();
}

/// The colour of each line; broad ones are what the others are compared with.
std::vector<drawing::LegendEntry> legend_of(const Panel& panel, const drawing::Theme& theme) {
  std::vector<std::string> names;
  for (const Series& series : panel.series) {
    if (!series.broad) {
      names.push_back(series.name);
    }
  }
  const std::vector<std::size_t> places = drawing::colours_of_runs(names);
  std::vector<drawing::LegendEntry> legend;
  std::size_t next = 0;
  for (const Series& series : panel.series) {
    legend.push_back({series.name, series.broad ? theme.truth : theme.series[places[next++] % theme.series.size()]});
  }
  return legend;
}

bool are_named_alike(const Panel& a, const Panel& b) {
  return std::equal(a.series.begin(), a.series.end(), b.series.begin(), b.series.end(),
                    [](const Series& one, const Series& other) { return one.name == other.name; });
}

void draw_levels(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area,
                 const drawing::Axes& axes, const drawing::Range& times, const Panel& panel) {
  for (const Level& level : panel.levels) {
    const double y = axes.at(times.minimum, level.value).y;
    const std::array<drawing::Pixel, 2> line = {{{area.left, y}, {area.right(), y}}};
    svg.polyline(line, {.stroke = theme.ink, .width = 1.0, .opacity = 0.6});
    svg.text({area.right() - 4.0, y - 4.0}, level.name,
             {.colour = theme.muted, .size = 12.0, .anchor = drawing::Anchor::kEnd, .halo = theme.panel});
  }
}

drawing::Axes axes_of(const drawing::PixelBox& area, const Panel& panel, const std::vector<double>& times,
                      bool with_times) {
  const drawing::Range range = drawing::range_of(times).value_or(drawing::Range{0.0, 1.0});
  const bool instant = !(range.length() > 0.0);
  return {area,
          {.label = with_times ? "time (s)" : "",
           .range = instant ? drawing::padded(range, 0.0) : range,
           .with_numbers = with_times},
          vertical_axis(panel)};
}

void draw_panel(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area, const Panel& panel,
                const std::vector<double>& times, bool with_times) {
  const drawing::Axis vertical = vertical_axis(panel);
  const drawing::Range time_range = drawing::range_of(times).value_or(drawing::Range{0.0, 1.0});
  const drawing::Axes axes = axes_of(area, panel, times, with_times);
  axes.draw(svg, theme);
  const std::vector<drawing::LegendEntry> legend = legend_of(panel, theme);
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const drawing::Paint paint = panel.series[k].broad
                                     ? drawing::Paint{.stroke = legend[k].colour, .width = 6.0, .opacity = 0.55}
                                     : drawing::Paint{.stroke = legend[k].colour, .width = 1.8};
    svg.polyline(pixels_of(axes, times, panel.series[k], vertical), paint);
  }
  draw_levels(svg, theme, area, axes, time_range, panel);  // over the lines, which would hide their names
  if (std::none_of(panel.series.begin(), panel.series.end(),
                   [](const Series& series) { return drawing::range_of(series.values).has_value(); })) {
    svg.text({area.left + 0.5 * area.width, area.top + 0.5 * area.height}, "no values",
             {.colour = theme.muted, .size = 14.0, .anchor = drawing::Anchor::kMiddle});
  }
}

}  // namespace

drawing::Svg series_plot(const std::vector<double>& times, const std::vector<Panel>& panels,
                         const drawing::Theme& theme, const PanelSize& size) {
  // Without titles panels stand close: the last one has the times of all, a legend that is that of the panel before is
  // left out, and the areas begin where their numbers end.
  const double head = size.with_titles ? kHead : kBare;
  double left = kLeft;
  if (!size.with_titles) {
    left = 0.0;
    for (const Panel& panel : panels) {
      left = std::max(left, kEdge + axes_of({0.0, 0.0, size.width, size.height}, panel, times, true).left_margin());
    }
  }
  const double area_width = size.width - left - kRight;
  const auto has_times = [&](std::size_t k) { return size.with_titles || k + 1 == panels.size(); };
  const auto foot = [&](std::size_t k) { return has_times(k) ? kFoot : kNoFoot; };
  // A single line needs no legend: the title, or the label of the axis, says what it is.
  const auto draw_legend_of = [&](drawing::Svg* svg, double top, std::size_t k) {
    const bool is_needed =
        panels[k].series.size() > 1 && (size.with_titles || k == 0 || !are_named_alike(panels[k], panels[k - 1]));
    return is_needed
               ? drawing::draw_legend(svg, theme, {left, top + head + 7.0}, area_width, legend_of(panels[k], theme))
               : 0;
  };
  double height = 0.0;
  std::string description;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    height += head + drawing::kLegendLine * draw_legend_of(nullptr, 0.0, k) + size.height + foot(k);
    description += (description.empty() ? "" : "; ") + panels[k].title;
  }
  drawing::Svg svg(size.width, height, description);
  svg.rectangle({0.0, 0.0, size.width, height}, {.fill = theme.background}, size.with_titles ? 8.0 : 0.0);
  double top = 0.0;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    if (size.with_titles) {
      svg.text({left, top + 26.0}, panels[k].title, {.colour = theme.ink, .size = 15.0, .bold = true});
    }
    top += head + drawing::kLegendLine * draw_legend_of(&svg, top, k);
    draw_panel(svg, theme, {left, top, area_width, size.height}, panels[k], times, has_times(k));
    top += size.height + foot(k);
  }
  return svg;
}

bool spans_decades(const std::vector<double>& values) {
  const std::vector<double> positive = positive_values(values);
  constexpr std::size_t kMin = 3;
  return positive.size() >= kMin &&
         *std::max_element(positive.begin(), positive.end()) > kTowering * quantile(positive, 0.5);
}

bool lie_far_apart(const std::vector<Series>& lines) {
  std::vector<double> medians;
  for (const Series& line : lines) {
    if (const std::vector<double> positive = positive_values(line.values); !positive.empty()) {
      medians.push_back(quantile(positive, 0.5));
    }
  }
  const auto [least, most] = std::minmax_element(medians.begin(), medians.end());
  return !medians.empty() && *most > kTowering * *least;
}

}  // namespace dynamic_icp::figures
