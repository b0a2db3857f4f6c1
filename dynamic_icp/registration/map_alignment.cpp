// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/map_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamic_icp/estimation/robust_kernel.hpp"
#include "dynamic_icp/registration/gauss_newton.hpp"
#include "dynamic_icp/registration/patch_scatter.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kBlock = 512;

// The kernel narrows by this factor with each step.
constexpr double kNarrowing = 0.5;

// A patch tells of itself with so many points on it, all of them together with so many patches.
constexpr std::uint32_t kTellingPoints = 5;
constexpr std::size_t kTellingPatches = 50;

// The wide kernel is given up when it is narrower than any surface is rough.
constexpr double kNarrow_m = 0.02;

/// Normal equations of [rotation; position; omega; alpha] and how well the points fit.
struct Sums {
  Matrix12d H = Matrix12d::Zero();  // lower half only
  Vector12d b = Vector12d::Zero();
  double weights = 0.0;
  double squares = 0.0;      // m^2
  double chi_squares = 0.0;  // over the predicted variances

  Sums& operator+=(const Sums& other) {
    H += other.H;
    b += other.b;
    weights += other.weights;
    squares += other.squares;
    chi_squares += other.chi_squares;
    return *this;
  }
};

double largest_deviation(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff()));
}

/// One scan against one map: what the iterations share.
class PlaneFit {
 public:
  PlaneFit(const Scan& scan, const mapping::PlaneMap& map, const MapAlignConfig& config, const Workers& workers)
      : scan_(scan),
        map_(map),
        config_(config),
        workers_(workers),
        at_stamp_(scan.size()),
        patches_(scan.size()),
        members_(map.patch_limit()) {}

  /// Undoes the sweep and looks up the patch of each point.
  void associate(const Eigen::Isometry3d& T_map_sensor, const SweepMotion& sweep) {
    const SweepUndone undone(sweep, scan_.times());
    workers_.for_each(scan_.size(), kBlock, [&](std::size_t i) {
      const Eigen::Vector3d& point = scan_.points()[i];
      at_stamp_[i] = scan_.has_times() ? undone.at_stamp(point, scan_.times()[i]) : point;
      patches_[i] = map_.find(T_map_sensor * at_stamp_[i]);
    });
    std::fill(members_.begin(), members_.end(), 0U);
    on_planes_ = 0;
    for (const mapping::Patch* patch : patches_) {
      if (patch != nullptr) {
        ++members_[patch->id];
        ++on_planes_;
      }
    }
  }

  /// The point-to-plane terms; `gate_m` widens the kernel.
  [[nodiscard]] Sums linearise(const Eigen::Isometry3d& T_map_sensor, double gate_m) const {
    return workers_.sum_blocks(scan_.size(), kBlock, Sums{}, [&](std::size_t begin, std::size_t end) {
      Sums sums;
      for (std::size_t i = begin; i < end; ++i) {
        if (patches_[i] != nullptr) {
          add(sums, i, T_map_sensor, gate_m);
        }
      }
      return sums;
    });
  }

  /// How far the points on each patch with enough of them lie from its plane on average.
  [[nodiscard]] std::vector<PatchMean> patch_means(const Eigen::Isometry3d& T_map_sensor) const {
    std::vector<const mapping::Patch*> met(members_.size(), nullptr);
    std::vector<Eigen::Vector3d> sums(members_.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < scan_.size(); ++i) {
      if (patches_[i] != nullptr) {
        met[patches_[i]->id] = patches_[i];
        sums[patches_[i]->id] += at_stamp_[i];
      }
    }
    std::vector<PatchMean> means;
    for (std::size_t id = 0; id < met.size(); ++id) {
      if (met[id] != nullptr && members_[id] >= kTellingPoints) {
        const double m = members_[id];
        const Eigen::Vector3d middle = T_map_sensor * Eigen::Vector3d(sums[id] / m);
        const double distance = met[id]->plane.distance(middle);
        means.push_back({distance * distance, met[id]->plane.variance / m + met[id]->plane.height_variance(middle)});
      }
    }
    return means;
  }

  [[nodiscard]] std::size_t on_planes() const { return on_planes_; }

