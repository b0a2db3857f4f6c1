// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/rig_regression.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/doppler_fit.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/doppler_sums.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr int kMaxRigSteps = 20;
constexpr double kStepTolerance_mps = 3e-4;
constexpr double kUnknownVelocity_mps = 30.0;
constexpr double kUnknownRotation_rad_s = 10.0;
constexpr double kStartRotation_rad_s = 0.5;  // of a vehicle at its first scan

// The unknowns X = [v; a; omega; alpha; b_1 .. b_K], the last three as changes of what was taken out of the Doppler.
constexpr Eigen::Index kOmega = 6;
constexpr Eigen::Index kBias = 12;

/// The rows of one sensor, and how its own unknowns [v_k; a_k; b_k] (doppler_sums.hpp) follow from those of the rig.
struct SensorRows {
  DopplerRows rows;
  Eigen::MatrixXd A;  ///< 7 x (12 + K)
  RobustScale scale;
};

/// The times of all sensors count from one reference.
void move_reference(double reference_time_s, bool takes_time, DopplerRows& rows) {
  for (double& dt : rows.dt) {
    dt += takes_time ? rows.reference_time_s - reference_time_s : 0.0;
  }
  rows.reference_time_s = reference_time_s;
  rows.takes_time = takes_time;
}

/// v_k = v + omega x l_k = v - [l_k]x omega; the same for the accelerations.
Eigen::MatrixXd unknowns_of_sensor(const Eigen::Vector3d& lever_arm, std::size_t sensor, std::size_t sensors) {
  const auto k = static_cast<Eigen::Index>(sensor);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(7, kBias + static_cast<Eigen::Index>(sensors));
  A.leftCols<6>().topRows<6>().setIdentity();
  A.block<3, 3>(0, kOmega) = -skew(lever_arm);
  A.block<3, 3>(3, kOmega + 3) = -skew(lever_arm);
  A(6, kBias + k) = 1.0;
  return A;
}

std::vector<SensorRows> sorted_rows(const Scan& scan, double reference_time_s, const Vector7d& start,
                                    const ConsensusRegressionConfig& config, const Workers& workers) {
  const std::vector<std::vector<std::uint32_t>> rows = rows_by_sensor(scan);
  const bool takes_time =
      scan.has_times() && std::ranges::adjacent_find(scan.times(), std::ranges::not_equal_to{}) != scan.times().end();
  std::vector<SensorRows> sensors(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    SensorRows& sensor = sensors[k];
    sensor.rows = sort_into_cells(scan.select(rows[k]), config.cell_size_m, workers);
    move_reference(reference_time_s, takes_time, sensor.rows);
    sensor.A = unknowns_of_sensor(scan.mountings()[k].translation(), k, rows.size());
    const double noise = noise_from_neighbours(sensor.rows, start, config.min_noise_mps, config.max_noise_mps);
    sensor.scale = {noise, config.tukey_cutoff * noise, config.surface_noise_mps};
  }
  return sensors;
}

double longest_sweep(const std::vector<SensorRows>& sensors) {
  double longest_s = 0.0;
  for (const SensorRows& sensor : sensors) {
    longest_s = std::max(longest_s, sensor.rows.duration_s);
  }
  return longest_s;
}

/// Normal equations of all sensors at X. The scatter S of the gradients of direction sectors, whose residuals may
/// depend on each other, is the covariance of the gradient g of a sensor with the normal matrix H: its own unknowns are
/// known with H S^-1 H, and it pulls with H S^-1 g. So a sensor that the model fits badly, as when the acceleration
/// changes within its sweep, counts less.
struct RigSums {
  Eigen::MatrixXd information;  ///< without priors
  Eigen::VectorXd gradient;
  double squared = 0.0;  ///< (m/s)^2, sum over the inliers
  std::size_t inliers = 0;
  bool widened = false;
};

