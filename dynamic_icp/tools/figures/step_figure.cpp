// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/step_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"
#include "dynamic_icp/tools/drawing/colour_map.hpp"
#include "dynamic_icp/tools/figures/ground_view.hpp"
#include "dynamic_icp/tools/figures/object_marks.hpp"
#include "dynamic_icp/tools/figures/point_thinning.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

namespace dynamic_icp::figures {
namespace {

using drawing::Pixel;
using runs::ObjectRow;
using runs::RunFiles;

constexpr double kScreenFigureWidth = 1120.0;  // px
constexpr double kMargin = 20.0;
constexpr double kPanelHead = 48.0;  // above each panel: title and legend
constexpr double kLowerHeight = 250.0;
constexpr std::size_t kMaxPanelDots = 5000;  // of a panel

constexpr std::size_t kMovingColour = 1;  // in the order of the theme: also "raw" and "target"
constexpr std::size_t kGoodColour = 2;    // "predicted", "source after alignment"

/// What is drawn of one object.
std::array<Eigen::Vector3d, 4> box_corners(const ObjectRow& object) {
  const ObjectRow::Box box =
      object.box.value_or(ObjectRow::Box{.centre = object.centroid, .size = object.extent, .yaw_rad = 0.0});
  const Eigen::Vector3d along(std::cos(box.yaw_rad), std::sin(box.yaw_rad), 0.0);
  const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
  const Eigen::Vector3d a = 0.5 * box.size.x() * along;
  const Eigen::Vector3d b = 0.5 * box.size.y() * across;
  return {box.centre + a + b, box.centre - a + b, box.centre - a - b, box.centre + a - b};
}

std::size_t largest_object(const std::vector<ObjectRow>& objects) {
  const auto largest = std::max_element(objects.begin(), objects.end(),
                                        [](const ObjectRow& a, const ObjectRow& b) { return a.points < b.points; });
  return static_cast<std::size_t>(largest - objects.begin());
}

GroundView panel(const drawing::PixelBox& box, Region region) {
  drawing::make_aspect_equal({0.0, 0.0, box.width, box.height}, region.x, region.y);
  return {box, region};
}

void include(Region& region, const Eigen::Vector3d& point, double margin_m) {
  region.x = {std::min(region.x.minimum, point.x() - margin_m), std::max(region.x.maximum, point.x() + margin_m)};
  region.y = {std::min(region.y.minimum, point.y() - margin_m), std::max(region.y.maximum, point.y() + margin_m)};
}

/// The sensor and the objects near enough to be seen well, of the whole scan some of the surroundings.
Region scene_region(const std::vector<ObjectRow>& objects) {
  constexpr double kFarthest_m = 45.0;
  Region region{{-3.0, 25.0}, {-8.0, 8.0}};
  for (const ObjectRow& object : objects) {
    for (const Eigen::Vector3d& c :
         {object.centroid, Eigen::Vector3d(object.centroid + kArrowSeconds * object.velocity)}) {
      if (c.allFinite() && c.norm() < kFarthest_m) {
        include(region, c, 3.0);
      }
    }
  }
  return region;
}

/// A picture that grows panel by panel.
class Sheet {
 public:
  Sheet(const drawing::Theme& theme, double width, double upper_height)
      : theme_(theme),
        svg_(width, 2.0 * kPanelHead + upper_height + kLowerHeight + kMargin,
             "The steps from a scan with Doppler to two aligned scans, from above") {
    svg_.rectangle({0.0, 0.0, svg_.width(), svg_.height()}, {.fill = theme.background}, 10.0);
  }

  void begin(const GroundView& view, const std::string& title, const std::vector<drawing::LegendEntry>& legend) {
    view_ = view;
    svg_.text({view.box.left, view.box.top - 26.0}, title, {.colour = theme_.ink, .size = 15.0, .bold = true});
    drawing::draw_legend(&svg_, theme_, {view.box.left, view.box.top - 8.0}, view.box.width, legend);
    svg_.rectangle(view.box, {.fill = theme_.panel}, 6.0);
    svg_.begin_clip(view.box);
  }
  void end() { svg_.end_clip(); }

