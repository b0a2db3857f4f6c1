// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/object_figure.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/figures/ground_view.hpp"
#include "dynamic_icp/tools/figures/point_thinning.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

namespace dynamic_icp::figures {
namespace {

using evaluation::Body;
using evaluation::BodyPair;

constexpr drawing::PixelBox kObjectPanel{20.0, 76.0, 860.0, 560.0};
constexpr double kArrowOfObject_s = 0.5;
constexpr double kAroundObject_m = 5.0;
constexpr std::size_t kMaxObjectDots = 6000;
constexpr std::size_t kTrueBodyColour = 2;  // in the order of the theme
constexpr std::size_t kReportedBodyColour = 1;

/// Both boxes with their arrows and some metres around them.
GroundView view_of(const BodyPair& pair) {
  const Eigen::Vector3d middle = pair.truth.box.T_sensor_box.translation();
  Region region{{middle.x(), middle.x()}, {middle.y(), middle.y()}};
  const auto include = [&](const Eigen::Vector3d& at, double around_m) {
    region.x = {std::min(region.x.minimum, at.x() - around_m), std::max(region.x.maximum, at.x() + around_m)};
    region.y = {std::min(region.y.minimum, at.y() - around_m), std::max(region.y.maximum, at.y() + around_m)};
  };
  for (const Body* body : {&pair.truth, &pair.reported}) {
    const Eigen::Vector3d center = body->box.T_sensor_box.translation();
    include(center, 0.5 * body->box.size.head<2>().norm() + 1.0);
    include(center + kArrowOfObject_s * body->velocity, 1.0);
  }
  include(middle, kAroundObject_m);
  drawing::make_aspect_equal({0.0, 0.0, kObjectPanel.width, kObjectPanel.height}, region.x, region.y);
  return {kObjectPanel, region};
}

void draw_points_around(drawing::Svg& svg, const GroundView& view, const ShownScan& scan, const drawing::Theme& theme) {
  for (const bool on_objects : {false, true}) {
    std::vector<Eigen::Vector3d> seen;
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const Eigen::Vector3d& point = scan.points[k];
      if ((scan.labels[k] >= kFirstObject) == on_objects && view.region.contains(point.x(), point.y())) {
        seen.push_back(point);
      }
    }
    std::vector<drawing::Pixel> dots;
    for (const std::uint32_t row : spread_rows(seen, kMaxObjectDots)) {
      dots.push_back(view.at(seen[row]));
    }
    svg.dots(dots, on_objects ? 3.0 : 2.0, on_objects ? theme.ink : theme.muted);
  }
}

void draw_body(drawing::Svg& svg, const GroundView& view, const Body& body, const drawing::Paint& paint) {
  std::vector<drawing::Pixel> corners;
  for (const auto& [x, y] : {std::pair(0.5, 0.5), {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}) {
    corners.push_back(view.at(body.box.T_sensor_box * body.box.size.cwiseProduct(Eigen::Vector3d(x, y, 0.0))));
  }
  svg.polygon(corners, paint);
  const Eigen::Vector3d center = body.box.T_sensor_box.translation();
  svg.arrow(view.at(center), view.at(center + kArrowOfObject_s * body.velocity),
            {.stroke = paint.stroke, .width = paint.width});
}

/// How long some metres are, in the lower left corner.
void draw_scale(drawing::Svg& svg, const GroundView& view, const drawing::Theme& theme) {
  constexpr double kScale_m = 5.0;
  const drawing::Pixel left{view.box.left + 16.0, view.box.bottom() - 16.0};
  svg.line(left, {left.x + kScale_m * view.pixels_per_metre(), left.y}, {.stroke = theme.ink, .width = 2.0});
  svg.text({left.x, left.y - 6.0}, fmt::format("{:g} m; arrows: the way in {:g} s", kScale_m, kArrowOfObject_s),
           {.colour = theme.ink, .halo = theme.panel});
}

}  // namespace

drawing::Svg object_figure(const BodyPair& pair, const ShownScan& scan, const drawing::Theme& theme) {
  drawing::Svg svg(kObjectPanel.right() + kObjectPanel.left, kObjectPanel.bottom() + 20.0,
                   "A moving body and what is reported of it, from above");
  svg.rectangle({0.0, 0.0, svg.width(), svg.height()}, {.fill = theme.background}, 10.0);
  const Eigen::Vector3d center = pair.truth.box.T_sensor_box.translation();
  const Eigen::Vector3d center_error = pair.reported.box.T_sensor_box.translation() - center;
  const Eigen::Vector3d size_error = pair.reported.box.size - pair.truth.box.size;
  svg.text({kObjectPanel.left, 28.0},
           fmt::format("Scan {} · body {}, object {} · overlap {:.2f} · {:.0f} m away, {} points", pair.scan,
                       pair.truth.id, pair.reported.id, pair.overlap, center.norm(), pair.truth.points),
           {.colour = theme.ink, .size = 16.0, .bold = true});
  svg.text(
      {kObjectPanel.left, 48.0},
      fmt::format("errors: centre {:.2f} m · length {:+.2f} m, width {:+.2f} m, height {:+.2f} m · velocity {:.2f} "
                  "m/s",
                  center_error.norm(), size_error.x(), size_error.y(), size_error.z(),
                  (pair.reported.velocity - pair.truth.velocity).norm()),
      {.colour = theme.ink});
  const drawing::LegendEntry legend[] = {{"truth", theme.series[kTrueBodyColour]},
                                         {"reported", theme.series[kReportedBodyColour]},
                                         {"points on objects", theme.ink},
                                         {"other points", theme.muted},
                                         {"to the sensor", theme.grid}};
  drawing::draw_legend(&svg, theme, {kObjectPanel.left, 68.0}, kObjectPanel.width, legend);
  svg.rectangle(kObjectPanel, {.fill = theme.panel}, 6.0);
  svg.begin_clip(kObjectPanel);
  const GroundView view = view_of(pair);
  svg.line(view.at(center), view.at(0.0, 0.0), {.stroke = theme.grid, .width = 2.0});
  draw_points_around(svg, view, scan, theme);
  draw_body(svg, view, pair.truth, {.stroke = theme.series[kTrueBodyColour], .width = 2.5});
  draw_body(svg, view, pair.reported, {.stroke = theme.series[kReportedBodyColour], .width = 2.5, .dash = "7 4"});
  draw_scale(svg, view, theme);
  svg.end_clip();
  return svg;
}

std::vector<Figure> draw_worst_objects(const runs::RunFiles& run, std::size_t count, const drawing::Theme& theme) {
  const std::filesystem::path input = runs::text_of(run.run, "input.path");
  const std::vector<evaluation::ScanBodies> truth = evaluation::read_true_bodies(input / "objects.jsonl");
  const auto pairs =
      evaluation::compare_tracks(truth, evaluation::read_reported_bodies(run.folder / "objects.jsonl")).pairs;
  std::vector<std::string> notes;
  const std::unique_ptr<datasets::Dataset> recording = open_recording(run, notes);
  if (recording == nullptr) {
    throw DataError(notes.back());
  }
  std::vector<Figure> figures;
  for (const BodyPair& pair : evaluation::worst_pairs(pairs, count)) {
    const auto frame = std::ranges::find(run.frames, static_cast<std::size_t>(pair.scan), &runs::FrameRow::index);
    if (frame == run.frames.end()) {
      throw DataError(
          fmt::format("{}: scan {} is not in frames.jsonl", (run.folder / "objects.jsonl").string(), pair.scan));
    }
    const auto row = static_cast<std::size_t>(frame - run.frames.begin());
    const ShownScan scan = show_scan(run, row, read_scan(run, *recording, row), Workers());
    figures.push_back({fmt::format("worst_object_{}", figures.size() + 1), object_figure(pair, scan, theme)});
  }
  return figures;
}

}  // namespace dynamic_icp::figures