RigSums sum_rig(std::vector<SensorRows>& sensors, const Eigen::VectorXd& X, double max_noise_mps,
                const Workers& workers) {
  RigSums sums;
  sums.information = Eigen::MatrixXd::Zero(X.size(), X.size());
  sums.gradient = Eigen::VectorXd::Zero(X.size());
  for (SensorRows& sensor : sensors) {
    std::vector<Vector7d> cell_gradients;
    const FitSums part = sum_fit(sensor.rows, sensor.A * X, sensor.scale, true, workers, &cell_gradients);
    const double slope = part.weights > 0.0 ? std::clamp(part.slopes / part.weights, 0.5, 1.0) : 1.0;
    const Matrix7d H = slope * part.H;
    Matrix7d scatter = gradient_scatter(sensor.rows, part.H, cell_gradients);
    scatter.diagonal().array() += 1e-9 * (1.0 + scatter.trace());  // an unknown that no row sees
    const Matrix7d weight = scatter.ldlt().solve(H).transpose();
    sums.information += sensor.A.transpose() * (weight * H) * sensor.A;
    sums.gradient += sensor.A.transpose() * (weight * part.gradient);
    sums.squared += part.inlier_squared;
    sums.inliers += part.inliers;
    sums.widened = widen_if_too_narrow(part, max_noise_mps, sensor.scale) || sums.widened;
  }
  return sums;
}

/// Inverse covariance of the priors and their mean, in the unknowns X.
struct Priors {
  Eigen::VectorXd mean;
  Eigen::MatrixXd information;
};

Priors priors_of(const RigPrior& rig, const AngularMotion& expected, const RigDoppler& reduced,
                 const EgoVelocity& start) {
  const Eigen::Index K = reduced.bias_mps.size();
  Eigen::MatrixXd covariance = rig.covariance;
  Priors priors;
  priors.mean = Eigen::VectorXd::Zero(kBias + K);
  priors.mean.head<6>() = rig.mean.head<6>();
  priors.mean.segment<3>(kOmega) = expected.mean.head<3>() - reduced.omega;
  priors.mean.segment<3>(kOmega + 3) = expected.mean.tail<3>() - reduced.alpha;
  priors.mean.tail(K) = rig.mean.tail(K) - reduced.bias_mps;
  if (!agrees(as_ego_prior(rig), start.velocity_sensor)) {
    covariance.topRows<6>().setZero();
    covariance.leftCols<6>().setZero();
    covariance.diagonal().head<3>().setConstant(kUnknownVelocity_mps * kUnknownVelocity_mps);
    covariance.diagonal().segment<3>(3) =
        rig.covariance.diagonal().segment<3>(3).cwiseMax(EgoPrior::default_covariance().diagonal().segment<3>(3));
    priors.mean.head<3>() = start.velocity_sensor;
  }
  const Eigen::MatrixXd of_rig = covariance.ldlt().solve(Eigen::MatrixXd::Identity(6 + K, 6 + K));
  priors.information = Eigen::MatrixXd::Zero(kBias + K, kBias + K);
  priors.information.topLeftCorner<6, 6>() = of_rig.topLeftCorner<6, 6>();
  priors.information.topRightCorner(6, K) = of_rig.topRightCorner(6, K);
  priors.information.bottomLeftCorner(K, 6) = of_rig.bottomLeftCorner(K, 6);
  priors.information.bottomRightCorner(K, K) = of_rig.bottomRightCorner(K, K);
  priors.information.block<6, 6>(kOmega, kOmega) = Matrix6d(expected.covariance).ldlt().solve(Matrix6d::Identity());
  return priors;
}

/// Gauss-Newton steps from X; returns the sums at the end.
RigSums minimise(std::vector<SensorRows>& sensors, const Priors& priors, double max_noise_mps, const Workers& workers,
                 Eigen::VectorXd& X) {
  RigSums sums = sum_rig(sensors, X, max_noise_mps, workers);
  for (int step = 0; step < kMaxRigSteps; ++step) {
    const Eigen::MatrixXd information = sums.information + priors.information;
    const Eigen::VectorXd change = -information.ldlt().solve(sums.gradient + priors.information * (X - priors.mean));
    const bool is_done = !sums.widened && change.head<3>().norm() < kStepTolerance_mps;
    X += change;
    sums = sum_rig(sensors, X, max_noise_mps, workers);
    if (is_done) {
      break;
    }
  }
  return sums;
}