  /// Dots of the points in sight, thinned to what a panel can show.
  void points(const std::vector<Eigen::Vector3d>& all, const std::string& colour, double diameter = 2.0) {
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& point : all) {
      if (view_.region.contains(point.x(), point.y())) {
        seen.push_back(point);
      }
    }
    std::vector<Pixel> dots;
    for (const std::uint32_t row : spread_rows(seen, kMaxPanelDots)) {
      dots.push_back(view_.at(seen[row]));
    }
    svg_.dots(dots, diameter, colour);
  }

  void sensor(const Eigen::Vector3d& velocity) {
    arrow(Eigen::Vector3d::Zero(), velocity, theme_.series[kGoodColour], 2.4);
    svg_.circle(view_.at(0.0, 0.0), 5.0, {.fill = theme_.series[kGoodColour], .stroke = theme_.panel, .width = 1.5});
  }

  void box(const ObjectRow& object) {
    std::vector<Pixel> corners;
    for (const Eigen::Vector3d& corner : box_corners(object)) {
      corners.push_back(view_.at(corner));
    }
    svg_.polygon(corners, {.stroke = theme_.ink, .width = 1.5});
  }

  void arrow(const Eigen::Vector3d& from, const Eigen::Vector3d& velocity, const std::string& colour, double width) {
    if (velocity.allFinite() && from.allFinite()) {
      svg_.arrow(view_.at(from), view_.at(from + kArrowSeconds * velocity), {.stroke = colour, .width = width});
    }
  }

  [[nodiscard]] const drawing::Svg& svg() const { return svg_; }

 private:
  const drawing::Theme& theme_;
  drawing::Svg svg_;
  GroundView view_;
};

/// The points for which `wanted(row)` holds.
template <class Wanted>
std::vector<Eigen::Vector3d> points_where(const ShownScan& scan, const Wanted& wanted) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (wanted(i)) {
      points.push_back(scan.points[i]);
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> moved(std::vector<Eigen::Vector3d> points, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3d& point : points) {
    point = T * point;
  }
  return points;
}

/// The points of the source as the method moves them to the time of the target: those of objects by their velocity.
std::vector<Eigen::Vector3d> predicted(const ShownScan& scan, const std::vector<ObjectRow>& objects, double dt_s) {
  std::vector<Eigen::Vector3d> points = scan.points;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.labels[i] >= kFirstObject) {
      points[i] += dt_s * objects[scan.labels[i] - std::size_t{kFirstObject}].velocity;
    }
  }
  return points;
}

void draw_doppler(Sheet& sheet, const GroundView& view, const RunFiles& run, const ScanPair& pair,
                  const drawing::Theme& theme) {
  constexpr double kLimit_mps = 15.0;
  const std::size_t bins = theme.doppler.size();
  sheet.begin(view, "1  Measured Doppler",
              {{"approaching", theme.doppler.front()},
               {"static", theme.doppler[bins / 2]},
               {"receding", theme.doppler.back()}});
  for (std::size_t bin = 0; bin < bins; ++bin) {
    sheet.points(points_where(pair.source_scan,
                              [&](std::size_t i) {
                                return drawing::diverging_bin(pair.source_scan.doppler[i], kLimit_mps, bins) == bin;
                              }),
                 theme.doppler[bin]);
  }
  sheet.sensor(run.frames[pair.source].ego_velocity);
  sheet.end();
}

void draw_filter(Sheet& sheet, const GroundView& view, const RunFiles& run, const ScanPair& pair,
                 const drawing::Theme& theme) {
  sheet.begin(view, "2  Velocity filter",
              {{"static", theme.doppler[theme.doppler.size() / 2]}, {"moving", theme.series[kMovingColour]}});
  const auto moves = [&](std::size_t i) { return pair.source_scan.labels[i] >= kDynamic; };
  sheet.points(points_where(pair.source_scan, [&](std::size_t i) { return !moves(i); }),
               theme.doppler[theme.doppler.size() / 2]);
  sheet.points(points_where(pair.source_scan, moves), theme.series[kMovingColour], 2.6);
  sheet.sensor(run.frames[pair.source].ego_velocity);
  sheet.end();
}