 private:
  void add(Sums& sums, std::size_t i, const Eigen::Isometry3d& T_map_sensor, double gate_m) const {
    const mapping::Plane& plane = patches_[i]->plane;
    const Eigen::Vector3d arm = T_map_sensor.linear() * at_stamp_[i];
    const Eigen::Vector3d point = arm + T_map_sensor.translation();
    const double e = plane.distance(point);
    const double own = std::max(plane.variance, config_.min_deviation_m * config_.min_deviation_m);
    const double common = plane.height_variance(point) + config_.model_deviation_m * config_.model_deviation_m;
    const double kernel = std::max(gate_m, config_.kernel * std::sqrt(own + common));
    const double robust = estimation::tukey_weight(e, kernel);
    if (robust <= 0.0) {
      return;
    }
    const double weight = robust / (own + members_[patches_[i]->id] * common);
    Vector12d J = Vector12d::Zero();
    J.head<3>() = arm.cross(plane.normal);
    J.segment<3>(3) = plane.normal;
    if (scan_.has_times()) {
      // A turn of the sensor by d(tau) moves the point by d x p, in the axes at the stamp.
      const double tau = scan_.times()[i];
      const Eigen::Vector3d turn = at_stamp_[i].cross(T_map_sensor.linear().transpose() * plane.normal);
      J.segment<3>(6) = tau * turn;
      J.segment<3>(9) = 0.5 * tau * tau * turn;
    }
    sums.H.selfadjointView<Eigen::Lower>().rankUpdate(J, weight);
    sums.b += weight * e * J;
    sums.weights += robust;
    sums.squares += robust * e * e;
    sums.chi_squares += robust * e * e / (own + common);
  }

  const Scan& scan_;
  const mapping::PlaneMap& map_;
  const MapAlignConfig& config_;
  const Workers& workers_;
  std::vector<Eigen::Vector3d> at_stamp_;  // m, sensor axes at the stamp
  std::vector<const mapping::Patch*> patches_;
  std::vector<std::uint32_t> members_;  // points per patch
  std::size_t on_planes_ = 0;
};

/// The terms of the prior.
class PriorTerms {
 public:
  explicit PriorTerms(const MotionPrior& prior)
      : prior_(prior),
        motion_information_(prior.covariance.ldlt().solve(Matrix9d::Identity())),
        translation_information_(prior.translation_covariance.ldlt().solve(Eigen::Matrix3d::Identity())) {}

  void add(const MapAlignment& at, Matrix12d& H, Vector12d& b) const {
    Vector9d e;
    e << log_so3(at.T_map_sensor.linear() * prior_.R_map_sensor.transpose()), at.sweep.omega - prior_.sweep.omega,
        at.sweep.alpha - prior_.sweep.alpha;
    const Vector9d gradient = motion_information_ * e;
    const auto place = [](Eigen::Index k) { return k < 3 ? k : k + 3; };  // the position stands between
    for (Eigen::Index row = 0; row < 9; ++row) {
      b[place(row)] += gradient[row];
      for (Eigen::Index column = 0; column < 9; ++column) {
        H(place(row), place(column)) += motion_information_(row, column);
      }
    }
    // e_t = t - fixed - R turned; a rotation d moves R turned by d x R turned.
    const Eigen::Vector3d turned = at.T_map_sensor.linear() * prior_.displacement_turned;
    const Eigen::Vector3d e_t = at.T_map_sensor.translation() - prior_.displacement_fixed - turned;
    Eigen::Matrix<double, 3, 6> J;
    J << skew(turned), Eigen::Matrix3d::Identity();
    H.topLeftCorner<6, 6>() += J.transpose() * translation_information_ * J;
    b.head<6>() += J.transpose() * (translation_information_ * e_t);
  }

 private:
  const MotionPrior& prior_;
  Matrix9d motion_information_;
  Eigen::Matrix3d translation_information_;
};

void move(MapAlignment& at, const Vector12d& step) {
  at.T_map_sensor.linear() = exp_so3(step.head<3>()) * at.T_map_sensor.linear();
  at.T_map_sensor.translation() += step.segment<3>(3);
  at.sweep.omega += step.segment<3>(6);
  at.sweep.alpha += step.segment<3>(9);
}

