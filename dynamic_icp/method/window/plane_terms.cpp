// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/plane_terms.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/mapping/patch_scatter.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/window/measured_angles.hpp"

namespace dynamic_icp::window {
namespace {

constexpr std::uint32_t kInformativePoints = 5;  // a patch tells of itself with so many points on it
constexpr std::size_t kInformativePatches = 50;  // and all patches together when there are so many
constexpr double kBendInCommon = 0.4;            // the points of a scan on a patch meet part of its bend
constexpr double kMinHeld = 1e-6;
constexpr double kTiltOfModel = 0.3;     // a patch is off a plane in three places, each by itself
constexpr double kNoPointing = 1e-14;    // rad^2
constexpr double kNoInformation = 1e-6;  // 1/rad^2 and 1/m^2

/// Of the normal of a patch, rad^2 and 1/m^2 of its tangential matrix.
double normal_variance(const mapping::Plane& plane, double model_variance) {
  return plane.variance / plane.points + kTiltOfModel * model_variance;
}

}  // namespace

PlaneTerms::PlaneTerms(const Scan& points, const mapping::PlaneMap& map, double stamp_s, double slice_s,
                       const Workers& workers)
    : scan_(points), map_(map), workers_(workers), stamp_s_(stamp_s) {
  const motion::TimeSpan span = motion::time_span(points);
  const auto count = static_cast<std::size_t>((span.last - span.first) / slice_s) + 1;
  const auto slice_of = [&](std::size_t i) {
    return points.has_times()
               ? std::min(count - 1, static_cast<std::size_t>((points.times()[i] - span.first) / slice_s))
               : 0;
  };
  slices_.resize(count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ++slices_[slice_of(i)].end;
  }
  std::size_t at = 0;
  for (std::size_t s = 0; s < count; ++s) {
    slices_[s].begin = at;
    at += slices_[s].end;
    slices_[s].end = slices_[s].begin;
    slices_[s].time_s = stamp_s + span.first + (static_cast<double>(s) + 0.5) * slice_s;
    if (count == 1) {
      slices_[s].time_s = stamp_s + 0.5 * (span.first + span.last);
    }
  }
  order_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    order_[slices_[slice_of(i)].end++] = static_cast<std::uint32_t>(i);
  }
  rows_.resize(points.size());
  found_in_.assign(points.size(), spatial::kNoCell);
}

void PlaneTerms::set_stamp(double stamp_s) {
  for (Slice& slice : slices_) {
    slice.time_s += stamp_s - stamp_s_;
  }
  stamp_s_ = stamp_s;
}

std::vector<double> PlaneTerms::slice_times() const {
  std::vector<double> times;
  times.reserve(slices_.size());
  for (const Slice& slice : slices_) {
    times.push_back(slice.time_s);
  }
  return times;
}

/// The error of the map is that of sweeps `map_age` scans before the last one. In a direction that no patch has shown
/// yet it may have gone far since then, and a patch of the last scans has not.
double PlaneTerms::recent_share(const mapping::Plane& plane) const {
  const double age = static_cast<double>(map_.scans()) - plane.scan;
  return last_.map_age > 0.0 ? std::clamp(1.0 - age / last_.map_age, 0.0, 1.0) : 0.0;
}

/// Where the points of a slice are: the pose in its middle, and from there a straight step.
void PlaneTerms::place(const SplineTrajectory& trajectory, const Eigen::VectorXd& map_error, const PlaneNoise& noise,
                       Slice& slice) {
  slice.at = trajectory.at(slice.time_s);
  const Eigen::Isometry3d& T_map_reference = trajectory.reference();
  const Eigen::Matrix3d R_reference_map = T_map_reference.linear().transpose();
  const double min_variance = noise.min_sigma_m * noise.min_sigma_m;
  slice.on_planes = 0;
  for (std::size_t k = slice.begin; k < slice.end; ++k) {
    const std::size_t i = order_[k];
    Row& row = rows_[k];
    const double step_s = scan_.has_times() ? stamp_s_ + scan_.times()[i] - slice.time_s : 0.0;
    const Eigen::Vector3d in_reference = slice.at.place(scan_.points()[i], step_s);
    const Eigen::Vector3d in_map = T_map_reference * in_reference;
    const std::uint64_t cell = map_.finest_cell(in_map);
    if (cell != found_in_[k]) {
      found_in_[k] = cell;
      row.patch = map_.find(cell);
    }
    if (row.patch == nullptr) {
      row.w = 0.0;
      continue;
    }
    ++slice.on_planes;
    const mapping::Plane& plane = row.patch->plane;
    const Eigen::Vector3d n = R_reference_map * plane.normal;
    row.m << in_reference.cross(n), n;
    row.lever = in_map - T_map_reference.translation();
    const double phase = plane.phase * static_cast<double>(PlaneSums::kMapNodes - 1);
    row.node = std::min(PlaneSums::kMapNodes - 2, static_cast<std::size_t>(phase));
    row.beyond = phase - static_cast<double>(row.node);
    const auto before = map_error.segment<6>(6 * static_cast<Eigen::Index>(row.node));
    const auto after = map_error.segment<6>(6 * static_cast<Eigen::Index>(row.node + 1));
    row.recent = recent_share(plane);
    const double by_map = (1.0 - row.beyond) * row.m.dot(before) + row.beyond * row.m.dot(after);
    row.e = plane.distance(in_map) - (1.0 - row.recent) * by_map - row.recent * row.m.dot(last_.displacement);
    row.J = by_angles(scan_, i).transpose() * (slice.at.R.transpose() * n);
    row.own = std::max(plane.variance, min_variance);
    row.in_common = plane.height_variance(in_map) + model_variance_ + kBendInCommon * plane.bend;
  }
}