void draw_objects(Sheet& sheet, const GroundView& view, const RunFiles& run, const ScanPair& pair,
                  const drawing::Theme& theme) {
  const std::vector<ObjectRow>& objects = run.objects[pair.source];
  std::vector<drawing::LegendEntry> legend = {{"estimated velocity", theme.ink}};
  if (!pair.true_objects.empty()) {
    legend.push_back({"ground-truth velocity", theme.series[3]});
  }
  sheet.begin(view, "3  Objects and their velocities", legend);
  sheet.points(points_where(pair.source_scan, [&](std::size_t i) { return pair.source_scan.labels[i] < kDynamic; }),
               theme.doppler[theme.doppler.size() / 2]);
  for (const evaluation::TrueObject& object : pair.true_objects) {
    if (object.points > 0 && object.velocity.norm() > kMoving_mps) {
      sheet.arrow(object.center, object.velocity, theme.series[3], 5.0);
    }
  }
  for (std::size_t k = 0; k < objects.size(); ++k) {
    sheet.points(
        points_where(pair.source_scan, [&](std::size_t i) { return pair.source_scan.labels[i] == kFirstObject + k; }),
        theme.series[k % theme.series.size()], 2.6);
    sheet.box(objects[k]);
    sheet.arrow(objects[k].box ? objects[k].box->centre : objects[k].centroid, objects[k].velocity, theme.ink, 1.8);
  }
  sheet.sensor(run.frames[pair.source].ego_velocity);
  sheet.end();
}

/// What the lower panels show, in the frame of the target.
struct Lower {
  std::size_t focus = 0;  ///< the largest object of the source
  Eigen::Isometry3d T_target_source;
  std::vector<Eigen::Vector3d> predicted;  ///< the points of the source, still in its frame
};

/// The points of the largest object, as measured and where its velocity takes them, in the frame of the target.
struct Prediction {
  std::vector<Eigen::Vector3d> raw;
  std::vector<Eigen::Vector3d> predicted;
};

Prediction prediction_of(const ScanPair& pair, const Lower& lower) {
  Prediction object;
  for (std::size_t i = 0; i < lower.predicted.size(); ++i) {
    if (pair.source_scan.labels[i] == kFirstObject + lower.focus) {
      object.raw.emplace_back(lower.T_target_source * pair.source_scan.points[i]);
      object.predicted.emplace_back(lower.T_target_source * lower.predicted[i]);
    }
  }
  return object;
}

/// No more than the object: its surroundings are in the other panels.
Region close_up(const Prediction& object, const Eigen::Vector3d& middle) {
  constexpr double kMargin_m = 0.3;
  Region region{{middle.x(), middle.x()}, {middle.y(), middle.y()}};
  include(region, middle, kMargin_m);
  for (const std::vector<Eigen::Vector3d>* points : {&object.raw, &object.predicted}) {
    for (const Eigen::Vector3d& point : *points) {
      include(region, point, kMargin_m);
    }
  }
  return region;
}

void draw_prediction(Sheet& sheet, const GroundView& view, const Prediction& object, const ScanPair& pair,
                     const drawing::Theme& theme) {
  sheet.begin(
      view, "4  Prediction of the largest object",
      {{"raw", theme.series[kMovingColour]}, {"predicted", theme.series[kGoodColour]}, {"next scan", theme.muted}});
  sheet.points(
      points_where(pair.target_scan, [&](std::size_t i) { return pair.target_scan.labels[i] >= kFirstObject; }),
      theme.muted, 4.4);
  sheet.points(object.raw, theme.series[kMovingColour], 3.0);
  sheet.points(object.predicted, theme.series[kGoodColour], 3.0);
  sheet.end();
}

