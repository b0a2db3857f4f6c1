// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/recording/datasets/likely_doppler.hpp"
#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kClearlyFlat = 0.5;  // spread of the flat axis over that of the z axis
constexpr double kFlat = 0.35;
constexpr double kLooksAhead = 0.4;  // length of the mean line of sight
constexpr double kAlongAxis = 0.9;   // cosine
constexpr double kUnexplained_mps = 0.25;
constexpr double kMuchBetter = 0.6;  // residual with spherical coordinates over that with the columns as they are

constexpr double kSpeaksAgainst =
    2.5;  // spherical coordinates, where they explain the Doppler so much worse than x, y, z
constexpr double kPointsForExtent = 20.0;  // a scan; the extent of fewer says nothing

struct View {
  double points = 0.0;
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();
  Eigen::Vector3d looks = Eigen::Vector3d::Zero();
  Eigen::Vector3d moves = Eigen::Vector3d::Zero();
};

/// Means over the looks, with the remaining columns as x, y, z in their order.
View mean_view(const Evidence& evidence) {
  View view;
  const double count = std::max(1.0, static_cast<double>(evidence.looks.size()));
  for (const ScanLook& look : evidence.looks) {
    view.points += static_cast<double>(look.points) / count;
    view.spread += look.look_spread / count;
    view.looks += look.look_direction / count;
    if (look.has_velocity()) {
      view.moves += look.ego.velocity_sensor / count;
    }
  }
  return view;
}

/// The axis that is up: z, but where another one is clearly flatter than z.
int up_axis(const View& view) {
  int flattest = 2;
  view.spread.minCoeff(&flattest);
  const bool is_unambiguous = view.points >= kPointsForExtent && view.spread[flattest] < kFlat &&
                              view.spread[flattest] < kClearlyFlat * view.spread[2];
  return is_unambiguous ? flattest : 2;
}

/// The axis along which the sensor both looks and moves; nothing where there is none.
std::optional<int> forward_axis(const View& view, int up) {
  if (view.looks.norm() < kLooksAhead || view.moves.norm() < kMoves_mps) {
    return std::nullopt;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != up && std::abs(view.looks.normalized()[axis]) > kAlongAxis &&
        std::abs(view.moves.normalized()[axis]) > kAlongAxis) {
      return axis;
    }
  }
  return std::nullopt;
}

/// The name of the column that may be the Doppler instead (Finding::doppler_column), by a scan in the middle.
std::string other_doppler_column(const Evidence& evidence) {
  constexpr std::string_view kFormats[] = {"npz", "pcd", "ply", "csv", "rosbag", "rosbag2", "mcap"};
  const datasets::Dataset& dataset = *evidence.dataset;
  if (std::ranges::find(kFormats, dataset.format()) == std::end(kFormats)) {
    return {};
  }
  const std::size_t middle = evidence.begin + (evidence.end - evidence.begin) / 2;
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (datasets::PointColumn& column : dataset.columns(middle)) {
    if (!column.is_integer) {
      names.push_back(std::move(column.name));
      columns.push_back(std::move(column.values));
    }
  }
  if (names.empty()) {
    return {};
  }
  const std::optional<std::size_t> likely = datasets::likely_doppler(dataset.scan(middle).points, columns);
  return likely ? names[*likely] : "COLUMN";
}

std::string_view unit_of(const SphericalColumns& spherical) {
  return spherical.coordinates == datasets::Coordinates::kSphericalDegrees ? "degrees" : "radians";
}

/// Which of the columns as read are azimuth, elevation, range and Doppler.
std::array<int, 4> as_read(const SphericalColumns& spherical, const Evidence& evidence) {
  const std::array<int, 4> applied = evidence.applied.columns.value_or(datasets::Correction::kInOrder);
  const std::array<int, 3>& found = spherical.columns;
  std::array<int, 4> read = {found[0], found[1], found[2], 3};
  for (int& column : read) {
    column = applied.at(static_cast<std::size_t>(column));
  }
  return read;
}

/// Which of the columns as read are x, y, z and Doppler. Without an axis ahead x and y keep their order.
std::array<int, 4> order_as_read(const Evidence& evidence, int up, std::optional<int> forward) {
  const int ahead = forward.value_or(up == 0 ? 1 : 0);
  const std::array<int, 4> looked_at = with_doppler_last(evidence.columns.doppler);
  const std::array<int, 4> applied = evidence.applied.columns.value_or(datasets::Correction::kInOrder);
  std::array<int, 4> read = {ahead, 3 - ahead - up, up, 3};
  for (int& column : read) {
    column = applied.at(static_cast<std::size_t>(looked_at.at(static_cast<std::size_t>(column))));
  }
  return read;
}

}  // namespace

