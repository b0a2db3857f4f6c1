// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/trajectory_plot.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"
#include "dynamic_icp/tools/drawing/run_colours.hpp"
#include "dynamic_icp/tools/figures/far_paths.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kPathLeft = 74.0;  // px around the drawing area
constexpr double kPathRight = 18.0;
constexpr double kPathEdge = 8.0;  // of a picture on paper, left of the label
constexpr double kTop = 58.0;
constexpr double kTitleHeight = 32.0;  // of it, left out on paper
constexpr double kInsetGap = 10.0;     // below an inset that stands under the map
constexpr double kBottom = 50.0;
constexpr double kSmallestHeight = 130.0;  // px of the drawing area

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

/// What the name of the start takes, as a line that nothing may cover.
std::vector<drawing::Pixel> start_box(drawing::Pixel start) {
  return {{start.x - 20.0, start.y - 24.0}, {start.x + 20.0, start.y + 26.0}};
}

/// Where a path leaves the map: a triangle that points out of it.
void draw_exit(drawing::Svg& svg, const drawing::PixelBox& area, drawing::Pixel exit, const std::string& colour,
               const std::string& name) {
  constexpr double kLong = 9.0;
  constexpr double kHalf = 5.5;
  const double to_side = std::min(exit.x - area.left, area.right() - exit.x);
  const double to_end = std::min(exit.y - area.top, area.bottom() - exit.y);
  const bool sideways = to_side < to_end;
  const double out_x = !sideways ? 0.0 : exit.x - area.left < area.right() - exit.x ? -1.0 : 1.0;
  const double out_y = sideways ? 0.0 : exit.y - area.top < area.bottom() - exit.y ? -1.0 : 1.0;
  if (sideways) {  // all of the triangle stays within the map
    exit.y = std::clamp(exit.y, area.top + kHalf, area.bottom() - kHalf);
  } else {
    exit.x = std::clamp(exit.x, area.left + kHalf, area.right() - kHalf);
  }
  const drawing::Pixel foot{exit.x - kLong * out_x, exit.y - kLong * out_y};
  const std::vector<drawing::Pixel> corners = {
      exit, {foot.x + kHalf * out_y, foot.y + kHalf * out_x}, {foot.x - kHalf * out_y, foot.y - kHalf * out_x}};
  svg.polygon(corners, {.fill = colour, .title = name + " leaves the map"});
}

/// The positions of all estimates.
std::vector<std::vector<Eigen::Vector3d>> estimates_of(const PathMap& paths) {
  std::vector<std::vector<Eigen::Vector3d>> all;
  for (const NamedPath& path : paths.estimates) {
    all.push_back(path.positions);
  }
  return all;
}

constexpr double kInsetFoot = 20.0;  // px below the paths of an inset: its scale

struct InsetSize {
  double width = 0.0;
  double height = 0.0;
};

/// As wide as the paths need, within what leaves room beside it. `share`: of the height of the area.
InsetSize inset_size(const drawing::PixelBox& area, const MapRegion& all, double share) {
  constexpr double kLeast = 110.0;  // px, for the scale
  constexpr double kLowest = 50.0;
  const double highest = std::max(kLowest, share * area.height);
  const double aspect = all.x.length() > 0.0 ? std::max(1e-3, all.y.length() / all.x.length()) : 1.0;
  const double width = std::clamp((highest - kInsetFoot) / aspect, kLeast, std::max(kLeast, 0.36 * area.width));
  return {width, std::clamp(width * aspect + kInsetFoot, kLowest, highest)};
}

/// In a free corner, smaller where a large one finds none.
std::optional<drawing::PixelBox> inset_inside(const drawing::PixelBox& area, const MapRegion& all,
                                              std::span<const std::vector<drawing::Pixel>> lines) {
  for (const double share : {0.5, 0.4, 0.3}) {
    const InsetSize size = inset_size(area, all, share);
    if (const auto box = free_corner(area, size.width, size.height, lines)) {
      return box;
    }
  }
  return std::nullopt;
}

/// A small map of everything, with a frame about what the large one shows.
void draw_inset(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& box, const PathMap& paths,
                const MapRegion& everything, const MapRegion& shown, const std::vector<std::string>& colours) {
  svg.rectangle(box, {.fill = theme.panel, .stroke = theme.muted, .width = 1.0});
  const drawing::PixelBox inner{box.left + 4.0, box.top + 4.0, box.width - 8.0, box.height - kInsetFoot - 4.0};
  drawing::Range x = drawing::padded(everything.x, 0.03);
  drawing::Range y = drawing::padded(everything.y, 0.03);
  drawing::make_aspect_equal(inner, x, y);
  const drawing::Axes axes(inner, {.label = "", .range = x}, {.label = "", .range = y});
  if (!paths.ground_truth.empty()) {
    svg.polyline(thinned(axes, paths.ground_truth), {.stroke = theme.truth, .width = 3.0, .opacity = 0.55});
  }
  for (std::size_t k = 0; k < paths.estimates.size(); ++k) {
    svg.polyline(thinned(axes, paths.estimates[k].positions), {.stroke = colours[k], .width = 1.4});
  }
  const drawing::Pixel low = axes.at(shown.x.minimum, shown.y.maximum);
  const drawing::Pixel high = axes.at(shown.x.maximum, shown.y.minimum);
  svg.rectangle({low.x, low.y, high.x - low.x, high.y - low.y}, {.stroke = theme.ink, .width = 1.0});
  const double metres = drawing::nice_step(x.length(), 5);
  const double bar = metres * inner.width / x.length();
  const double y_bar = box.bottom() - 8.0;
  svg.line({inner.left + 2.0, y_bar}, {inner.left + 2.0 + bar, y_bar}, {.stroke = theme.ink, .width = 2.0});
  svg.text({inner.left + bar + 8.0, y_bar + 4.0}, drawing::compact_number(metres) + " m",
           {.colour = theme.ink, .size = 12.0});
}

}  // namespace