/// What the rows say of [omega; alpha] after all else is solved for (Schur's complement).
AngularInformation angular_information(const RigSums& sums, const Priors& priors, const Eigen::VectorXd& X,
                                       const RigDoppler& reduced) {
  Eigen::MatrixXd of_others = priors.information;
  of_others.block<6, 6>(kOmega, kOmega).setZero();
  const Eigen::MatrixXd all = sums.information + of_others;
  const Eigen::VectorXd pull = -(sums.gradient + of_others * (X - priors.mean));
  std::vector<Eigen::Index> rest;
  for (Eigen::Index i = 0; i < X.size(); ++i) {
    if (i < kOmega || i >= kBias) {
      rest.push_back(i);
    }
  }
  const Eigen::MatrixXd coupling = all(rest, Eigen::seqN(kOmega, 6));
  const Eigen::LDLT<Eigen::MatrixXd> solver(all(rest, rest));
  const Eigen::VectorXd rest_pull = pull(rest);
  AngularInformation result;
  result.at << reduced.omega + X.segment<3>(kOmega), reduced.alpha + X.segment<3>(kOmega + 3);
  result.information = all.block<6, 6>(kOmega, kOmega) - coupling.transpose() * solver.solve(coupling);
  result.weighted_change = pull.segment<6>(kOmega) - coupling.transpose() * solver.solve(rest_pull);
  return result;
}

/// False when rows that hardly determine the motion have carried it away from anything that moves.
bool is_plausible_rig(const Eigen::VectorXd& X, const Eigen::MatrixXd& covariance) {
  return X.allFinite() && covariance.allFinite() && covariance.diagonal().minCoeff() > 0.0 &&
         X.head<3>().norm() <= kMaxDoppler_mps && X.segment<3>(3).norm() <= kMaxAcceleration_mps2 &&
         X.segment<3>(kOmega).norm() <= kUnknownRotation_rad_s;
}

/// omega by the Doppler alone: alpha is a guess then, of the size that vehicles have.
AngularVelocity alone(const AngularInformation& doppler, const AngularMotion& expected) {
  Matrix6d information = doppler.information;
  information.topLeftCorner<3, 3>().diagonal().array() += 1.0 / (kUnknownRotation_rad_s * kUnknownRotation_rad_s);
  const Eigen::Matrix3d of_alpha = expected.covariance.bottomRightCorner<3, 3>();
  information.bottomRightCorner<3, 3>() += of_alpha.inverse();
  Vector6d change = doppler.weighted_change;
  change.tail<3>() += of_alpha.inverse() * (expected.mean.tail<3>() - doppler.at.tail<3>());
  const Matrix6d covariance = information.ldlt().solve(Matrix6d::Identity());
  return {doppler.at.head<3>() + (covariance * change).head<3>(), covariance.topLeftCorner<3, 3>()};
}

/// Averages over whether the sensors of the rig are calibrated: `average_over_bias_models` for several biases.
void average_over_bias_models(const DriftConfig& drift, Eigen::VectorXd& mean, Eigen::MatrixXd& covariance) {
  const Eigen::Index K = mean.size() - 6;
  const Eigen::MatrixXd of_bias = covariance.bottomRightCorner(K, K);
  const Eigen::VectorXd bias = mean.tail(K);
  const Eigen::MatrixXd uncertain = of_bias + kCalibratedVariance * Eigen::MatrixXd::Identity(K, K);
  const double presumed = drift.start_bias_mps * drift.start_bias_mps;
  const Eigen::LDLT<Eigen::MatrixXd> solver(uncertain);
  const double log_odds = -0.5 * (bias.dot(solver.solve(bias)) + solver.vectorD().array().log().sum() -
                                  static_cast<double>(K) * std::log(presumed));
  const double probability = 1.0 / (1.0 + std::exp(std::clamp(-log_odds, -50.0, 50.0)));
  const Eigen::MatrixXd gain = solver.solve(covariance.bottomRows(K)).transpose();
  const Eigen::VectorXd apart = -gain * bias;
  mean += probability * apart;
  covariance += probability * ((1.0 - probability) * apart * apart.transpose() - gain * of_bias * gain.transpose());
}

}  // namespace

