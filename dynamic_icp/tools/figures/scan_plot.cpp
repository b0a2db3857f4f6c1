// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/scan_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"
#include "dynamic_icp/tools/figures/ground_view.hpp"
#include "dynamic_icp/tools/figures/object_marks.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr PanelSpacing kSpacing;
constexpr double kScreenWidth = 1120.0;  // px
constexpr double kScaleFoot = 78.0;      // px below the panels, for the scales
constexpr std::size_t kMaxDots = 13'000;

/// The rows to draw: thinned just as far as it takes to stay within kMaxDots.
std::vector<std::uint32_t> rows_to_draw(const Scan& scan, const GroundView& ground) {
  double cell_m = std::max(0.1, 1.3 / ground.pixels_per_metre());
  while (true) {
    std::vector<std::uint32_t> rows = rows_per_cell(scan, cell_m);
    std::erase_if(rows, [&](std::uint32_t row) {
      return !ground.region.contains(scan.points()[row].x(), scan.points()[row].y());
    });
    if (rows.size() <= kMaxDots) {
      return rows;
    }
    cell_m *= 1.25;
  }
}

/// The largest magnitude of the colour scale, a round number.
double colour_limit(const std::vector<double>& doppler) {
  std::vector<double> magnitudes;
  for (const double value : doppler) {
    magnitudes.push_back(std::abs(value));
  }
  constexpr double kWithin = 0.98;  // gross outliers do not stretch the scale
  const double limit = std::max(quantile(magnitudes, kWithin), 1.0);
  const double step = drawing::nice_step(limit, 5);
  return step * std::ceil(limit / step);
}

/// Range rings and the borders of the field of view.
void draw_surroundings(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground,
                       const drawing::Range& view, double ring_m) {
  const double farthest = std::hypot(std::max(std::abs(ground.region.x.minimum), ground.region.x.maximum),
                                     std::max(std::abs(ground.region.y.minimum), ground.region.y.maximum));
  for (double radius = ring_m; radius < farthest; radius += ring_m) {
    std::vector<drawing::Pixel> arc;
    constexpr int kSteps = 90;
    for (int k = 0; k <= kSteps; ++k) {
      const double azimuth = view.minimum + view.length() * k / kSteps;
      arc.push_back(ground.at(radius * std::cos(azimuth), radius * std::sin(azimuth)));
    }
    svg.polyline(arc, {.stroke = theme.grid, .width = 1.0});
  }
  constexpr double kAllRound = 2.0 * std::numbers::pi * 0.95;
  if (view.length() < kAllRound) {
    for (const double azimuth : {view.minimum, view.maximum}) {
      svg.line(ground.at(0.0, 0.0), ground.at(farthest * std::cos(azimuth), farthest * std::sin(azimuth)),
               {.stroke = theme.grid, .width = 1.5});
    }
  }
}

/// One path a colour; strong colours on top of weak ones.
void draw_points(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground, const Scan& scan,
                 std::span<const std::uint32_t> rows, const std::vector<double>& doppler, double limit) {
  const std::size_t bins = theme.doppler.size();
  std::vector<std::vector<drawing::Pixel>> dots(bins);
  for (const std::uint32_t row : rows) {
    dots[drawing::diverging_bin(doppler[row], limit, bins)].push_back(ground.at(scan.points()[row]));
  }
  const std::size_t middle = bins / 2;
  for (std::size_t away = 0; away <= middle; ++away) {
    svg.dots(dots[middle - away], 2.1, theme.doppler[middle - away]);
    if (away > 0) {
      svg.dots(dots[middle + away], 2.1, theme.doppler[middle + away]);
    }
  }
}

void draw_colour_bar(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& box, double limit) {
  const auto bins = static_cast<double>(theme.doppler.size());
  for (std::size_t k = 0; k < theme.doppler.size(); ++k) {
    const double left = box.left + box.width * static_cast<double>(k) / bins;
    svg.rectangle({left, box.top, box.width / bins + 0.4, box.height}, {.fill = theme.doppler[k]});
  }
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const std::string text = fmt::format("{}{}", share > 0.0 ? "+" : "", drawing::compact_number(share * limit, 2));
    svg.text({box.left + 0.5 * (share + 1.0) * box.width, box.bottom() + 16.0}, text,
             {.colour = theme.muted, .size = 12.0, .anchor = drawing::Anchor::kMiddle});
  }
  svg.text({box.left, box.top - 7.0}, "approaching", {.colour = theme.muted, .size = 12.0});
  svg.text({box.left + 0.5 * box.width, box.top - 7.0}, "Doppler (m/s)",
           {.colour = theme.ink, .size = 12.0, .anchor = drawing::Anchor::kMiddle, .bold = true});
  svg.text({box.right(), box.top - 7.0}, "receding",
           {.colour = theme.muted, .size = 12.0, .anchor = drawing::Anchor::kEnd});
}

