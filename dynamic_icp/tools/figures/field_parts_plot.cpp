// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_parts_plot.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/window/error_by_direction.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/figures/field_summary.hpp"

namespace dynamic_icp::figures {
namespace {

// px
constexpr double kPartWidth = 460.0;
constexpr double kPartHeight = 120.0;
constexpr double kPartLeft = 78.0;
constexpr double kPartAbove = 40.0;
constexpr double kPartBelow = 52.0;
constexpr double kDot = 5.0;

constexpr double kPerMetre = 1000.0;  // mm
constexpr double kMaxRange_m = 200.0;
constexpr std::size_t kRanges = 80;

/// Values over something, each with its standard deviation.
struct PartPanel {
  std::string title;
  std::string x_label;
  bool is_curve = false;       ///< a line with a band; else dots with bars
  bool whole_numbers = false;  ///< of x
  std::vector<double> x = {};
  std::vector<double> error_mps = {};
  std::vector<double> sigma_mps = {};
};

/// The parts of this name, one for each sensor; a sensor without lines or faces has none.
std::vector<const window::SensorCalibration::Part*> parts_called(const window::SensorCalibration& calibration,
                                                                 const char* name) {
  std::vector<const window::SensorCalibration::Part*> parts;
  for (const window::SensorCalibration::Part& part : calibration.parts) {
    if (part.name == name && part.error_mps.size() > 1) {
      parts.push_back(&part);
    }
  }
  return parts;
}

PartPanel range_panel(const window::SensorCalibration& calibration, std::size_t sensor, const std::string& of) {
  PartPanel panel{.title = "By range" + of + ", compared with 30 m", .x_label = "range (m)", .is_curve = true};
  for (std::size_t k = 1; k <= kRanges; ++k) {
    panel.x.push_back(kMaxRange_m * static_cast<double>(k) / kRanges);
  }
  window::ErrorByRange errors = window::error_by_range(calibration, sensor, panel.x);
  panel.error_mps = std::move(errors.error_mps);
  panel.sigma_mps = std::move(errors.sigma_mps);
  return panel;
}

std::vector<PartPanel> part_panels(const window::SensorCalibration& calibration) {
  std::vector<PartPanel> panels;
  for (const auto* part : parts_called(calibration, "line")) {
    PartPanel panel{.title = "By line (beam)", .x_label = "elevation of the line (deg)"};
    for (const double elevation_rad : calibration.shape.line_elevations_rad) {
      panel.x.push_back(elevation_rad * 180.0 / std::numbers::pi);
    }
    panel.error_mps = part->error_mps;
    panel.sigma_mps = part->sigma_mps;
    panels.push_back(std::move(panel));
  }
  for (const auto* part : parts_called(calibration, "face")) {
    PartPanel panel{.title = "By face of the mirror", .x_label = "face", .whole_numbers = true};
    for (std::size_t face = 0; face < part->error_mps.size(); ++face) {
      panel.x.push_back(static_cast<double>(face));
    }
    panel.error_mps = part->error_mps;
    panel.sigma_mps = part->sigma_mps;
    panels.push_back(std::move(panel));
  }
  const std::size_t sensors = calibration.shape.views.size();
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
    panels.push_back(range_panel(calibration, sensor, sensors > 1 ? fmt::format(", sensor {}", sensor) : ""));
  }
  return panels;
}

/// All values with their standard deviations, and zero.
drawing::Range errors_shown(const PartPanel& panel) {
  double largest = kMinError_mps;
  for (std::size_t k = 0; k < panel.x.size(); ++k) {
    largest = std::max(largest, std::abs(panel.error_mps[k]) + panel.sigma_mps[k]);
  }
  return {-1.1 * kPerMetre * largest, 1.1 * kPerMetre * largest};
}

void draw_part(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area, const PartPanel& panel) {
  const drawing::Range across =
      panel.is_curve ? drawing::Range{0.0, kMaxRange_m} : drawing::padded(*drawing::range_of(panel.x), 0.05);
  const drawing::Axes axes(area, {.label = panel.x_label, .range = across, .whole_numbers = panel.whole_numbers},
                           {.label = "mm/s", .range = errors_shown(panel)});
  axes.draw(svg, theme);
  svg.text({area.left, area.top - 14.0}, panel.title, {.colour = theme.ink, .size = 15.0, .bold = true});
  svg.line(axes.at(across.minimum, 0.0), axes.at(across.maximum, 0.0), {.stroke = theme.ink, .opacity = 0.6});
  const std::string& colour = theme.series.front();
  std::vector<drawing::Pixel> line;
  std::vector<drawing::Pixel> band;
  for (std::size_t k = 0; k < panel.x.size(); ++k) {
    const auto at = [&](double sigmas) {
      return axes.at(panel.x[k], kPerMetre * (panel.error_mps[k] + sigmas * panel.sigma_mps[k]));
    };
    line.push_back(at(0.0));
    if (panel.is_curve) {
      band.push_back(at(1.0));
      band.insert(band.begin(), at(-1.0));
    } else {
      svg.line(at(-1.0), at(1.0), {.stroke = colour, .width = 1.5, .opacity = 0.7});
    }
  }
  if (panel.is_curve) {
    svg.polygon(band, {.fill = colour, .opacity = 0.25});
    svg.polyline(line, {.stroke = colour, .width = 1.8});
  } else {
    svg.dots(line, kDot, colour);
  }
}

}  // namespace

drawing::Svg field_parts_plot(const window::SensorCalibration& calibration, const drawing::Theme& theme,
                              Medium medium) {
  const double width = medium == Medium::kPaper ? kColumnWidth - kPartLeft - 30.0 : kPartWidth;
  const std::vector<PartPanel> panels = part_panels(calibration);
  constexpr double kRow = kPartAbove + kPartHeight + kPartBelow;
  drawing::Svg svg(kPartLeft + width + 30.0, kRow * static_cast<double>(panels.size()),
                   "What was learned of the error of the Doppler by line, face and range, with one standard deviation");
  svg.rectangle({0.0, 0.0, svg.width(), svg.height()}, {.fill = theme.background});
  for (std::size_t k = 0; k < panels.size(); ++k) {
    draw_part(svg, theme, {kPartLeft, kPartAbove + kRow * static_cast<double>(k), width, kPartHeight}, panels[k]);
  }
  return svg;
}

}  // namespace dynamic_icp::figures