std::vector<std::vector<std::uint32_t>> rows_by_sensor(const Scan& scan) {
  std::vector<std::vector<std::uint32_t>> rows(scan.mountings().size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    rows[scan.channels().sensor[i]].push_back(static_cast<std::uint32_t>(i));
  }
  return rows;
}

void reduce_to_origin(Scan& scan, const RigDoppler& rig, const Workers& workers, double sign) {
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const std::uint8_t k = scan.channels().sensor[i];
    const double dt = scan.has_times() ? scan.times()[i] - rig.reference_time_s : 0.0;
    const Eigen::Vector3d of_lever_arm = (rig.omega + dt * rig.alpha).cross(scan.mountings()[k].translation());
    scan.shift_doppler(i, sign * (scan.directions()[i].dot(of_lever_arm) - rig.bias_mps[k]));
  });
}

RigPrior first_rig_prior(const DriftConfig& config, std::size_t sensors) {
  const auto K = static_cast<Eigen::Index>(sensors);
  const EgoPrior single = first_prior(config);
  RigPrior prior;
  prior.mean = Eigen::VectorXd::Zero(6 + K);
  prior.covariance = Eigen::MatrixXd::Zero(6 + K, 6 + K);
  prior.covariance.diagonal().head<3>().setConstant(kUnknownVelocity_mps * kUnknownVelocity_mps);
  prior.covariance.diagonal().segment<3>(3) = single.covariance.diagonal().segment<3>(3);
  prior.covariance.diagonal().tail(K).setConstant(single.covariance(6, 6));
  return prior;
}

RigPrior predict(const RigPrior& filtered, double dt_s, const DriftConfig& config) {
  const Eigen::Index n = filtered.mean.size();
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n, n);
  F.block<3, 3>(0, 3) = dt_s * Eigen::Matrix3d::Identity();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, 3);
  G.topRows<3>() = 0.5 * dt_s * dt_s * Eigen::Matrix3d::Identity();
  G.middleRows<3>(3) = dt_s * Eigen::Matrix3d::Identity();
  RigPrior prior = filtered;
  prior.mean = F * filtered.mean;
  prior.covariance = F * filtered.covariance * F.transpose() + config.jerk_mps3 * config.jerk_mps3 * G * G.transpose();
  prior.covariance.diagonal().tail(n - 6).array() += config.bias_drift_mps * config.bias_drift_mps * dt_s;
  return prior;
}

EgoPrior as_ego_prior(const RigPrior& prior) {
  EgoPrior single;
  single.has_velocity = prior.has_velocity;
  single.mean.head<6>() = prior.mean.head<6>();
  single.covariance.topLeftCorner<6, 6>() = prior.covariance.topLeftCorner<6, 6>();
  single.covariance(6, 6) = prior.covariance.diagonal().tail(prior.mean.size() - 6).mean();
  return single;
}

AngularVelocity rig_angular_velocity(std::span<const Eigen::Isometry3d> mountings,
                                     std::span<const EgoVelocity> of_sensors) {
  Matrix6d information = Matrix6d::Zero();
  information.topLeftCorner<3, 3>().diagonal().setConstant(1.0 / (kUnknownVelocity_mps * kUnknownVelocity_mps));
  information.bottomRightCorner<3, 3>().diagonal().setConstant(1.0 / (kStartRotation_rad_s * kStartRotation_rad_s));
  Vector6d right = Vector6d::Zero();
  for (std::size_t k = 0; k < of_sensors.size(); ++k) {
    const Eigen::Matrix3d weight = of_sensors[k].covariance.inverse();
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -skew(mountings[k].translation());
    information += J.transpose() * weight * J;
    right += J.transpose() * weight * of_sensors[k].velocity_sensor;
  }
  const Matrix6d covariance = information.ldlt().solve(Matrix6d::Identity());
  return {(covariance * right).tail<3>(), covariance.bottomRightCorner<3, 3>()};
}

