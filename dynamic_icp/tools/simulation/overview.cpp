// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/overview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/simulation/bird_view.hpp"
#include "dynamic_icp/tools/simulation/sensor_view.hpp"

namespace dynamic_icp::simulation {
namespace {

using drawing::Pixel;
using drawing::PixelBox;
using drawing::Rgb;
using Eigen::Vector2d;

constexpr double kMargin = 20.0;  // px
constexpr double kWidth = 900.0;
constexpr double kTitle = 26.0;
constexpr double kGap = 16.0;
constexpr double kPanelWidth = kWidth - 2.0 * kMargin;
constexpr std::size_t kBirdColumns = 645;    // pixels of the raster from above
constexpr std::size_t kSensorColumns = 430;  // of the scan
constexpr double kAround = 30.0;             // m beside the way
constexpr double kAhead = 40.0;              // m around the vehicle at this scan
constexpr double kArrowSeconds = 1.0;

Vector2d planar(const Eigen::Isometry3d& T) { return T.translation().head<2>(); }

/// The place of the picture from above: the ground around the drive, in a shape that suits a page.
struct BirdPanel {
  PixelBox box;
  Eigen::AlignedBox2d region;

  BirdPanel(const Simulation& simulation, double now_s, double top) {
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      region.extend(planar(simulation.scene().vehicle(seconds_between(Stamp{}, simulation.stamp(i))).T_world_body));
    }
    region.min().array() -= kAround;
    region.max().array() += kAround;
    const Vector2d here = planar(simulation.scene().vehicle(now_s).T_world_body);
    region.extend(Vector2d(here.array() - kAhead)).extend(Vector2d(here.array() + kAhead));
    const double wanted = std::clamp(region.sizes().y() / region.sizes().x(), 0.35, 0.6);
    const double width = std::max(region.sizes().x(), region.sizes().y() / wanted);
    const Vector2d half = 0.5 * width * Vector2d(1.0, wanted);
    const Vector2d center = region.center();
    region = Eigen::AlignedBox2d(center - half, center + half);
    box = {kMargin, top, kPanelWidth, kPanelWidth * wanted};
  }

  [[nodiscard]] double pixels_per_metre() const { return box.width / region.sizes().x(); }
  [[nodiscard]] Pixel at(const Vector2d& p) const {
    return {box.left + (p.x() - region.min().x()) * pixels_per_metre(),
            box.top + (region.max().y() - p.y()) * pixels_per_metre()};
  }
};

/// The colour of a body: the same in all panels.
const std::string& body_colour(const drawing::Theme& theme, std::int32_t id) {
  return theme.series[static_cast<std::size_t>(id) % (theme.series.size() - 1)];
}

/// The outline of a box seen from above.
std::array<Vector2d, 4> outline(const Eigen::Isometry3d& T_world_body, const Eigen::AlignedBox3d& box) {
  const auto corner = [&](double x, double y) {
    return Vector2d((T_world_body * Eigen::Vector3d(x, y, 0.0)).head<2>());
  };
  return {corner(box.min().x(), box.min().y()), corner(box.max().x(), box.min().y()),
          corner(box.max().x(), box.max().y()), corner(box.min().x(), box.max().y())};
}

void draw_outline(drawing::Svg& svg, const BirdPanel& panel, const Eigen::Isometry3d& T_world_body,
                  const Eigen::AlignedBox3d& box, const drawing::Paint& paint) {
  std::vector<Pixel> pixels;
  for (const Vector2d& corner : outline(T_world_body, box)) {
    pixels.push_back(panel.at(corner));
  }
  svg.polygon(pixels, paint);
}

void draw_fields_of_view(drawing::Svg& svg, const BirdPanel& panel, const Simulation& simulation, double now_s,
                         const drawing::Theme& theme) {
  constexpr double kShown = 40.0;  // m
  for (std::size_t i = 0; i < simulation.config().rig.sensors.size(); ++i) {
    const Eigen::Isometry3d T = simulation.sensor_state(now_s, i).T_world_sensor;
    const double half = simulation.config().rig.sensors[i].lidar.horizontal_fov_deg * std::numbers::pi / 360.0;
    std::vector<Pixel> fan = {panel.at(planar(T))};
    constexpr int kSteps = 48;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = half * (1.0 - 2.0 * k / kSteps);
      fan.push_back(panel.at((T * (kShown * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0))).head<2>()));
    }
    svg.polygon(fan, {.fill = theme.series.front(), .opacity = 0.12});
  }
}