/// Fit and covariance at the final pose, with the narrow kernel.
void describe(MapAlignment& result, PlaneFit& fit, const PriorTerms& prior) {
  result.T_map_sensor.linear() =
      Eigen::Quaterniond(result.T_map_sensor.linear()).normalized().toRotationMatrix();  // many small steps
  fit.associate(result.T_map_sensor, result.sweep);
  const Sums sums = fit.linearise(result.T_map_sensor, 0.0);
  Matrix12d H = sums.H.selfadjointView<Eigen::Lower>();
  result.geometry_information = H.topLeftCorner<6, 6>();
  Vector12d b = sums.b;
  prior.add(result, H, b);
  result.covariance = H.ldlt().solve(Matrix12d::Identity());
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.on_planes = fit.on_planes();
  result.matched = sums.weights;
  result.rms_m = sums.weights > 0.0 ? std::sqrt(sums.squares / sums.weights) : 0.0;
  result.chi = sums.weights > 0.0 ? std::sqrt(sums.chi_squares / sums.weights) : 0.0;
  const std::vector<PatchMean> means = fit.patch_means(result.T_map_sensor);
  if (means.size() >= kTellingPatches) {
    result.model_deviation_m = unexplained_deviation(means);
  }
}

}  // namespace

ConfigFields fields(MapAlignConfig& config) {
  return {
      {"max_iterations", &config.max_iterations, 1, 1000, "", "most steps of the alignment to the local map"},
      {"min_deviation_m", &config.min_deviation_m, 1e-4, 1.0, "m", "least deviation of a point from its plane"},
      {"model_deviation_m", &config.model_deviation_m, 0.0, 1.0, "m",
       "deviation of patches of surface from planes, common to all points on a patch"},
      {"kernel", &config.kernel, 1.0, 100.0, "", "points beyond so many deviations have no weight (Tukey)"},
      {"max_gate_m", &config.max_gate_m, 0.0, 100.0, "m", "widest reach of the kernel while the start is uncertain"},
      {"rotation_step_rad", &config.rotation_step_rad, 1e-12, 1.0, "rad", "converged when a step turns by less"},
      {"translation_step_m", &config.translation_step_m, 1e-12, 1.0, "m", "and moves by less"},
  };
}

MapAlignment align_to_map(const Scan& scan, const mapping::PlaneMap& map, const MotionPrior& prior,
                          const MapAlignConfig& config, const Workers& workers) {
  const double turn_m = typical_distance(scan) * largest_deviation(prior.covariance.topLeftCorner<3, 3>());
  const double move_m = largest_deviation(prior.translation_covariance);
  return align_to_map(scan, map, prior, prior.R_map_sensor, config.kernel * std::hypot(turn_m, move_m), config,
                      workers);
}

MapAlignment align_to_map(const Scan& scan, const mapping::PlaneMap& map, const MotionPrior& prior,
                          const Eigen::Matrix3d& R_start, double gate_m, const MapAlignConfig& config,
                          const Workers& workers) {
  MapAlignment result;
  result.points = scan.size();
  result.T_map_sensor.linear() = R_start;
  result.T_map_sensor.translation() = prior.displacement_fixed + R_start * prior.displacement_turned;
  result.sweep = prior.sweep;

  PlaneFit fit(scan, map, config, workers);
  const PriorTerms prior_terms(prior);
  gate_m = std::min(config.max_gate_m, gate_m);
  while (result.iterations < config.max_iterations && !result.converged) {
    fit.associate(result.T_map_sensor, result.sweep);
    const Sums sums = fit.linearise(result.T_map_sensor, gate_m);
    Matrix12d H = sums.H.selfadjointView<Eigen::Lower>();
    Vector12d b = sums.b;
    prior_terms.add(result, H, b);
    const Vector12d step = -H.ldlt().solve(b);
    move(result, step);
    ++result.iterations;
    result.converged = gate_m < kNarrow_m && step.head<3>().norm() < config.rotation_step_rad &&
                       step.segment<3>(3).norm() < config.translation_step_m;
    gate_m *= kNarrowing;
  }
  describe(result, fit, prior_terms);
  return result;
}

}  // namespace dynamic_icp::registration