drawing::Svg trajectory_plot(const PathMap& paths, const drawing::Theme& theme, const MapSize& size) {
  double left = kPathLeft;
  double width = size.width - left - kPathRight;
  const double head = size.with_title ? kTop : kTop - kTitleHeight;
  const double largest = size.largest_height - head - kBottom;
  const MapChoice choice = choose_map(estimates_of(paths), paths.ground_truth, width, largest);
  drawing::Range x = drawing::padded(choice.shown.x, 0.05);
  drawing::Range y = drawing::padded(choice.shown.y, 0.05);
  if (!size.with_title) {  // on paper the map begins where its numbers end
    drawing::Range x_seen = x;
    drawing::Range y_seen = y;
    const drawing::PixelBox about{0.0, 0.0, width,
                                  std::clamp(width * y.length() / x.length(), kSmallestHeight, largest)};
    drawing::make_aspect_equal(about, x_seen, y_seen);
    left =
        kPathEdge + drawing::Axes(about, {.label = "", .range = x_seen}, {.label = "", .range = y_seen}).left_margin();
    width = size.width - left - kPathRight;
  }
  const std::vector<drawing::LegendEntry> legend = legend_of(paths, theme);
  const double top = head + drawing::kLegendLine * (drawing::draw_legend(nullptr, theme, {}, width, legend) - 1);
  const drawing::PixelBox area{left, top, width, std::clamp(width * y.length() / x.length(), kSmallestHeight, largest)};
  drawing::make_aspect_equal(area, x, y);
  const drawing::Axes axes(area, {.label = "x (m)", .range = x}, {.label = "y (m)", .range = y});

  const std::vector<drawing::Pixel> truth = thinned(axes, paths.ground_truth);
  std::vector<std::vector<drawing::Pixel>> lines;
  std::optional<drawing::Pixel> start;
  for (const NamedPath& path : paths.estimates) {
    lines.push_back(thinned(axes, path.positions));
    if (!start && !lines.back().empty()) {
      start = lines.back().front();
    }
  }
  std::optional<drawing::PixelBox> inset;
  double below = 0.0;  // px under the map
  if (choice.leaves_out()) {
    std::vector<std::vector<drawing::Pixel>> taken = lines;
    taken.push_back(truth);
    if (start) {
      taken.push_back(start_box(*start));
    }
    inset = inset_inside(area, choice.all, taken);
    if (!inset) {
      const double height = inset_size(area, choice.all, 0.5).height;
      inset = drawing::PixelBox{area.left, area.bottom() + kBottom, area.width, height};
      below = height + kInsetGap;
    }
  }

  drawing::Svg svg(size.width, area.bottom() + kBottom + below, paths.title);
  svg.rectangle({0.0, 0.0, svg.width(), svg.height()}, {.fill = theme.background}, size.with_title ? 8.0 : 0.0);
  if (size.with_title) {
    svg.text({left, 26.0}, paths.title, {.colour = theme.ink, .size = 15.0, .bold = true});
  }
  axes.draw(svg, theme);
  svg.begin_clip(area);
  svg.polyline(truth, {.stroke = theme.truth, .width = 7.0, .opacity = 0.55});
  for (std::size_t k = 0; k < lines.size(); ++k) {
    svg.polyline(lines[k], {.stroke = legend[k].colour, .width = 2.2});
  }
  svg.end_clip();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (const auto exit = choice.leads_away[k] ? exit_of(lines[k], area) : std::nullopt) {
      draw_exit(svg, area, *exit, legend[k].colour, legend[k].text);
    } else if (!choice.leads_away[k] && !lines[k].empty()) {
      svg.circle(lines[k].back(), 4.5, {.fill = legend[k].colour, .title = "end"});
    }
  }
  drawing::draw_legend(&svg, theme, {left, head - 11.0}, area.width, legend);
  if (start) {
    draw_start(svg, theme, area, *start);
  } else {
    svg.text({area.left + 0.5 * area.width, area.top + 0.5 * area.height}, "no poses",
             {.colour = theme.muted, .size = 14.0, .anchor = drawing::Anchor::kMiddle});
  }
  if (inset) {
    draw_inset(svg, theme, *inset, paths, choice.all, {x, y}, colours_of(paths, theme));
  }
  return svg;
}

}  // namespace dynamic_icp::figures