void draw_bodies(drawing::Svg& svg, const BirdPanel& panel, const world::World& world, double now_s,
                 const drawing::Theme& theme) {
  for (const world::MovingBody& body : world.bodies) {
    const world::MotionState motion = body.trajectory(now_s);
    const Vector2d here = planar(motion.T_world_body);
    if (!panel.region.contains(here)) {
      continue;
    }
    const std::string& colour = body_colour(theme, body.id);
    draw_outline(svg, panel, motion.T_world_body, world.shapes[body.shape].box,
                 {.fill = colour, .stroke = colour, .width = 2.5, .title = body.name});
    const Vector2d there = here + kArrowSeconds * motion.velocity_world.head<2>();
    if ((there - here).norm() > 0.5) {
      svg.arrow(panel.at(here), panel.at(there), {.stroke = colour, .width = 1.5});
    }
  }
}

void draw_drive(drawing::Svg& svg, const BirdPanel& panel, const Simulation& simulation, double now_s,
                const drawing::Theme& theme) {
  std::vector<Pixel> way;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    way.push_back(
        panel.at(planar(simulation.scene().vehicle(seconds_between(Stamp{}, simulation.stamp(i))).T_world_body)));
  }
  svg.polyline(way, {.stroke = theme.ink, .width = 1.5, .dash = "5 4"});
  const Eigen::AlignedBox3d car(Eigen::Vector3d(-2.2, -0.9, 0.0), Eigen::Vector3d(2.2, 0.9, 1.5));
  draw_outline(svg, panel, simulation.scene().vehicle(now_s).T_world_body, car,
               {.fill = theme.ink, .stroke = theme.background, .width = 1.0});
}

void draw_scale(drawing::Svg& svg, const BirdPanel& panel, const drawing::Theme& theme) {
  constexpr double kLength = 20.0;  // m
  const Pixel right{panel.box.right() - 14.0, panel.box.bottom() - 14.0};
  const Pixel left{right.x - kLength * panel.pixels_per_metre(), right.y};
  svg.line(left, right, {.stroke = theme.ink, .width = 3.0});
  svg.text({0.5 * (left.x + right.x), left.y - 7.0}, "20 m",
           {.colour = theme.ink, .size = 12.0, .anchor = drawing::Anchor::kMiddle, .halo = theme.panel});
}

/// A quantity of the scan and how it is coloured.
struct Quantity {
  std::string title;
  std::function<Rgb(std::size_t)> colour_of;
  std::string low;  ///< text at the left end of the scale; empty: no scale
  std::string high;
  std::function<Rgb(double)> scale;  ///< colour at 0 to 1
};

double highest(const std::vector<double>& values, double share) {
  std::vector<double> sorted = values;
  if (sorted.empty()) {
    return 1.0;
  }
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end());
  return std::max(1.0, sorted[static_cast<std::size_t>(place)]);
}

std::vector<Quantity> quantities(const SimulatedFrame& frame, const drawing::Theme& theme, drawing::Ground ground) {
  const SimulatedScan& scan = frame.scan;
  std::vector<double> ranges;
  std::vector<double> speeds;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    ranges.push_back(scan.measured.points[i].norm());
    speeds.push_back(std::abs(scan.measured.doppler[i]));
  }
  const double near = std::log(2.0);
  const double far = std::log(std::max(4.0, highest(ranges, 0.995)));
  const double limit = std::ceil(highest(speeds, 0.99));
  const Rgb still = drawing::mix(drawing::rgb(theme.panel), drawing::rgb(theme.ink), 0.22);
  std::vector<Quantity> list;
  list.push_back(
      {"range", [=](std::size_t i) { return drawing::sequential_colour((std::log(ranges[i]) - near) / (far - near)); },
       "2 m", fmt::format("{:.0f} m", std::exp(far)), drawing::sequential_colour});
  list.push_back({"Doppler",
                  [&scan, ground, limit](std::size_t i) {
                    return drawing::diverging_colour(scan.measured.doppler[i] / limit, ground);
                  },
                  fmt::format("-{:.0f} m/s", limit), fmt::format("+{:.0f} m/s", limit),
                  [ground](double share) { return drawing::diverging_colour(2.0 * share - 1.0, ground); }});
  list.push_back({"body",
                  [&scan, &theme, still](std::size_t i) {
                    const std::int32_t id = scan.bodies[i];
                    return id > 0 ? drawing::rgb(body_colour(theme, id)) : still;
                  },
                  "",
                  "",
                  {}});
  return list;
}

