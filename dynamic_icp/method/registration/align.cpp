// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/align.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "dynamic_icp/method/registration/step_equations.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kGroupBlock = 128;  // groups of source points

/// Two scans and what is minimised between them.
class ScanToScan : public Problem {
 public:
  ScanToScan(const Source& source, const Target& target, const Objective& objective, const Workers& workers)
      : source_(source),
        target_(target),
        objective_(objective),
        workers_(workers),
        search_(source.scan, target, objective.gate, objective.geometry == GeometryTerm::kPointToPlane, workers),
        fast_(has_step_equations(objective)) {}

  Correspondences find(const Eigen::Isometry3d& T_target_source) override { return search_.find(T_target_source); }

  [[nodiscard]] Linearisation linearise(const Correspondences& correspondences,
                                        const Eigen::Isometry3d& T_target_source, int iteration) const override {
    return registration::linearise({source_, target_, correspondences}, T_target_source, objective_, iteration,
                                   workers_);
  }

  Fit associate(const Eigen::Isometry3d& T_target_source) override {
    if (!fast_) {
      return Problem::associate(T_target_source);
    }
    // The sums are formed while the rows are at hand, although the last ones go unused.
    const std::span<const SourceRows> groups = search_.groups();
    sums_ = workers_.sum_blocks(groups.size(), kGroupBlock, StepEquations{}, [&](std::size_t begin, std::size_t end) {
      search_.locate(T_target_source, begin, end);
      return step_equations(groups.subspan(begin, end - begin), T_target_source.linear(), objective_);
    });
    return fit_of(sums_.pairs, sums_.squared_distances, source_.scan.size());
  }

  estimation::NormalEquations equations(const Eigen::Isometry3d& T_target_source, int iteration) override {
    return fast_ ? sums_.equations : Problem::equations(T_target_source, iteration);
  }

  Correspondences correspondences() override { return fast_ ? search_.pairs() : Problem::correspondences(); }

 private:
  const Source& source_;
  const Target& target_;
  const Objective& objective_;
  const Workers& workers_;
  CorrespondenceSearch search_;
  bool fast_;
  StepEquations sums_;  // at the pose asked for last
};

void check_inputs(const Source& source, const Target& target, const Objective& objective) {
  const bool target_normals =
      target.normals.size() == target.scan.size() && target.has_normal.size() == target.scan.size();
  const bool source_normals =
      source.normals.size() == source.scan.size() && source.has_normal.size() == source.scan.size();
  if (objective.geometry != GeometryTerm::kPointToPoint && !target_normals) {
    throw std::invalid_argument("align: this objective needs a normal for each target point");
  }
  if (objective.geometry == GeometryTerm::kPlaneToPlane && !(source_normals && objective.thickness > 0.0)) {
    throw std::invalid_argument("align: plane-to-plane needs a normal for each source point and a thickness above 0");
  }
  if (objective.doppler == DopplerTerm::kSensorVelocity && !(objective.vehicle.dt_s > 0.0)) {
    throw std::invalid_argument("align: the time between the scans must be above 0");
  }
}

}  // namespace

Objective dynamic_icp_objective(const AlignConfig& config) {
  Objective objective;
  objective.gate = {config.max_correspondence_distance_m, config.correspondence_range_scale};
  objective.doppler_weight = config.doppler_weight;
  objective.tukey_geometry_m = config.tukey_geometry_m;
  objective.tukey_doppler_mps = config.tukey_doppler_mps;
  return objective;
}

StopRule stop_rule(const MatchingConfig& config) {
  return {config.max_iterations, config.tolerance, 0.0, config.min_correspondences, config.rank_tolerance};
}

Alignment align(const Source& source, const Target& target, const Eigen::Isometry3d& T_initial,
                const Objective& objective, const StopRule& stop, const Workers& workers) {
  check_inputs(source, target, objective);
  ScanToScan problem(source, target, objective, workers);
  return minimise(problem, T_initial, typical_distance(source.scan), stop);
}

Alignment align(const Scan& source, const Target& target, const Eigen::Isometry3d& T_initial, const AlignConfig& config,
                const Workers& workers) {
  return align(Source{source}, target, T_initial, dynamic_icp_objective(config), stop_rule(config), workers);
}

}  // namespace dynamic_icp::registration