Finding columns(const Evidence& evidence) {
  Finding finding{Question::kColumns, Verdict::kOk, ""};
  const View view = mean_view(evidence);
  const int up = up_axis(view);
  const std::optional<int> forward = forward_axis(view, up);
  const ColumnScores& scores = evidence.columns;
  finding.evidence = {{"residual_of_column_1_mps", scores.residual[0]},
                      {"residual_of_column_2_mps", scores.residual[1]},
                      {"residual_of_column_3_mps", scores.residual[2]},
                      {"residual_of_column_4_mps", scores.residual[3]},
                      {"residual_of_spherical_mps", scores.likely_spherical ? scores.likely_spherical->residual : 0.0},
                      {"spread_x", view.spread.x()},
                      {"spread_y", view.spread.y()},
                      {"spread_z", view.spread.z()}};
  const std::array<int, 4> order = order_as_read(evidence, up, forward);
  if (evidence.looks.empty()) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = "there are no scans";
  } else if (scores.spherical) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format(
        "the points are spherical coordinates: with azimuth and elevation in {} and range a velocity explains the "
        "Doppler to {:.2f} m/s, with x, y, z only to {:.2f}",
        unit_of(*scores.spherical), scores.spherical->residual, scores.residual[3]);
    finding.fix.columns = as_read(*scores.spherical, evidence);
    finding.fix.coordinates = scores.spherical->coordinates;
  } else if (scores.surfaces && scores.surfaces->residual < kSpeaksAgainst * scores.residual[3]) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "the points look like spherical coordinates: taken as azimuth and elevation in {} with a range, "
        "neighbours are equally far, as on surfaces; the Doppler, of a sensor at rest or in traffic, does not tell",
        unit_of(*scores.surfaces));
    finding.fix.columns = as_read(*scores.surfaces, evidence);
    finding.fix.coordinates = scores.surfaces->coordinates;
  } else if (scores.doppler != 3) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format(
        "column {} is the Doppler: a velocity explains it to {:.2f} m/s, the last column only to {:.2f}",
        scores.doppler + 1, scores.residual.at(static_cast<std::size_t>(scores.doppler)), scores.residual[3]);
    finding.fix.columns = order;
  } else if (const std::optional<NoDoppler> none = no_doppler(evidence); none && !none->is_zero) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = "the column taken for the Doppler is none: " + none->sentence;
    finding.needs_doppler_column = true;
    finding.doppler_column = other_doppler_column(evidence);
    finding.evidence.insert(finding.evidence.end(), none->evidence.begin(), none->evidence.end());
  } else if (scores.likely_doppler != 3) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "column {} may be the Doppler: a velocity explains it to {:.2f} m/s and the last column to {:.2f}, neither "
        "well; if so, state the order of the columns",
        scores.likely_doppler + 1, scores.residual.at(static_cast<std::size_t>(scores.likely_doppler)),
        scores.residual[3]);
  } else if (const auto& spherical = scores.likely_spherical;
             up != 2 && spherical && spherical->residual < kMuchBetter * scores.residual[3]) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "the points may be spherical coordinates: with azimuth and elevation in {} and range a velocity explains the "
        "Doppler to {:.2f} m/s, with x, y, z to {:.2f}; or another column than the third is up and down",
        unit_of(*spherical), spherical->residual, scores.residual[3]);
    finding.fix.columns = as_read(*spherical, evidence);
    finding.fix.coordinates = spherical->coordinates;
  } else if (up != 2) {
    finding.verdict = Verdict::kWrong;
    finding.sentence =
        fmt::format("column {} is up and down: the sensor sees least along it; or the sensor lies on its side", up + 1);
    finding.fix.columns = order;
  } else if (forward && *forward == 1) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence =
        "the sensor looks and moves along y: x and y may have changed places, or the axes are not x ahead, y left";
    finding.fix.columns = order;
  } else if (scores.residual[3] > kUnexplained_mps) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = fmt::format(
        "a velocity explains no column well, the last one to {:.2f} m/s: most of what is seen moves, or the columns "
        "are in another order",
        scores.residual[3]);
  } else {
    finding.sentence = "x, y, z, Doppler";
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
