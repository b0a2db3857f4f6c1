// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/objective.hpp"

#include <cmath>

#include "dynamic_icp/estimation/robust_kernel.hpp"
#include "dynamic_icp/registration/doppler_rotation.hpp"
#include "dynamic_icp/registration/point_to_plane.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kBlock = 512;

/// A term's share of the objective: its weight beside the other one and the scale of its Tukey kernel.
struct Share {
  double weight;
  double scale;
};

Residual geometry_residual(const Scan& source, const Target& target, const Correspondence& pair,
                           const Eigen::Isometry3d& T) {
  return point_to_plane(T * source.points()[pair.source], target.scan.points()[pair.target],
                        target.normals[pair.target]);
}

Residual doppler_residual(const Scan& source, const Target& target, const Correspondence& pair,
                          const Eigen::Isometry3d& T) {
  const Eigen::Vector3d ray = source.doppler()[pair.source] * source.directions()[pair.source];
  return doppler_rotation(T.linear() * ray, target.scan.directions()[pair.target], target.scan.doppler()[pair.target]);
}

void add_residual(Linearisation& sum, TermStatistics& statistics, const Residual& residual, const Share& share) {
  const double kernel_weight = estimation::tukey_weight(residual.value, share.scale);
  ++statistics.count;
  if (kernel_weight <= 0.0) {
    return;
  }
  ++statistics.inliers;
  statistics.rms += residual.value * residual.value;
  const double w = share.weight * kernel_weight;
  sum.equations.add(residual.jacobian, residual.value, w);
  const Vector6d gradient = w * residual.value * residual.jacobian;
  sum.score.selfadjointView<Eigen::Lower>().rankUpdate(gradient);
}

void add_statistics(TermStatistics& sum, const TermStatistics& part) {
  sum.count += part.count;
  sum.inliers += part.inliers;
  sum.rms += part.rms;
}

void sum_to_rms(TermStatistics& statistics) {
  statistics.rms = statistics.inliers > 0 ? std::sqrt(statistics.rms / static_cast<double>(statistics.inliers)) : 0.0;
}

/// So that parts can be summed block by block.
struct Part : Linearisation {
  Part& operator+=(const Part& other) {
    equations += other.equations;
    score += other.score;
    add_statistics(geometry, other.geometry);
    add_statistics(doppler, other.doppler);
    return *this;
  }
};

}  // namespace

Linearisation linearise(const Scan& source, const Target& target, const Correspondences& correspondences,
                        const Eigen::Isometry3d& T_target_source, const AlignConfig& config, const Workers& workers) {
  const Share geometry{1.0 - config.doppler_weight, config.tukey_geometry_m};
  const Share doppler{config.doppler_weight, config.tukey_doppler_mps};
  const std::vector<Correspondence>& pairs = correspondences.pairs;
  Part sum = workers.sum_blocks(pairs.size(), kBlock, Part{}, [&](std::size_t begin, std::size_t end) {
    Part part;
    for (std::size_t k = begin; k < end; ++k) {
      add_residual(part, part.geometry, geometry_residual(source, target, pairs[k], T_target_source), geometry);
      if (doppler.weight > 0.0) {
        add_residual(part, part.doppler, doppler_residual(source, target, pairs[k], T_target_source), doppler);
      }
    }
    return part;
  });
  sum_to_rms(sum.geometry);
  sum_to_rms(sum.doppler);
  sum.score = Matrix6d(sum.score.selfadjointView<Eigen::Lower>());
  return sum;
}

double cost(const Scan& source, const Target& target, const Correspondences& correspondences,
            const Eigen::Isometry3d& T_target_source, const AlignConfig& config) {
  double geometry = 0.0;
  double doppler = 0.0;
  for (const Correspondence& pair : correspondences.pairs) {
    geometry +=
        estimation::tukey_loss(geometry_residual(source, target, pair, T_target_source).value, config.tukey_geometry_m);
    doppler +=
        estimation::tukey_loss(doppler_residual(source, target, pair, T_target_source).value, config.tukey_doppler_mps);
  }
  return (1.0 - config.doppler_weight) * geometry + config.doppler_weight * doppler;
}

}  // namespace dynamic_icp::registration