void draw_alignment(Sheet& sheet, const GroundView& view, const Lower& lower, const ScanPair& pair,
                    const drawing::Theme& theme) {
  sheet.begin(view, "5  Aligned scans",
              {{"target", theme.series[kMovingColour]}, {"source, predicted and aligned", theme.series[kGoodColour]}});
  sheet.points(pair.target_scan.points, theme.series[kMovingColour], 3.0);
  sheet.points(moved(lower.predicted, lower.T_target_source), theme.series[kGoodColour], 1.6);
  sheet.end();
}

}  // namespace

ScanPair read_pair(const RunFiles& run, const datasets::Dataset& recording, std::size_t source,
                   const Workers& workers) {
  if (source + 1 >= run.frames.size()) {
    throw UsageError(fmt::format("the pair begins with scan {}: the run has no scan after it, expected 0 to {}", source,
                                 std::max<std::size_t>(run.frames.size(), 2) - 2));
  }
  ScanPair pair{.source = source, .source_scan = {}, .target_scan = {}, .true_objects = {}};
  pair.source_scan = show_scan(run, source, read_scan(run, recording, source), workers);
  pair.target_scan = show_scan(run, source + 1, read_scan(run, recording, source + 1), workers);
  const std::filesystem::path truth = std::filesystem::path(runs::text_of(run.run, "input.path")) / "objects.jsonl";
  if (std::filesystem::exists(truth)) {
    for (evaluation::TrueObjects& scan : evaluation::read_true_objects(truth)) {
      if (scan.index == static_cast<std::int64_t>(run.frames[source].index)) {
        pair.true_objects = std::move(scan.objects);
      }
    }
  }
  return pair;
}

drawing::Svg step_figure(const RunFiles& run, const ScanPair& pair, const drawing::Theme& theme, Medium medium) {
  const double width = medium == Medium::kPaper ? kTextWidth : kScreenFigureWidth;
  const std::vector<ObjectRow>& objects = run.objects[pair.source];
  const double upper_width = (width - 4.0 * kMargin) / 3.0;
  const Region scene = scene_region(objects);
  const double upper_height = std::clamp(upper_width * scene.y.length() / scene.x.length(), 180.0, 340.0);
  Sheet sheet(theme, width, upper_height);
  const auto upper = [&](int column) {
    return panel({kMargin + column * (upper_width + kMargin), kPanelHead, upper_width, upper_height}, scene);
  };
  draw_doppler(sheet, upper(0), run, pair, theme);
  draw_filter(sheet, upper(1), run, pair, theme);
  draw_objects(sheet, upper(2), run, pair, theme);

  const double dt_s = run.seconds(pair.source + 1) - run.seconds(pair.source);
  const Lower lower{.focus = largest_object(objects),
                    .T_target_source = run.trajectory[pair.source + 1].T_world_sensor.inverse() *
                                       run.trajectory[pair.source].T_world_sensor,
                    .predicted = predicted(pair.source_scan, objects, dt_s)};
  Eigen::Vector3d middle(12.0, 0.0, 0.0);
  if (lower.focus < objects.size()) {
    middle = lower.T_target_source * objects[lower.focus].centroid;
  }
  const double lower_width = (width - 3.0 * kMargin) / 2.0;
  const double lower_top = 2.0 * kPanelHead + upper_height;
  const auto lower_view = [&](int column, const Region& region) {
    return panel({kMargin + column * (lower_width + kMargin), lower_top, lower_width, kLowerHeight}, region);
  };
  const Prediction object = prediction_of(pair, lower);
  draw_prediction(sheet, lower_view(0, close_up(object, middle)), object, pair, theme);
  constexpr double kAround_m = 14.0;
  const Region around{{middle.x() - kAround_m, middle.x() + kAround_m}, {middle.y(), middle.y()}};
  draw_alignment(sheet, lower_view(1, around), lower, pair, theme);
  return sheet.svg();
}

}  // namespace dynamic_icp::figures
