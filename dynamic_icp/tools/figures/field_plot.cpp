// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_plot.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/window/error_by_direction.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"
#include "dynamic_icp/tools/drawing/raster.hpp"
#include "dynamic_icp/tools/figures/field_summary.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr std::size_t kAzimuths = 96;
constexpr std::size_t kElevations = 24;

// px
constexpr double kFieldWidth = 460.0;
constexpr double kFieldHeight = 130.0;
constexpr double kBeside = 78.0;
constexpr double kAbove = 44.0;
constexpr double kBelow = 96.0;

constexpr double kMillimetresPerMetre = 1000.0;

/// What a panel shows: numbers over the directions, and how they are coloured.
struct ShownField {
  std::string title;
  Eigen::MatrixXd values;  ///< m/s, elevations x azimuths
  double least = 0.0;
  double most = 1.0;
  drawing::Rgb (*colour)(double share, drawing::Ground ground);
};

drawing::Ground ground_of(const drawing::Theme& theme) {
  return theme.doppler == drawing::theme(drawing::Ground::kDark).doppler ? drawing::Ground::kDark
                                                                         : drawing::Ground::kLight;
}

/// The first row is the highest elevation, the first column the leftmost direction: as the sensor sees it.
drawing::Raster raster_of(const ShownField& shown, drawing::Ground ground) {
  const Eigen::Index rows = shown.values.rows();
  const Eigen::Index columns = shown.values.cols();
  drawing::Raster raster(static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), {});
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index column = 0; column < columns; ++column) {
      const double share = (shown.values(row, column) - shown.least) / (shown.most - shown.least);
      raster.set(static_cast<std::size_t>(columns - 1 - column), static_cast<std::size_t>(rows - 1 - row),
                 shown.colour(share, ground));
    }
  }
  return raster;
}

void draw_field_scale(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area,
                      const ShownField& shown) {
  constexpr std::size_t kSteps = 100;
  drawing::Raster scale(kSteps, 1, {});
  for (std::size_t k = 0; k < kSteps; ++k) {
    scale.set(k, 0, shown.colour((static_cast<double>(k) + 0.5) / kSteps, ground_of(theme)));
  }
  const drawing::PixelBox box{area.left, area.bottom() + 52.0, area.width, 10.0};
  svg.image(box, scale);
  for (const double share : {0.0, 0.5, 1.0}) {
    const double value = shown.least + share * (shown.most - shown.least);
    svg.text({box.left + share * box.width, box.bottom() + 16.0},
             drawing::compact_number(kMillimetresPerMetre * value) + " mm/s",
             {.colour = theme.muted,
              .size = 12.0,
              .anchor = share == 0.0   ? drawing::Anchor::kStart
                        : share == 1.0 ? drawing::Anchor::kEnd
                                       : drawing::Anchor::kMiddle});
  }
}

void draw_field(drawing::Svg& svg, const drawing::Theme& theme, const drawing::PixelBox& area, const ShownField& shown,
                const window::FieldShape::View& view) {
  const ShownView shows = shown_view(view);
  const drawing::Axes axes(area, {"azimuth to the right (deg)", {shows.left_deg, shows.right_deg}},
                           {"elevation (deg)", {shows.bottom_deg, shows.top_deg}});
  axes.draw(svg, theme);
  svg.image(area, raster_of(shown, ground_of(theme)));
  svg.text({area.left, area.top - 14.0}, shown.title, {.colour = theme.ink, .size = 15.0, .bold = true});
  draw_field_scale(svg, theme, area, shown);
}

std::array<ShownField, 2> panels_of(const window::ErrorByDirection& learned, const std::string& sensor) {
  const double limit = std::max(kMinError_mps, learned.error_mps.cwiseAbs().maxCoeff());
  return {ShownField{"Error of the Doppler" + sensor, learned.error_mps, -limit, limit,
                     [](double share, drawing::Ground ground) {
                       return drawing::diverging_colour(2.0 * share - 1.0, ground);
                     }},
          ShownField{"Its standard deviation", learned.sigma_mps, 0.0,
                     std::max(kMinError_mps, learned.sigma_mps.maxCoeff()),
                     [](double share, drawing::Ground) { return drawing::sequential_colour(share); }}};
}

}  // namespace

drawing::Svg field_plot(const window::SensorCalibration& calibration, const drawing::Theme& theme, Medium medium) {
  const double width = medium == Medium::kPaper ? kColumnWidth - kBeside - 30.0 : kFieldWidth;
  const std::size_t sensors = calibration.shape.views.size();
  constexpr double kRow = kAbove + kFieldHeight + kBelow;
  drawing::Svg svg(kBeside + width + 30.0, 2.0 * kRow * static_cast<double>(sensors),
                   "What was learned of the error of the Doppler, by direction, and its standard deviation");
  svg.rectangle({0.0, 0.0, svg.width(), svg.height()}, {.fill = theme.background});
  double top = kAbove;
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
    const window::ErrorByDirection learned = window::error_by_direction(calibration, sensor, kAzimuths, kElevations);
    const std::string name = sensors > 1 ? fmt::format(" of sensor {}", sensor) : "";
    for (const ShownField& shown : panels_of(learned, name)) {
      draw_field(svg, theme, {kBeside, top, width, kFieldHeight}, shown, calibration.shape.views[sensor]);
      top += kRow;
    }
  }
  return svg;
}

}  // namespace dynamic_icp::figures
