// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/object_marks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/tools/drawing/label_places.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr std::size_t kMaxNamed = 16;  // more labels would hide the scene

/// An object with its place in the picture.
struct Mark {
  runs::ObjectRow object;
  drawing::PixelBox box;
  drawing::Pixel middle;
  drawing::Pixel tip;  ///< where the middle will be after kArrowSeconds
};

/// Those in the region, the ones with most points first.
std::vector<Mark> marks_of(const GroundView& ground, const ScanView& view, const std::vector<double>& compensated) {
  constexpr double kBorder = 3.0;  // px between points and box
  std::vector<Mark> marks;
  for (const runs::ObjectRow& object : view.objects) {
    const Region box = footprint(view, rows_on_object(view, compensated, object), object);
    const Eigen::Vector3d middle = box.middle();
    if (!middle.allFinite() || !ground.region.contains(middle.x(), middle.y())) {
      continue;
    }
    const drawing::Pixel corner = ground.at(box.x.minimum, box.y.maximum);
    marks.push_back(
        {.object = object,
         .box = {corner.x - kBorder, corner.y - kBorder, box.x.length() * ground.pixels_per_metre() + 2.0 * kBorder,
                 box.y.length() * ground.pixels_per_metre() + 2.0 * kBorder},
         .middle = ground.at(middle),
         .tip = ground.at(middle + kArrowSeconds * object.velocity)});
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.object.points > b.object.points; });
  return marks;
}

std::string speed_text(const Eigen::Vector3d& velocity) {
  const double speed = velocity.norm();
  return std::isfinite(speed) ? fmt::format("{:.1f} m/s", speed) : "speed unknown";
}

std::string description_of(const runs::ObjectRow& object) {
  const Eigen::Vector3d& v = object.velocity;
  const std::string velocity = v.allFinite()
                                   ? fmt::format("({}, {}, {}) m/s over ground", drawing::compact_number(v.x()),
                                                 drawing::compact_number(v.y()), drawing::compact_number(v.z()))
                                   : "velocity unknown";
  return fmt::format("object {}: {} points, {}", object.id, drawing::compact_number(object.points, 0), velocity);
}

/// Of its mark, its arrow and its label, which may stand near another thing.
const std::string& sensor_colour(const drawing::Theme& theme) { return theme.series[2]; }

}  // namespace

void draw_sensor(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground,
                 const Eigen::Vector3d& ego_velocity) {
  const drawing::Pixel origin = ground.at(0.0, 0.0);
  const std::string& colour = sensor_colour(theme);
  svg.arrow(origin, ground.at(kArrowSeconds * ego_velocity), {.stroke = colour, .width = 3.0});
  svg.circle(origin, 6.0, {.fill = colour, .stroke = theme.panel, .width = 2.0, .title = "sensor"});
}

void draw_object_marks(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground, const ScanView& view,
                       const std::vector<double>& compensated) {
  const std::vector<Mark> marks = marks_of(ground, view, compensated);
  const drawing::Pixel origin = ground.at(0.0, 0.0);
  drawing::LabelPlaces places(ground.box);
  places.block_line(origin, ground.at(kArrowSeconds * view.ego_velocity));
  const std::string& colour = theme.series[3];
  for (const Mark& mark : marks) {
    svg.rectangle(mark.box, {.stroke = colour, .width = 1.8, .title = description_of(mark.object)}, 3.0);
    svg.arrow(mark.middle, mark.tip, {.stroke = colour, .width = 2.2});
    places.block(mark.box);
    places.block_line(mark.middle, mark.tip);
  }
  drawing::TextStyle style{.colour = sensor_colour(theme), .size = 13.0, .bold = true, .halo = theme.panel};
  const std::string own = "sensor · " + speed_text(view.ego_velocity);
  svg.text(places.place({origin.x - 6.0, origin.y - 6.0, 12.0, 12.0}, own, style.size), own, style);
  style.colour = theme.ink;
  for (std::size_t k = 0; k < std::min(marks.size(), kMaxNamed); ++k) {
    const std::string text = fmt::format("{} · {}", marks[k].object.id, speed_text(marks[k].object.velocity));
    svg.text(places.place(marks[k].box, text, style.size), text, style);
  }
}

}  // namespace dynamic_icp::figures
