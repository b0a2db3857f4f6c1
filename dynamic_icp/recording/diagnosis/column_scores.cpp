// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/column_scores.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/recording/diagnosis/range_surfaces.hpp"
#include "dynamic_icp/recording/diagnosis/scan_look.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr std::size_t kMaxPoints = 30000;
constexpr std::ptrdiff_t kMinPointsToTell = 20;
constexpr double kFarthest_m = 1000.0;
constexpr double kFarthestInCentimetres = 3e4;  // beyond, they are millimetres
constexpr double kNearest_m = 0.5;
constexpr double kFastest_mps = 150.0;
constexpr double kFastestInCentimetres = 3000.0;

// A column is called the Doppler only where it is explained this well, and the one in its place this much worse.
constexpr double kStaticShare = 0.3;  // more than half of the points may be traffic
constexpr double kGoodResidual_mps = 0.15;
constexpr double kTimesWorse = 2.5;

/// A ray that met nothing, as some sensors write it: zeros fit to any velocity, in whatever order the columns are.
bool is_void(const Eigen::Vector3d& point, double doppler) {
  return (point.array() == 0.0).count() + (doppler == 0.0 ? 1 : 0) >= 3;
}

/// Points evenly over the scan: a few thousand tell. Of a rig those of its first sensor, in the frame of that sensor:
/// one velocity explains them.
RawScan thinned(const RawScan& scan) {
  RawScan few;
  few.stamp = scan.stamp;
  const bool is_of_rig = !scan.mountings.empty();
  const Eigen::Isometry3d T_sensor_scan = is_of_rig ? scan.mountings[0].inverse() : Eigen::Isometry3d::Identity();
  const std::size_t step = scan.points.size() / kMaxPoints + 1;
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    if (!is_void(scan.points[i], scan.doppler[i]) && (!is_of_rig || scan.channels.sensor[i] == 0)) {
      few.points.push_back(is_of_rig ? Eigen::Vector3d(T_sensor_scan * scan.points[i]) : scan.points[i]);
      few.doppler.push_back(scan.doppler[i]);
    }
  }
  return few;
}

/// Whether a scan says anything of its columns: many finite points that are not all at one place. One point, or one
/// place, is explained by some velocity whatever the columns are.
bool tells_columns(const RawScan& scan) {
  const auto is_finite = [](const Eigen::Vector3d& point) { return point.allFinite(); };
  const auto first = std::ranges::find_if(scan.points, is_finite);
  return first != scan.points.end() && std::ranges::count_if(scan.points, [&](const Eigen::Vector3d& point) {
                                         return is_finite(point) && (point - *first).norm() > 0.0;
                                       }) >= kMinPointsToTell;
}

double static_residual(const RawScan& raw, const Workers& workers) {
  const Scan scan = Scan::from_raw(raw);
  const ego_motion::EgoVelocity ego = ego_motion::estimate_velocity(scan, ego_motion::EgoPrior{}, {}, workers);
  std::vector<double> residuals = ego_motion::compensated_doppler(scan, ego.velocity_sensor);
  for (double& residual : residuals) {
    residual = std::abs(residual);
  }
  return quantile(std::move(residuals), kStaticShare);
}

/// The same of the last column where nothing moves, median over the scans: of a sensor at rest a velocity that was
/// found in the noise may explain it worse than none.
double residual_at_rest(std::span<const RawScan> scans) {
  std::vector<double> residuals;
  for (const RawScan& scan : scans) {
    if (tells_columns(scan)) {
      std::vector<double> speeds = prepared(thinned(scan), 3, guess_units(std::span(&scan, 1))).doppler;
      std::erase_if(speeds, [](double speed) { return !std::isfinite(speed); });
      std::transform(speeds.begin(), speeds.end(), speeds.begin(), [](double speed) { return std::abs(speed); });
      residuals.push_back(quantile(std::move(speeds), kStaticShare));
    }
  }
  return quantile(std::move(residuals), 0.5);
}

/// The scan with the columns of azimuth, elevation and range as x, y and z.
RawScan from_spherical(RawScan scan, const SphericalColumns& spherical) {
  const auto& [azimuth, elevation, range] = spherical.columns;
  datasets::Correction correction;
  correction.columns = {azimuth, elevation, range, 3};
  correction.coordinates = spherical.coordinates;
  return datasets::corrected(std::move(scan), correction);
}