void draw_scale_bar(drawing::Svg& svg, const drawing::Theme& theme, drawing::Pixel right_end, double metres,
                    double pixels_per_metre) {
  const double left = right_end.x - metres * pixels_per_metre;
  const drawing::Paint paint{.stroke = theme.ink, .width = 1.6};
  svg.line({left, right_end.y}, right_end, paint);
  svg.line({left, right_end.y - 5.0}, {left, right_end.y + 5.0}, paint);
  svg.line({right_end.x, right_end.y - 5.0}, {right_end.x, right_end.y + 5.0}, paint);
  svg.text({0.5 * (left + right_end.x), right_end.y - 8.0}, drawing::compact_number(metres) + " m",
           {.colour = theme.ink, .size = 12.0, .anchor = drawing::Anchor::kMiddle});
}

std::string note_of(const ScanView& view) {
  std::string count = std::to_string(view.scan.size());
  for (std::size_t digits = 3; digits < count.size(); digits += 4) {
    count.insert(count.size() - digits, 1, ',');
  }
  return fmt::format("{} · {} points", view.title, count);
}

/// What the scales below the panels say.
struct Scales {
  double limit = 1.0;    ///< of the colours, m/s
  double ring_m = 10.0;  ///< between range rings; also the length of the scale bar
};

void draw_foot(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground, const Scales& scales,
               const std::string& note) {
  const double top = ground.box.bottom() + 34.0;
  draw_colour_bar(svg, theme, {kSpacing.margin + 10.0, top, 340.0, 12.0}, scales.limit);
  const double right = svg.width() - kSpacing.margin;
  draw_scale_bar(svg, theme, {right, top + 6.0}, scales.ring_m, ground.pixels_per_metre());
  const double text_right = right - scales.ring_m * ground.pixels_per_metre() - 24.0;
  const drawing::TextStyle style{.colour = theme.muted, .size = 12.0, .anchor = drawing::Anchor::kEnd};
  svg.text({text_right, top - 7.0}, note, style);
  svg.text({text_right, top + 9.0}, "arrows: displacement in 1 s", style);
  svg.text({text_right, top + 25.0}, fmt::format("rings: every {} m", drawing::compact_number(scales.ring_m)), style);
}

void draw_head(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground, const char* title,
               const char* explanation) {
  const double baseline = ground.box.top - 13.0;
  svg.text({ground.box.left, baseline}, title, {.colour = theme.ink, .size = 15.0, .bold = true});
  const double left = ground.box.left + drawing::estimated_width(title, 16.5) + 10.0;
  if (left + drawing::estimated_width(explanation, 13.0) <= ground.box.right()) {
    svg.text({left, baseline}, explanation, {.colour = theme.muted, .size = 13.0});
  }
}

/// What a panel shows.
struct PanelContent {
  const char* title;
  const char* explanation;
  std::vector<double> doppler;  ///< per row of the scan, what the colours mean
};

/// The panels of a scan; the objects are drawn into the last one.
std::vector<PanelContent> panel_contents(const ScanView& view) {
  std::vector<PanelContent> contents = {
      {"Measured Doppler", "every point comes with its radial velocity", view.scan.doppler()}};
  if (view.ego_velocity.allFinite()) {
    contents.push_back({"Ego-motion compensated", "remaining colour = object motion",
                        ego_motion::compensated_doppler(view.scan, view.ego_velocity)});
  }
  return contents;
}

}  // namespace

drawing::Svg scan_plot(const ScanView& view, const drawing::Theme& theme, Medium medium) {
  const double width = medium == Medium::kPaper ? kTextWidth : kScreenWidth;
  const std::vector<PanelContent> contents = panel_contents(view);
  const Region region = region_of_interest(view.scan, rows_per_cell(view.scan, 0.5), view.objects);
  const std::vector<GroundView> panels = arrange_panels(region, contents.size(), width, kSpacing);
  const Scales scales{.limit = colour_limit(view.scan.doppler()), .ring_m = drawing::nice_step(region.x.length(), 9)};
  const std::vector<std::uint32_t> rows = rows_to_draw(view.scan, panels.front());

  drawing::Svg svg(width, panels.back().box.bottom() + kScaleFoot,
                   view.title + " from above, coloured by Doppler velocity");
  svg.rectangle({0.0, 0.0, width, svg.height()}, {.fill = theme.background}, 10.0);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    draw_head(svg, theme, panels[k], contents[k].title, contents[k].explanation);
    svg.rectangle(panels[k].box, {.fill = theme.panel}, 6.0);
    svg.begin_clip(panels[k].box);
    draw_surroundings(svg, theme, panels[k], field_of_view(view.scan), scales.ring_m);
    draw_points(svg, theme, panels[k], view.scan, rows, contents[k].doppler, scales.limit);
    draw_sensor(svg, theme, panels[k], view.ego_velocity);
    if (k + 1 == panels.size()) {
      draw_object_marks(svg, theme, panels[k], view, contents[k].doppler);
    }
    svg.end_clip();
  }
  draw_foot(svg, theme, panels.back(), scales, note_of(view));
  return svg;
}

}  // namespace dynamic_icp::figures
