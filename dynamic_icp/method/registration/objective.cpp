// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/objective.hpp"

#include <cmath>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"
#include "dynamic_icp/method/registration/doppler_rotation.hpp"
#include "dynamic_icp/method/registration/plane_to_plane.hpp"
#include "dynamic_icp/method/registration/point_to_plane.hpp"
#include "dynamic_icp/method/registration/point_to_point.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kPairBlock = 512;

double kernel_weight(double residual, double tukey) {
  return std::isinf(tukey) ? 1.0 : estimation::tukey_weight(residual, tukey);
}

/// The residuals of one pair at one pose.
class PairTerms {
 public:
  PairTerms(const Source& source, const Target& target, const Eigen::Isometry3d& T, const Objective& objective)
      : source_(source), target_(target), T_(T), objective_(objective), theta_(log_so3(T.linear())) {}

  [[nodiscard]] Residual plane(const Correspondence& pair) const {
    return point_to_plane(moved(pair), target_.scan.points()[pair.target], target_.normals[pair.target]);
  }

  [[nodiscard]] VectorResidual point(const Correspondence& pair) const {
    return point_to_point(moved(pair), target_.scan.points()[pair.target]);
  }

  [[nodiscard]] Eigen::Matrix3d information(const Correspondence& pair) const {
    if (objective_.geometry == GeometryTerm::kPointToPoint) {
      return Eigen::Matrix3d::Identity();
    }
    return plane_to_plane_information(T_.linear() * normal(source_.normals, source_.has_normal, pair.source),
                                      normal(target_.normals, target_.has_normal, pair.target), objective_.thickness);
  }

  [[nodiscard]] Residual doppler(const Correspondence& pair) const {
    const double s = source_.scan.doppler()[pair.source];
    const Eigen::Vector3d& direction = source_.scan.directions()[pair.source];
    if (objective_.doppler == DopplerTerm::kSensorVelocity) {
      return sensor_velocity(theta_, T_.translation(), direction, s, objective_.vehicle);
    }
    const Eigen::Vector3d ray = s * direction;
    return doppler_rotation(T_.linear() * ray, target_.scan.directions()[pair.target],
                            target_.scan.doppler()[pair.target]);
  }

 private:
  [[nodiscard]] Eigen::Vector3d moved(const Correspondence& pair) const {
    return T_ * source_.scan.points()[pair.source];
  }

  static Eigen::Vector3d normal(std::span<const Eigen::Vector3d> normals, std::span<const std::uint8_t> has_normal,
                                std::uint32_t row) {
    return has_normal[row] != 0 ? normals[row] : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  const Source& source_;
  const Target& target_;
  const Eigen::Isometry3d& T_;
  const Objective& objective_;
  Eigen::Vector3d theta_;
};

void add_geometry(LinearisationSum& sum, const PairTerms& terms, const Correspondence& pair,
                  const Objective& objective) {
  const double share = has_doppler(objective) ? 1.0 - objective.doppler_weight : 1.0;
  if (objective.geometry == GeometryTerm::kPointToPlane) {
    const Residual residual = terms.plane(pair);
    sum.add_geometry(residual, share * kernel_weight(residual.value, objective.tukey_geometry_m));
  } else {
    const VectorResidual residual = terms.point(pair);
    sum.add_geometry(residual, terms.information(pair),
                     share * kernel_weight(residual.value.norm(), objective.tukey_geometry_m));
  }
}

}  // namespace

Linearisation linearise(const PairedScans& scans, const Eigen::Isometry3d& T_target_source, const Objective& objective,
                        int iteration, const Workers& workers) {
  const PairTerms terms(scans.source, scans.target, T_target_source, objective);
  const bool with_doppler = has_doppler(objective);
  const double tukey_doppler = iteration >= objective.tukey_doppler_from_iteration
                                   ? objective.tukey_doppler_mps
                                   : std::numeric_limits<double>::infinity();
  const bool rejects = objective.doppler != DopplerTerm::kNone && iteration >= objective.reject_from_iteration &&
                       std::isfinite(objective.reject_doppler_mps);
  const std::vector<Correspondence>& pairs = scans.correspondences.pairs;
  const LinearisationSum sum =
      workers.sum_blocks(pairs.size(), kPairBlock, LinearisationSum{}, [&](std::size_t begin, std::size_t end) {
        LinearisationSum part;
        for (std::size_t k = begin; k < end; ++k) {
          const Residual doppler = with_doppler || rejects ? terms.doppler(pairs[k]) : Residual{};
          if (rejects && std::abs(doppler.value) > objective.reject_doppler_mps) {
            continue;
          }
          add_geometry(part, terms, pairs[k], objective);
          if (with_doppler) {
            part.add_doppler(doppler, objective.doppler_weight * kernel_weight(doppler.value, tukey_doppler));
          }
        }
        return part;
      });
  return sum.finish();
}

}  // namespace dynamic_icp::registration
