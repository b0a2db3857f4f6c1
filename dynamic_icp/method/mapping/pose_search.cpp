// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"

namespace dynamic_icp::mapping {
namespace {

// An alignment finds its way back from about this far.
constexpr double kStep_rad = 2.5 * std::numbers::pi / 180.0;

// Starts lie within so many standard deviations of the prior.
constexpr double kReach = 2.5;
constexpr int kMaxSteps = 6;

// So many points are enough to compare starts.
constexpr std::size_t kFewPoints = 1500;

// Tukey's cutoff: at first, and after so many halvings.
constexpr double kCandidateCutoff_m = 2.0;
constexpr double kFinalCutoff_m = 0.5;
constexpr int kNarrowings = 5;
constexpr double kKernel = 3.0;
constexpr double kMinSigma_m = 0.005;

constexpr int kCandidateIterations = 9;
constexpr int kMaxIterations = 20;
constexpr double kConverged = 1e-5;  // rad and m

struct PoseSums {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weights = 0.0;

  PoseSums& operator+=(const PoseSums& other) {
    H += other.H;
    g += other.g;
    weights += other.weights;
    return *this;
  }
};

std::vector<Eigen::Vector3d> deskewed(const Scan& scan, const motion::SweepMotion& sweep) {
  const motion::Deskewer deskewer(sweep, motion::time_span(scan));
  std::vector<Eigen::Vector3d> points = scan.points();
  for (std::size_t i = 0; i < points.size() && scan.has_times(); ++i) {
    points[i] = deskewer.at_stamp(points[i], scan.times()[i]);
  }
  return points;
}

std::vector<Eigen::Vector3d> few_of(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kFewPoints);
  std::vector<Eigen::Vector3d> few;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    few.push_back(points[i]);
  }
  return few;
}

/// The rotation of the prior, and those turned from it about each axis.
std::vector<Eigen::Matrix3d> starts_around(const PosePrior& prior) {
  std::vector<Eigen::Matrix3d> starts = {prior.R_map_sensor};
  const int steps = static_cast<int>(std::min<double>(kMaxSteps, kReach * prior.rotation_sigma_rad / kStep_rad));
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = -steps; k <= steps; ++k) {
      if (k != 0) {
        starts.emplace_back(exp_so3(k * kStep_rad * Eigen::Vector3d::Unit(axis)) * prior.R_map_sensor);
      }
    }
  }
  return starts;
}

/// Points against the patches that they meet. Those on one patch have the error of its plane in common: together they
/// never count more than it is known.
class PoseFit {
 public:
  PoseFit(const std::vector<Eigen::Vector3d>& points, const PlaneMap& map, const Workers& workers)
      : points_(points), map_(map), workers_(workers), met_(points.size(), nullptr), members_(map.patch_limit()) {}

  std::size_t associate(const Eigen::Isometry3d& T) {
    workers_.for_each(points_.size(), kPointBlock, [&](std::size_t i) { met_[i] = map_.find(T * points_[i]); });
    std::ranges::fill(members_, 0U);
    std::size_t on_planes = 0;
    for (const Patch* patch : met_) {
      if (patch != nullptr) {
        ++members_[patch->id];
        ++on_planes;
      }
    }
    return on_planes;
  }

  [[nodiscard]] PoseSums sums(const Eigen::Isometry3d& T, double cutoff_m) const {
    return workers_.sum_blocks(points_.size(), kPointBlock, PoseSums{}, [&](std::size_t begin, std::size_t end) {
      PoseSums block;
      for (std::size_t i = begin; i < end; ++i) {
        if (met_[i] != nullptr) {
          add(*met_[i], T.linear() * points_[i], T.translation(), cutoff_m, block);
        }
      }
      return block;
    });
  }