AngularVelocity rig_angular_velocity(const Scan& scan, const ConsensusRegressionConfig& config,
                                     const DriftConfig& drift, const Workers& workers) {
  std::vector<EgoVelocity> of_sensors;
  for (const std::vector<std::uint32_t>& rows : rows_by_sensor(scan)) {
    of_sensors.push_back(estimate_velocity(scan.select(rows), first_prior(drift), config, workers));
  }
  return rig_angular_velocity(scan.mountings(), of_sensors);
}

RigEstimate estimate_rig_motion(const Scan& scan, const RigDoppler& reduced, const EgoVelocity& start,
                                const RigPrior& prior, const AngularMotion& expected,
                                const ConsensusRegressionConfig& config, const DriftConfig& drift,
                                const Workers& workers) {
  RigEstimate result;
  result.ego = start;
  result.doppler = reduced;
  result.rotation.at = expected.mean;
  result.filtered = prior;
  if (start.status == EgoVelocityStatus::kTooFewPoints || start.status == EgoVelocityStatus::kAmbiguous) {
    return result;
  }
  const Priors priors = priors_of(prior, expected, reduced, start);
  Vector7d start_unknowns;
  start_unknowns << start.velocity_sensor, start.acceleration_sensor, 0.0;
  std::vector<SensorRows> sensors = sorted_rows(scan, reduced.reference_time_s, start_unknowns, config, workers);
  Eigen::VectorXd X = Eigen::VectorXd::Zero(priors.mean.size());
  X.head<6>() = start_unknowns.head<6>();
  const RigSums sums = minimise(sensors, priors, config.max_noise_mps, workers, X);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd(sums.information + priors.information)
                                         .ldlt()
                                         .solve(Eigen::MatrixXd::Identity(X.size(), X.size()));
  if (!is_plausible_rig(X, covariance)) {
    return result;
  }
  result.rotation = angular_information(sums, priors, X, reduced);

  const Eigen::Index K = reduced.bias_mps.size();
  std::vector<Eigen::Index> kept = {0, 1, 2, 3, 4, 5};
  for (Eigen::Index k = 0; k < K; ++k) {
    kept.push_back(kBias + k);
  }
  result.filtered.has_velocity = true;
  result.filtered.mean = X(kept);
  result.filtered.mean.tail(K) += reduced.bias_mps;
  result.filtered.covariance = covariance(kept, kept);
  result.filtered.covariance.diagonal().head<3>().array() += floor_variance(longest_sweep(sensors));
  result.filtered.covariance.diagonal().tail(K).array() += floor_variance(0.0);
  Eigen::VectorXd mean = result.filtered.mean;
  Eigen::MatrixXd of_mean = result.filtered.covariance;
  average_over_bias_models(drift, mean, of_mean);

  result.doppler.omega = reduced.omega + X.segment<3>(kOmega);
  result.doppler.alpha = reduced.alpha + X.segment<3>(kOmega + 3);
  result.doppler.bias_mps = mean.tail(K);
  result.ego.velocity_sensor = mean.head<3>();
  result.ego.acceleration_sensor = mean.segment<3>(3);
  result.ego.bias_mps = 0.0;
  result.ego.joint_covariance.setZero();
  result.ego.joint_covariance.topLeftCorner<6, 6>() = of_mean.topLeftCorner<6, 6>();
  result.ego.joint_covariance(6, 6) = of_mean.diagonal().tail(K).mean();
  result.ego.covariance = of_mean.topLeftCorner<3, 3>();
  result.ego.bias_variance = 0.0;
  result.ego.inliers = sums.inliers;
  result.ego.inlier_rms_mps =
      sums.inliers > 0 ? std::sqrt(sums.squared / static_cast<double>(sums.inliers)) : start.inlier_rms_mps;
  result.ego.rotation = alone(result.rotation, expected);
  return result;
}

}  // namespace dynamic_icp::ego_motion
