// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/body_motion.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/window/principal_motions.hpp"

namespace dynamic_icp::window {
namespace {

// Bodies are smaller than what a map is made of, and their surfaces are bent.
constexpr double kFinestPatch_m = 0.25;
constexpr int kPatchLevels = 4;

constexpr int kPasses = 3;
constexpr double kBodyKernel = 4.0;         // Tukey's, in standard deviations
constexpr double kFirstSigma_m = 0.075;     // of where a body is, before its surfaces tell
constexpr double kMinPointSigma_m = 0.001;  // from a plane
constexpr double kModelSigma_m = 0.003;     // of a surface, from a plane
constexpr double kBodyBend = 0.4;           // the points of a scan on a patch meet part of its bend
constexpr double kBodyTilt = 0.3;           // a patch is off a plane in three places
constexpr double kPerPatch = 10.0;          // points of a patch share its error
constexpr double kFirstOmega_rad_s = 0.2;
constexpr double kFirstVelocity_mps = 1.0;
constexpr double kLittleInformation = 1e-6;

/// Where it was at the end of a path, and how it had turned until its beginning.
struct Believed {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
};

Believed along(const BodyPath& path) {
  Believed sum;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double half_s = 0.5 * (path[k - 1]->time_s - path[k]->time_s);
    sum.shift += half_s * (path[k - 1]->velocity + path[k]->velocity);
    sum.turn += half_s * (path[k - 1]->omega + path[k]->omega);
  }
  return sum;
}

}  // namespace

void BodyDoppler::state(StateArchive& archive) {
  archive(u, lever, s, columns.size, columns.index, columns.value);
  archive.require(columns.size <= FieldColumns::kCapacity, "the Doppler of a moving body");
}

void SeenBody::state(StateArchive& archive) { archive(id, time_s, centre, velocity, omega, points, doppler); }

BodyMotion motion_by_surfaces(const BodyPath& path, double max_noise_share, const Workers& workers) {
  const SeenBody& now = *path.front();
  const SeenBody& before = *path.back();
  const double dt_s = now.time_s - before.time_s;
  const Believed believed = along(path);
  mapping::PlaneMapConfig config;
  config.finest_cell_m = kFinestPatch_m;
  config.levels = kPatchLevels;
  config.memory_scans = 0.0;
  mapping::PlaneMap map(config);
  map.add(before.points, before.centre, workers);
  Vector6d first_sigma;
  first_sigma << Eigen::Vector3d::Constant(kFirstOmega_rad_s), Eigen::Vector3d::Constant(kFirstVelocity_mps);
  const Matrix6d prior = first_sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const double model_variance = kModelSigma_m * kModelSigma_m;

  BodyMotion motion;
  Vector6d d = Vector6d::Zero();
  for (int pass = 0; pass < kPasses; ++pass) {
    const Eigen::Matrix3d back = exp_so3(-believed.turn - dt_s * d.head<3>());
    const Eigen::Vector3d then = now.centre - believed.shift - dt_s * d.tail<3>();
    const double unknown = pass == 0 ? kFirstSigma_m * kFirstSigma_m : 0.0;
    MotionInformation shown;
    shown.all = kLittleInformation * Matrix6d::Identity();
    Vector6d E = Vector6d::Zero();
    motion.points = 0;
    for (const Eigen::Vector3d& point : now.points) {
      const Eigen::Vector3d lever = back * (point - now.centre);
      const Eigen::Vector3d moved = then + lever;
      const mapping::Patch* const patch = map.find(moved);
      if (patch == nullptr) {
        continue;
      }
      const mapping::Plane& plane = patch->plane;
      const double e = plane.distance(moved);
      const double own = std::max(plane.variance, kMinPointSigma_m * kMinPointSigma_m);
      const double in_common = plane.height_variance(moved) + model_variance + kBodyBend * plane.bend;
      const double inside = std::max(0.0, 1.0 - e * e / (kBodyKernel * kBodyKernel * (own + in_common + unknown)));
      const double w = inside * inside / (own + kPerPatch * in_common);
      if (w <= 0.0) {
        continue;
      }
      ++motion.points;
      Vector6d m;
      m << lever.cross(plane.normal), plane.normal;
      m *= dt_s;
      shown.all += w * m * m.transpose();
      E += w * (e + m.dot(d)) * m;
      const double of_normal = plane.variance / plane.points + kBodyTilt * model_variance;
      Eigen::Matrix<double, 6, 3> A;
      A << skew(lever), Eigen::Matrix3d::Identity();
      shown.noise += (w * of_normal * dt_s * dt_s) * A * plane.tangential * A.transpose();
    }
    const PrincipalMotions principal = principal_motions(shown);
    const Vector6d held = (1.0 - principal.noise_shares.array() / max_noise_share).max(0.0).min(1.0);
    const Matrix6d along_principal = principal.motions.transpose() * shown.all;  // V^-1, as V^T all V = 1
    motion.A = along_principal.transpose() * held.asDiagonal() * along_principal;
    motion.b = along_principal.transpose() * (held.asDiagonal() * (principal.motions.transpose() * E));
    d = (motion.A + prior).ldlt().solve(motion.b);
  }
  return motion;
}

}  // namespace dynamic_icp::window