/// Points of a patch are weighted alike. Its height is known worse at its rim than in its middle, but where a surface
/// bulges, the middle lies on one side of the plane and the rim on the other: to believe one more is to move the plane.
/// A residual may be as large as what is unknown of the pose makes it: else a pose that is off rejects all that would
/// put it right.
void PlaneTerms::associate(const SplineTrajectory& trajectory, const Eigen::VectorXd& map_error,
                           const PlaneNoise& noise, bool adapt, const std::vector<Matrix6d>& displacements) {
  R_map_reference_ = trajectory.reference().linear();
  pointing_variance_ = noise.pointing_variance;
  model_variance_ = noise.model_sigma_m * noise.model_sigma_m;
  workers_.for_each(slices_.size(), 1, [&](std::size_t s) { place(trajectory, map_error, noise, slices_[s]); });
  members_.assign(map_.patch_limit(), 0);
  precision_.assign(map_.patch_limit(), 0.0);
  for (const Row& row : rows_) {
    if (row.patch != nullptr) {
      ++members_[row.patch->id];
      precision_[row.patch->id] += 1.0 / row.in_common;
    }
  }
  squares_.clear();
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    for (std::size_t k = slices_[s].begin; k < slices_[s].end; ++k) {
      Row& row = rows_[k];
      if (row.patch != nullptr) {
        row.in_common = members_[row.patch->id] / precision_[row.patch->id];
        row.expected = row.own + row.in_common + (displacements.empty() ? 0.0 : row.m.dot(displacements[s] * row.m));
        squares_.push_back(row.e * row.e / row.expected);
      }
    }
  }
  const double kernel =
      noise.kernel * (adapt && !squares_.empty() ? std::max(1.0, kSigmaPerMad * std::sqrt(median(squares_))) : 1.0);
  workers_.for_each(slices_.size(), 1, [&](std::size_t s) {
    Slice& slice = slices_[s];
    for (std::size_t k = slice.begin; k < slice.end; ++k) {
      Row& row = rows_[k];
      if (row.patch != nullptr) {
        const double inside = std::max(0.0, 1.0 - row.e * row.e / (kernel * kernel * row.expected));
        row.all = row.own + noise.repeated * members_[row.patch->id] * row.in_common;
        row.w = inside * inside / row.all;
      }
    }
    sum(slice);
  });
  hold_motions(noise.max_noise_share);
}

void PlaneTerms::sum(Slice& slice) const {
  slice.sums.clear();
  slice.noise.setZero();
  slice.matched = 0.0;
  slice.squares = 0.0;
  for (std::size_t k = slice.begin; k < slice.end; ++k) {
    const Row& row = rows_[k];
    if (row.w <= 0.0) {
      continue;
    }
    slice.sums.add(row);
    const mapping::Plane& plane = row.patch->plane;
    const Eigen::Matrix3d noise = (row.w * normal_variance(plane, model_variance_)) * plane.tangential;
    const Eigen::Matrix3d turned = skew(row.lever) * noise;  // m = [X x n; n]
    slice.noise.topLeftCorner<3, 3>() += turned * skew(row.lever).transpose();
    slice.noise.topRightCorner<3, 3>() += turned;
    slice.noise.bottomRightCorner<3, 3>() += noise;
    const double robust = row.w * row.all;
    slice.matched += robust;
    slice.squares += robust * row.e * row.e;
  }
}

/// Information about the two displacements along the principal motions: sum of w [1 r; r r^2] m m^T.
Eigen::Matrix<double, 12, 12> PlaneTerms::by_displacements(const PlaneSums& sums) const {
  const Matrix6d S_recent = motions_.transpose() * sums.S_recent() * motions_;
  Eigen::Matrix<double, 12, 12> result;
  result << motions_.transpose() * sums.S() * motions_, S_recent, S_recent, motions_.transpose() * sums.rr() * motions_;
  return result;
}