/// Whether the numbers may be angles and ranges: nothing is farther round than a full turn, above the zenith, or behind
/// the sensor.
bool may_be_spherical(const RawScan& scan, const SphericalColumns& spherical) {
  constexpr double kRounding = 1e-6;
  const double turn =
      spherical.coordinates == datasets::Coordinates::kSphericalDegrees ? 360.0 : 2.0 * std::numbers::pi;
  const auto column = [&](const Eigen::Vector3d& point, std::size_t k) { return point[spherical.columns.at(k)]; };
  return std::ranges::all_of(scan.points, [&](const Eigen::Vector3d& point) {
    return !point.allFinite() || (std::abs(column(point, 0)) <= turn &&
                                  std::abs(column(point, 1)) <= (0.25 + kRounding) * turn && column(point, 2) >= 0.0);
  });
}

/// How far a column of coordinates reaches: its standard deviation over all points.
double spread_of(const std::vector<RawScan>& scans, int column) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const RawScan& scan : scans) {
    for (const Eigen::Vector3d& point : scan.points) {
      if (point.allFinite()) {
        sum += point[column];
        squares += point[column] * point[column];
        count += 1.0;
      }
    }
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count))) : 0.0;
}

/// All that the columns of coordinates may be. Of a sensor that drives straight ahead the Doppler is the same with
/// azimuth and elevation in each other's place: it sees farther round than up and down.
std::vector<SphericalColumns> spherical_hypotheses(const std::vector<RawScan>& scans) {
  std::vector<SphericalColumns> possible;
  const std::array<double, 3> spread = {spread_of(scans, 0), spread_of(scans, 1), spread_of(scans, 2)};
  for (const auto coordinates : {datasets::Coordinates::kSphericalDegrees, datasets::Coordinates::kSphericalRadians}) {
    std::array<int, 3> columns = {0, 1, 2};
    do {
      const SphericalColumns spherical{columns, coordinates};
      if (spread[static_cast<std::size_t>(columns[0])] >= spread[static_cast<std::size_t>(columns[1])] &&
          std::ranges::all_of(scans, [&](const RawScan& scan) { return may_be_spherical(scan, spherical); })) {
        possible.push_back(spherical);
      }
    } while (std::next_permutation(columns.begin(), columns.end()));
  }
  return possible;
}

/// The columns of azimuth, elevation and range, in this order; the angles times `scale`.
std::vector<Eigen::Vector3d> angles_of(const RawScan& scan, const SphericalColumns& spherical, double scale) {
  std::vector<Eigen::Vector3d> angles;
  for (const Eigen::Vector3d& point : scan.points) {
    angles.emplace_back(scale * point[spherical.columns[0]], scale * point[spherical.columns[1]],
                        point[spherical.columns[2]]);
  }
  return angles;
}

/// Whether the columns are angles that see surfaces. Coordinates within 2 pi may be metres as well: they are no
/// degrees, and radians only where metres they cannot be.
bool are_surfaces(const std::vector<RawScan>& scans, const SphericalColumns& spherical) {
  const bool in_degrees = spherical.coordinates == datasets::Coordinates::kSphericalDegrees;
  double widest = 0.0;
  for (const RawScan& scan : scans) {
    const std::vector<Eigen::Vector3d> angles = angles_of(scan, spherical, 1.0);
    for (const Eigen::Vector3d& point : angles) {
      widest = std::max(widest, std::abs(point.x()));  // false for NaN
    }
    if (in_degrees ? !shows_surfaces(angles) : !are_radians_with_ranges(angles, scan.points)) {
      return false;
    }
  }
  return !in_degrees || widest > 2.0 * std::numbers::pi;
}

/// Whether neighbours are so unequally far that the columns are no angles: in traffic a velocity may explain the
/// Doppler better with them than with x, y, z.
bool contradict_surfaces(const std::vector<RawScan>& scans, const SphericalColumns& spherical) {
  const bool in_degrees = spherical.coordinates == datasets::Coordinates::kSphericalDegrees;
  const double degrees = in_degrees ? 1.0 : 180.0 / std::numbers::pi;
  return std::ranges::any_of(
      scans, [&](const RawScan& scan) { return contradicts_surfaces(angles_of(scan, spherical, degrees)); });
}