 private:
  void add(const Patch& patch, const Eigen::Vector3d& arm, const Eigen::Vector3d& position, double cutoff_m,
           PoseSums& sums) const {
    const Plane& plane = patch.plane;
    const double e = plane.distance(position + arm);
    const double own = std::max(plane.variance, kMinSigma_m * kMinSigma_m);
    const double common = plane.height_variance(position + arm);
    const double rho = estimation::tukey_weight(e, std::max(cutoff_m, kKernel * std::sqrt(own + common)));
    const double w = rho / (own + members_[patch.id] * common);
    Vector6d J;
    J << arm.cross(plane.normal), plane.normal;
    sums.H += w * J * J.transpose();
    sums.g += w * e * J;
    sums.weights += rho;
  }

  const std::vector<Eigen::Vector3d>& points_;
  const PlaneMap& map_;
  const Workers& workers_;
  std::vector<const Patch*> met_;
  std::vector<std::uint32_t> members_;  ///< points on each patch
};

/// e_R = log(R R_prior^T); e_t = t - fixed - R turned, where a rotation d moves R turned by d x R turned.
void add_prior(const PosePrior& prior, const Eigen::Isometry3d& T, PoseSums& sums) {
  const double of_rotation = 1.0 / (prior.rotation_sigma_rad * prior.rotation_sigma_rad);
  sums.H.diagonal().head<3>().array() += of_rotation;
  sums.g.head<3>() += of_rotation * log_so3(T.linear() * prior.R_map_sensor.transpose());
  const double of_position = 1.0 / (prior.position_sigma_m * prior.position_sigma_m);
  const Eigen::Vector3d turned = T.linear() * prior.displacement_rotated;
  Eigen::Matrix<double, 3, 6> J;
  J << skew(turned), Eigen::Matrix3d::Identity();
  sums.H += of_position * J.transpose() * J;
  sums.g += of_position * J.transpose() * (T.translation() - prior.displacement_fixed - turned);
}

FoundPose align(const std::vector<Eigen::Vector3d>& points, const PlaneMap& map, const PosePrior& prior,
                const Eigen::Matrix3d& R_start, double cutoff_m, int iterations, const Workers& workers) {
  FoundPose found;
  Eigen::Isometry3d& T = found.T_map_sensor;
  T.linear() = R_start;
  T.translation() = prior.displacement_fixed + R_start * prior.displacement_rotated;
  PoseFit fit(points, map, workers);
  for (int k = 0; k < iterations; ++k) {
    found.on_planes = fit.associate(T);
    PoseSums sums = fit.sums(T, cutoff_m);
    found.matched = sums.weights;
    add_prior(prior, T, sums);
    const Vector6d step = -sums.H.ldlt().solve(sums.g);
    if (!(step.norm() <= kMaxCoordinate_m)) {  // also when it is not finite
      found.diverged = true;
      break;
    }
    T.linear() = Eigen::Quaterniond(exp_so3(step.head<3>()) * T.linear()).normalized().toRotationMatrix();
    T.translation() += step.tail<3>();
    if (k >= kNarrowings && step.norm() < kConverged) {
      break;
    }
    cutoff_m *= k < kNarrowings ? 0.5 : 1.0;
  }
  return found;
}

}  // namespace

FoundPose search_pose(const Scan& scan, const PlaneMap& map, const PosePrior& prior, const Workers& workers) {
  const std::vector<Eigen::Vector3d> points = deskewed(scan, prior.sweep);
  const std::vector<Eigen::Vector3d> few = few_of(points);
  const std::vector<Eigen::Matrix3d> starts = starts_around(prior);
  std::vector<FoundPose> candidates(starts.size());
  workers.for_each(starts.size(), 1, [&](std::size_t k) {
    candidates[k] = align(few, map, prior, starts[k], kCandidateCutoff_m, kCandidateIterations, workers);
  });
  const auto best = std::ranges::max_element(candidates, {}, &FoundPose::matched);
  return align(points, map, prior, best->T_map_sensor.linear(), kFinalCutoff_m, kMaxIterations, workers);
}

}  // namespace dynamic_icp::mapping
