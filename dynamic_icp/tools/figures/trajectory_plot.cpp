// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/trajectory_plot.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/drawing/run_colours.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kPathLeft = 74.0;  // px around the drawing area
constexpr double kPathRight = 18.0;
constexpr double kTop = 58.0;
constexpr double kBottom = 50.0;
constexpr double kSmallestHeight = 130.0;  // px of the drawing area

/// The range of one coordinate over all paths, with room around it.
drawing::Range extent(const PathMap& paths, int coordinate) {
  std::vector<double> values;
  const auto add = [&](const std::vector<Eigen::Vector3d>& path) {
    for (const Eigen::Vector3d& position : path) {
      values.push_back(position[coordinate]);
    }
  };
  add(paths.ground_truth);
  for (const NamedPath& estimate : paths.estimates) {
    add(estimate.positions);
  }
  return drawing::padded(drawing::range_of(values).value_or(drawing::Range{0.0, 0.0}), 0.05);
}

/// The path in pixels, without the positions that are closer than half a pixel to the one kept before.
std::vector<drawing::Pixel> thinned(const drawing::Axes& axes, const std::vector<Eigen::Vector3d>& path) {
  std::vector<drawing::Pixel> kept;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const drawing::Pixel pixel = axes.at(path[k].x(), path[k].y());
    const bool is_far = kept.empty() || !(std::hypot(pixel.x - kept.back().x, pixel.y - kept.back().y) < 0.5);
    if (is_far || k + 1 == path.size()) {
      kept.push_back(pixel);
    }
  }
  return kept;
}

/// Of each estimate.
std::vector<std::string> colours_of(const PathMap& paths, const drawing::Theme& theme) {
  std::vector<std::string> names;
  for (const NamedPath& path : paths.estimates) {
    names.push_back(path.name);
  }
  std::vector<std::string> colours;
  for (const std::size_t place : drawing::colours_of_runs(names)) {
    colours.push_back(theme.series[place % theme.series.size()]);
  }
  return colours;
}

std::vector<drawing::LegendEntry> legend_of(const PathMap& paths, const drawing::Theme& theme) {
  std::vector<drawing::LegendEntry> legend;
  const std::vector<std::string> colours = colours_of(paths, theme);
  for (std::size_t k = 0; k < paths.estimates.size(); ++k) {
    legend.push_back({paths.estimates[k].name, colours[k]});
  }
  if (!paths.ground_truth.empty()) {
    legend.push_back({"ground truth", theme.truth});
  }
  return legend;
}

void draw_start(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area, drawing::Pixel start) {
  svg.circle(start, 6.0, {.fill = theme.panel, .stroke = theme.series[0], .width = 2.5, .title = "start"});
  const bool room_above = start.y > area.top + 26.0;
  svg.text({start.x, start.y + (room_above ? -11.0 : 22.0)}, "start",
           {.colour = theme.ink, .size = 12.0, .anchor = drawing::Anchor::kMiddle, .halo = theme.panel});
}

}  // namespace

drawing::Svg trajectory_plot(const PathMap& paths, const drawing::Theme& theme, const MapSize& size) {
  drawing::Range x = extent(paths, 0);
  drawing::Range y = extent(paths, 1);
  const double width = size.width - kPathLeft - kPathRight;
  const double largest = size.largest_height - kTop - kBottom;
  const std::vector<drawing::LegendEntry> legend = legend_of(paths, theme);
  const double top = kTop + drawing::kLegendLine * (drawing::draw_legend(nullptr, theme, {}, width, legend) - 1);
  const drawing::PixelBox area{kPathLeft, top, width,
                               std::clamp(width * y.length() / x.length(), kSmallestHeight, largest)};
  drawing::make_aspect_equal(area, x, y);
  const drawing::Axes axes(area, {.label = "x (m)", .range = x}, {.label = "y (m)", .range = y});

  drawing::Svg svg(size.width, area.bottom() + kBottom, paths.title);
  svg.rectangle({0.0, 0.0, svg.width(), svg.height()}, {.fill = theme.background}, 8.0);
  svg.text({kPathLeft, 26.0}, paths.title, {.colour = theme.ink, .size = 15.0, .bold = true});
  axes.draw(svg, theme);
  if (!paths.ground_truth.empty()) {
    svg.polyline(thinned(axes, paths.ground_truth), {.stroke = theme.truth, .width = 7.0, .opacity = 0.55});
  }
  std::optional<drawing::Pixel> start;
  for (std::size_t k = 0; k < paths.estimates.size(); ++k) {
    const std::vector<drawing::Pixel> estimate = thinned(axes, paths.estimates[k].positions);
    svg.polyline(estimate, {.stroke = legend[k].colour, .width = 2.2});
    if (!estimate.empty()) {
      svg.circle(estimate.back(), 4.5, {.fill = legend[k].colour, .title = "end"});
      start = start.value_or(estimate.front());
    }
  }
  drawing::draw_legend(&svg, theme, {kPathLeft, 47.0}, area.width, legend);
  if (start) {
    draw_start(svg, theme, area, *start);
  } else {
    svg.text({area.left + 0.5 * area.width, area.top + 0.5 * area.height}, "no poses",
             {.colour = theme.muted, .size = 14.0, .anchor = drawing::Anchor::kMiddle});
  }
  return svg;
}

}  // namespace dynamic_icp::figures