/// The spherical coordinates that explain the Doppler best, where there may be any, and those that see surfaces.
void find_spherical(std::span<const RawScan> scans, const Workers& workers, ColumnScores& scores) {
  std::vector<RawScan> few;
  for (const RawScan& scan : scans) {
    if (tells_columns(scan)) {
      few.push_back(thinned(scan));
    }
  }
  std::optional<SphericalColumns>& best = scores.likely_spherical;
  for (SphericalColumns& spherical : few.empty() ? std::vector<SphericalColumns>() : spherical_hypotheses(few)) {
    if (contradict_surfaces(few, spherical)) {
      continue;
    }
    std::vector<double> residuals;
    for (const RawScan& scan : few) {
      const RawScan cartesian = from_spherical(scan, spherical);
      residuals.push_back(static_residual(prepared(cartesian, 3, guess_units(std::span(&cartesian, 1))), workers));
    }
    spherical.residual = quantile(std::move(residuals), 0.5);
    if (!best || spherical.residual < best->residual) {
      best = spherical;
    }
    if (!scores.surfaces && are_surfaces(few, spherical)) {
      scores.surfaces = spherical;
    }
  }
}

}  // namespace

UnitGuess guess_units(std::span<const RawScan> scans) {
  std::vector<double> far;
  std::vector<double> fast;
  for (const RawScan& raw : scans) {
    const Scan scan = Scan::from_raw(thinned(raw));
    std::vector<double> ranges;
    std::vector<double> speeds;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      ranges.push_back(scan.points()[i].norm());
      speeds.push_back(std::abs(scan.doppler()[i]));
    }
    if (!ranges.empty()) {
      far.push_back(quantile(std::move(ranges), kNearlyAll));
      fast.push_back(quantile(std::move(speeds), kNearlyAll));
    }
  }
  UnitGuess units;
  const double farthest = quantile(std::move(far), 0.5);
  const double fastest = quantile(std::move(fast), 0.5);
  if (farthest > kFarthest_m) {
    units.points = farthest > kFarthestInCentimetres ? 0.001 : 0.01;
  } else if (farthest > 0.0 && farthest < kNearest_m) {
    units.points = 1000.0;
  }
  if (fastest > kFastest_mps) {
    units.doppler = fastest > kFastestInCentimetres ? 0.001 : 0.01;
  }
  return units;
}

ColumnScores score_columns(std::span<const RawScan> scans, const Workers& workers) {
  ColumnScores scores;
  // Coordinates in km are so small that any velocity explains them.
  const UnitGuess as_stored = guess_units(scans);
  const UnitGuess at_least_metres{std::max(1.0, as_stored.points), 1.0};
  for (int column = 0; column < 4; ++column) {
    std::vector<double> residuals;
    for (const RawScan& scan : scans) {
      if (!tells_columns(scan)) {
        continue;
      }
      const RawScan few = prepared(prepared(thinned(scan), 3, at_least_metres), column, {});
      // Each order of columns has its own guess: what is taken for the Doppler may be millimetres.
      const UnitGuess units = guess_units(std::span(&few, 1));
      residuals.push_back(static_residual(prepared(few, 3, units), workers));
    }
    scores.residual.at(static_cast<std::size_t>(column)) = quantile(std::move(residuals), 0.5);
  }
  const auto best = std::min_element(scores.residual.begin(), scores.residual.end());
  if (scores.residual[3] > kTimesWorse * *best) {
    scores.likely_doppler = static_cast<int>(best - scores.residual.begin());
    scores.doppler = *best < kGoodResidual_mps ? scores.likely_doppler : 3;
  }
  find_spherical(scans, workers, scores);
  if (const auto& spherical = scores.likely_spherical;
      spherical && spherical->residual < kGoodResidual_mps && spherical->residual <= *best &&
      std::min(scores.residual[3], residual_at_rest(scans)) > kTimesWorse * spherical->residual) {
    scores.spherical = spherical;
    scores.doppler = 3;
    scores.likely_doppler = 3;
  }
  return scores;
}

std::array<int, 4> with_doppler_last(int doppler) {
  std::array<int, 4> order = {0, 1, 2, 3};
  std::stable_partition(order.begin(), order.end(), [&](int column) { return column != doppler; });
  return order;
}

RawScan prepared(RawScan scan, int doppler, const UnitGuess& units) {
  datasets::Correction correction;
  correction.columns = with_doppler_last(doppler);
  correction.point_scale = units.points;
  correction.doppler_scale = units.doppler;
  return datasets::corrected(std::move(scan), correction);
}

RawScan prepared(RawScan scan, const ColumnScores& scores, const UnitGuess& units) {
  return prepared(scores.spherical ? from_spherical(std::move(scan), *scores.spherical) : std::move(scan),
                  scores.doppler, units);
}

}  // namespace dynamic_icp::diagnosis