/// Of those whose normals err: so many that err alike would average as they do.
double PlaneTerms::independent_patches() {
  normal_noise_.assign(members_.size(), 0.0);
  for (const Row& row : rows_) {
    if (row.patch != nullptr) {
      normal_noise_[row.patch->id] +=
          row.w * normal_variance(row.patch->plane, model_variance_) * row.patch->plane.tangential.trace();
    }
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const double one : normal_noise_) {
    sum += one;
    squares += one * one;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

/// Normals err, and of a motion along which no surface lies across, as along a tunnel or around it, the sum of w m m^T
/// is their noise alone. The map, which moves with us, confirms any speed of it, or none. The principal motions are
/// those that have most and least of that noise in their information; of one that has too much the map has a
/// displacement of its own in each scan, and its last sweep another one.
void PlaneTerms::hold_motions(double max_noise_share) {
  Matrix6d noise = Matrix6d::Zero();
  MotionInformation scan{kNoInformation * Matrix6d::Identity(), {}};
  for (const Slice& slice : slices_) {
    scan.all += slice.sums.S();
    noise += slice.noise;
  }
  noise.bottomLeftCorner<3, 3>() = noise.topRightCorner<3, 3>().transpose();
  Matrix6d to_map = Matrix6d::Zero();
  to_map.topLeftCorner<3, 3>() = R_map_reference_;
  to_map.bottomRightCorner<3, 3>() = R_map_reference_;
  scan.noise = to_map.transpose() * noise * to_map;
  const ContinuedMotions found = continue_motions(scan, past_motions_, independent_patches(), max_noise_share);
  motions_ = found.principal.motions;
  shown_motions_ = found.sums;
  held_ = (1.0 - found.principal.noise_shares.array() / max_noise_share).max(kMinHeld).min(1.0 - 1e-9);
  const Vector6d known = held_.array() / (1.0 - held_.array());
  common_information_.setZero();
  common_information_.diagonal().head<12>() << known, known;
  for (const Slice& slice : slices_) {
    common_information_.topLeftCorner<12, 12>() += by_displacements(slice.sums);
    const Eigen::Matrix<double, 12, 2> by_pointing = along_displacements(slice.sums.P(), slice.sums.P_recent());
    common_information_.topRightCorner<12, 2>() += by_pointing;
    common_information_.bottomLeftCorner<2, 12>() += by_pointing.transpose();
    common_information_.bottomRightCorner<2, 2>() += slice.sums.PP();
  }
  common_information_.diagonal().tail<2>().array() += pointing_variance_.array().max(kNoPointing).inverse();
}

PlaneQuality PlaneTerms::quality() const {
  PlaneQuality result;
  result.held = held_;
  Matrix6d S = Matrix6d::Zero();
  Vector6d E = Vector6d::Zero();
  double squares = 0.0;
  for (const Slice& slice : slices_) {
    result.on_planes += slice.on_planes;
    result.matched += slice.matched;
    squares += slice.squares;
    S += slice.sums.S();
    E += slice.sums.E();
  }
  result.rms_m = result.matched > 0.0 ? std::sqrt(squares / result.matched) : 0.0;
  const Vector6d rigid = (S + 1e-6 * Matrix6d::Identity()).ldlt().solve(E);
  struct Mean {
    double e = 0.0;
    double explained = 0.0;
    std::uint32_t points = 0;
  };
  std::vector<Mean> patches(members_.size());
  double weights = 0.0;
  for (const Row& row : rows_) {
    if (row.patch != nullptr && row.w > 0.0) {
      const double members = members_[row.patch->id];
      weights += row.w;
      result.share += row.w * members / (row.patch->plane.points + members);
      Mean& mean = patches[row.patch->id];
      mean.e += row.e - row.m.dot(rigid);
      mean.explained += row.own / row.patch->plane.points;
      ++mean.points;
    }
  }
  result.share = weights > 0.0 ? result.share / weights : 0.0;
  std::vector<mapping::PatchMean> means;
  for (const Row& row : rows_) {
    if (row.patch == nullptr || row.w <= 0.0) {
      continue;
    }
    Mean& mean = patches[row.patch->id];
    if (mean.points < kInformativePoints) {
      continue;
    }
    const double m = mean.points;
    const double e = mean.e / m;
    means.push_back({e * e, row.own / m + mean.explained / m});
    mean.points = 0;  // once
  }
  if (means.size() >= kInformativePatches) {
    result.model_sigma_m = mapping::unexplained_sigma(means);
  }
  return result;
}

}  // namespace dynamic_icp::window