void draw_title(drawing::Svg& svg, const drawing::Theme& theme, double baseline, const std::string& text) {
  svg.text({kMargin, baseline}, text, {.colour = theme.ink, .size = 14.0, .bold = true});
}

void draw_colour_scale(drawing::Svg& svg, const drawing::Theme& theme, double baseline, const Quantity& quantity) {
  constexpr double kScaleWidth = 120.0;
  constexpr std::size_t kSteps = 60;
  drawing::Raster ramp(kSteps, 1, {});
  for (std::size_t i = 0; i < kSteps; ++i) {
    ramp.set(i, 0, quantity.scale((static_cast<double>(i) + 0.5) / kSteps));
  }
  const double right = kWidth - kMargin - drawing::estimated_width(quantity.high, 12.0) - 6.0;
  svg.image({right - kScaleWidth, baseline - 10.0, kScaleWidth, 10.0}, ramp);
  svg.text({right + 6.0, baseline}, quantity.high, {.colour = theme.muted, .size = 12.0});
  svg.text({right - kScaleWidth - 6.0, baseline}, quantity.low,
           {.colour = theme.muted, .size = 12.0, .anchor = drawing::Anchor::kEnd});
}

}  // namespace

std::string draw_overview(const Simulation& simulation, const SimulatedFrame& frame, drawing::Ground ground,
                          const Workers& workers) {
  const drawing::Theme theme = drawing::theme(ground);
  const double now_s = seconds_between(Stamp{}, frame.scan.measured.stamp);
  const SensorConfig& sensor = simulation.config().rig.sensors.front();
  const BirdPanel bird(simulation, now_s, kMargin + kTitle);
  const double wide_enough = std::clamp(sensor.lidar.vertical_fov_deg / sensor.lidar.horizontal_fov_deg, 0.1, 0.5);
  const double strip = kPanelWidth * wide_enough;
  const double height = bird.box.bottom() + 3.0 * (kGap + kTitle + strip) + kMargin;

  drawing::Svg svg(
      kWidth, height,
      fmt::format("The scene {} from above and one scan of it by range, Doppler and body", simulation.kind().name));
  svg.rectangle({0.0, 0.0, kWidth, height}, {.fill = theme.background});
  draw_title(svg, theme, kMargin + 12.0,
             fmt::format("{}, seed {}, scan {} at {:.1f} s", simulation.kind().name, simulation.config().scene.seed,
                         frame.index + 1, now_s));
  const auto rows = static_cast<std::size_t>(static_cast<double>(kBirdColumns) * bird.box.height / bird.box.width);
  svg.image(bird.box,
            bird_view(simulation.scene().world, simulation.caster(), bird.region, kBirdColumns, rows, theme, workers));
  svg.begin_clip(bird.box);
  draw_fields_of_view(svg, bird, simulation, now_s, theme);
  draw_bodies(svg, bird, simulation.scene().world, now_s, theme);
  draw_drive(svg, bird, simulation, now_s, theme);
  draw_scale(svg, bird, theme);
  svg.end_clip();

  double top = bird.box.bottom() + kGap;
  for (const Quantity& quantity : quantities(frame, theme, ground)) {
    draw_title(svg, theme, top + 16.0, fmt::format("{} seen by {}", quantity.title, sensor.name));
    if (quantity.scale) {
      draw_colour_scale(svg, theme, top + 16.0, quantity);
    }
    svg.image({kMargin, top + kTitle, kPanelWidth, strip},
              sensor_view(sensor.lidar, frame.scan, kSensorColumns, drawing::rgb(theme.panel), quantity.colour_of));
    top += kTitle + strip + kGap;
  }
  return svg.document();
}

}  // namespace dynamic_icp::simulation
