// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/ego_motion/doppler_fit.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/velocity_modes.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kMinPoints = 3;
constexpr std::size_t kRowsForHypotheses = 600;  // a share of 0.3 is then known to 0.02
constexpr std::size_t kRowsForModes = 2500;      // and the few modes that remain are distinguished by twice that
constexpr int kMaxSteps = 20;
constexpr double kStepToleranceMps = 3e-4;  // a tenth of the standard deviation of a good estimate
constexpr double kUnobservableSigma_mps =
    2.0;                                 // who knows a component no better than this knows it better by any prior
constexpr double kMinVariance = 1e-12;   // a prior without any doubt must not divide by zero
constexpr double kUnknown_mps = 30.0;    // of a velocity of which nothing is known
constexpr double kBonusSigma_mps = 0.3;  // a velocity this near to the expected one still earns most of its bonus

// Refining a mode: the first steps look farther than the cutoff, because a mode begins away from its best velocity.
constexpr double kFirstStepsWider = 1.5;
constexpr int kCoarseSteps = 3;              // bring a sample of three points to within the noise
constexpr int kFineSteps = 4;                // and one more where acceleration and bias follow
constexpr double kFixed = 1e9;               // information of an unknown that is not estimated
constexpr double kCoarseNoise = 0.5;         // of inlier_threshold_mps, as long as the noise of the scan is unknown,
constexpr double kCoarseCutoff = 2.0;        // and the cutoff that goes with it
constexpr double kMinShareOfBest = 0.5;      // dynamic outliers may gather half of the support, but hardly more
constexpr std::size_t kFineHypotheses = 63;  // with the mode itself a multiple of the lanes of find_modes
constexpr std::size_t kMaxParts = 3;         // the static scene and slow movers on either side of it
constexpr double kFineReach = 2.0;           // of inlier_threshold_mps: what is farther belongs to another mode
constexpr double kFineWidth = 3.0;           // sigmas of the noise: nearly all static points support the static scene
constexpr double kFineResolution = 2.0;      // sigmas of the noise: nearer velocities cannot be distinguished
// Rows of one object err together, so a row counts for a ninth: acceleration and bias must not bend a mode through the
// static scene and slow movers where the scene itself says little about them.
constexpr double kCorrelatedNoise = 3.0;

// Priors of acceleration and bias cost a mode nothing within two sigmas; beyond, they do as with twice the sigma.
constexpr double kFreeSigmas2 = 4.0;
constexpr double kPriorDecay = 0.125;

/// The priors of acceleration and bias alone: the search for the static scene must not lean on an earlier velocity.
DopplerModel consensus_model(const EgoPrior& prior) {
  DopplerModel model;
  model.prior.tail<4>() = prior.mean.tail<4>();
  for (Eigen::Index k = 3; k < 7; ++k) {
    model.information(k, k) = 1.0 / std::max(prior.covariance(k, k), kMinVariance);
  }
  return model;
}

/// The same after a velocity that nobody expected: neither is the acceleration what it was.
EgoPrior inflated(const EgoPrior& prior) {
  EgoPrior open = prior;
  const Matrix7d start = EgoPrior::default_covariance();
  for (Eigen::Index k = 3; k < 6; ++k) {
    open.covariance(k, k) = std::max(prior.covariance(k, k), start(k, k));
  }
  return open;
}

/// The whole prior, for the fit to all points of the static scene.
DopplerModel fitting_model(const EgoPrior& prior) {
  DopplerModel model;
  model.prior = prior.mean;
  Matrix7d covariance = prior.covariance;
  covariance.diagonal().array() += kMinVariance;
  model.information = covariance.ldlt().solve(Matrix7d::Identity());
  return model;
}

/// A few steps on the rows that vote, the last with the cutoff, those before with a wider one.
void refine(const DopplerRows& consensus_set, const DopplerModel& model, const RobustScale& scale, int steps,
            const Workers& workers, Vector7d& x) {
  RobustScale wide = scale;
  wide.cutoff_mps *= kFirstStepsWider;
  for (int k = 0; k < steps; ++k) {
    const FitSums sums = sum_fit(consensus_set, x, k + 1 < steps ? wide : scale, workers);
    x += solve_fit(sums, x, model, kUnobservableSigma_mps).step;
  }
}

/// Keeps the first of those that look the same.
void remove_duplicates(const DopplerRows& consensus_set, double width_mps, std::vector<VelocityMode>& modes) {
  std::ranges::stable_sort(modes, [](const auto& a, const auto& b) { return a.inlier_weight > b.inlier_weight; });
  const StateDistance distance(consensus_set);
  std::vector<VelocityMode> kept;
  for (const VelocityMode& mode : modes) {
    const bool is_new =
        std::ranges::all_of(kept, [&](const VelocityMode& other) { return distance(mode.x, other.x) > width_mps; });
    if (is_new) {
      kept.push_back(mode);
    }
  }
  modes = std::move(kept);
}

/// Modes that differ by more than the width of a vote, refined for the velocity alone: as long as half of what counts
/// may be dynamic outliers, a free acceleration and bias would bend towards it.
std::vector<VelocityMode> coarse_modes(const ConsensusSet& consensus_set, const EgoPrior& prior,
                                       const DopplerModel& model, const ConsensusRegressionConfig& config,
                                       const Workers& workers) {
  Vector7d start = model.prior;
  start.head<3>() = prior.has_velocity ? Eigen::Vector3d(prior.mean.head<3>()) : Eigen::Vector3d::Zero();
  ModeSearch search;
  search.hypotheses = static_cast<std::size_t>(config.hypotheses);
  search.width_mps = config.inlier_threshold_mps;
  search.acceleration_sigma =
      consensus_set.rows.takes_time ? std::sqrt(prior.covariance.diagonal().segment<3>(3).mean()) : 0.0;
  std::vector<VelocityMode> modes = find_modes(consensus_set, start, search, workers);
  DopplerModel velocity_only = model;
  velocity_only.information.diagonal().tail<4>().setConstant(kFixed);
  const RobustScale scale{kCoarseNoise * config.inlier_threshold_mps, kCoarseCutoff * config.inlier_threshold_mps, 0.0};
  workers.for_each(modes.size(), 1, [&](std::size_t k) {
    VelocityMode& mode = modes[k];
    refine(consensus_set.rows, velocity_only, scale, kCoarseSteps, workers, mode.x);
    mode.inlier_weight = inlier_weight(consensus_set, mode.x, config.inlier_threshold_mps);
  });
  remove_duplicates(consensus_set.rows, config.inlier_threshold_mps, modes);
  const double enough = kMinShareOfBest * modes.front().inlier_weight;
  std::erase_if(modes, [&](const VelocityMode& mode) { return mode.inlier_weight < enough; });
  return modes;
}

/// Splits a mode into what the noise can tell apart, such as the static scene and dynamic outliers that creep.
std::vector<VelocityMode> split_mode(const ConsensusSet& consensus_set, const VelocityMode& mode,
                                     const DopplerModel& model, const ConsensusRegressionConfig& config,
                                     double noise_mps, const Workers& workers) {
  ModeSearch search;
  search.hypotheses = kFineHypotheses;
  search.max_modes = kMaxParts;
  search.width_mps = std::min(config.inlier_threshold_mps, config.tukey_cutoff * noise_mps);
  search.within_mps = kFineReach * config.inlier_threshold_mps;
  search.seed = 1;
  std::vector<VelocityMode> parts = find_modes(consensus_set, mode.x, search, workers);
  for (VelocityMode& part : parts) {
    refine(consensus_set.rows, model, {kCorrelatedNoise * noise_mps, config.tukey_cutoff * noise_mps, 0.0}, kFineSteps,
           workers, part.x);
    part.inlier_weight = inlier_weight(consensus_set, part.x, kFineWidth * noise_mps);
  }
  remove_duplicates(consensus_set.rows, kFineResolution * noise_mps, parts);
  return parts;
}

/// The velocity that is expected, as the rows near it have it. Along what a narrow view hardly shows, upwards most of
/// all, the other modes bend until they explain some of the traffic, too.
VelocityMode expected_mode(const ConsensusSet& consensus_set, const EgoPrior& prior,
                           const ConsensusRegressionConfig& config, double noise_mps, const Workers& workers) {
  VelocityMode mode;
  mode.x = prior.mean;
  refine(consensus_set.rows, fitting_model(prior), {kCorrelatedNoise * noise_mps, config.tukey_cutoff * noise_mps, 0.0},
         kFineSteps, workers, mode.x);
  return mode;
}

/// What the priors say of a mode, as a factor of its support. Acceleration and bias within two standard deviations cost
/// nothing; beyond, a mode that needs them bends through the static scene and dynamic outliers. The velocity prior is
/// only a bonus: it decides between modes of similar support and cannot hold a velocity that the scan does not bear
/// out.
double prior_factor(const EgoPrior& prior, const DopplerModel& model, const Vector7d& x, double weight) {
  const double deviation2 = (x - model.prior).cwiseAbs2().dot(model.information.diagonal());
  const double plausible = std::exp(-kPriorDecay * std::max(0.0, deviation2 - kFreeSigmas2));
  if (!prior.has_velocity) {
    return plausible;
  }
  const Eigen::Vector3d difference = x.head<3>() - prior.mean.head<3>();
  const Eigen::Matrix3d covariance =
      prior.covariance.topLeftCorner<3, 3>() + kBonusSigma_mps * kBonusSigma_mps * Eigen::Matrix3d::Identity();
  return plausible * (1.0 + weight * std::exp(-0.5 * difference.dot(covariance.ldlt().solve(difference))));
}

/// The static scene, as far as votes can tell.
struct ModeHypothesis {
  Vector7d x = Vector7d::Zero();
  double noise_mps = 0.0;
  double support = 0.0;
  bool ambiguous = false;
};

ModeHypothesis choose_mode(const DopplerRows& rows, const EgoPrior& prior, const DopplerModel& model,
                           const ConsensusRegressionConfig& config, const Workers& workers) {
  ConsensusSet few;
  ConsensusSet many;
  workers.both([&] { few = sample(rows, kRowsForHypotheses); }, [&] { many = sample(rows, kRowsForModes); });
  const std::vector<VelocityMode> coarse = coarse_modes(few, prior, model, config, workers);
  // A wrong velocity turns differences of direction into noise, so the smallest estimate is the right one.
  ModeHypothesis hypothesis;
  hypothesis.noise_mps = config.max_noise_mps;
  for (const VelocityMode& mode : coarse) {
    hypothesis.noise_mps =
        std::min(hypothesis.noise_mps, noise_from_neighbours(rows, mode.x, config.min_noise_mps, config.max_noise_mps));
  }
  std::vector<std::vector<VelocityMode>> parts(coarse.size());
  workers.for_each(coarse.size(), 1, [&](std::size_t k) {
    parts[k] = split_mode(few, coarse[k], model, config, hypothesis.noise_mps, workers);
  });
  std::vector<VelocityMode> modes;
  for (const std::vector<VelocityMode>& of_one : parts) {
    modes.insert(modes.end(), of_one.begin(), of_one.end());
  }
  if (prior.has_velocity) {
    modes.push_back(expected_mode(few, prior, config, hypothesis.noise_mps, workers));
  }
  workers.for_each(modes.size(), 1, [&](std::size_t k) {
    VelocityMode& mode = modes[k];
    mode.inlier_weight = inlier_weight(many, mode.x, kFineWidth * hypothesis.noise_mps) *
                         prior_factor(prior, model, mode.x, config.prior_weight);
  });
  remove_duplicates(few.rows, config.tukey_cutoff * hypothesis.noise_mps, modes);
  const double enough = config.ambiguity_ratio * modes.front().inlier_weight;
  hypothesis.ambiguous = modes.size() > 1 && modes[1].inlier_weight > enough;
  // Where votes do not decide, the one that is expected.
  const auto expected = std::ranges::find_if(
      modes, [&](const VelocityMode& mode) { return mode.inlier_weight > enough && agrees(prior, mode.x.head<3>()); });
  const VelocityMode& chosen = expected == modes.end() ? modes.front() : *expected;
  hypothesis.x = chosen.x;
  hypothesis.support = chosen.inlier_weight;
  return hypothesis;
}

/// All points near the winner.
struct Fit {
  Vector7d x = Vector7d::Zero();
  FitSums sums;  ///< at x
  Eigen::Matrix3d open = Eigen::Matrix3d::Zero();
  Matrix7d covariance = Matrix7d::Zero();
  int iterations = 0;
  bool converged = false;
};

Fit fit_all(const DopplerRows& rows, const ModeHypothesis& hypothesis, const EgoPrior& prior,
            const ConsensusRegressionConfig& config, const Workers& workers) {
  const bool as_expected = agrees(prior, hypothesis.x.head<3>());
  const DopplerModel without_velocity = consensus_model(prior.has_velocity && !as_expected ? inflated(prior) : prior);
  const DopplerModel model = as_expected ? fitting_model(prior) : without_velocity;
  RobustScale scale{hypothesis.noise_mps, config.tukey_cutoff * hypothesis.noise_mps, config.surface_noise_mps};
  Fit fit;
  fit.x = hypothesis.x;
  while (!fit.converged && fit.iterations < kMaxSteps) {
    const FitSums sums = sum_fit(rows, fit.x, scale, workers);
    const bool too_narrow = widen_if_too_narrow(sums, config.max_noise_mps, scale);
    const FitStep step = solve_fit(sums, fit.x, model, kUnobservableSigma_mps);
    fit.x += step.step;
    ++fit.iterations;
    fit.converged = !too_narrow && step.step.head<3>().norm() < kStepToleranceMps;
  }
  std::vector<Vector7d> gradients;
  fit.sums = sum_fit(rows, fit.x, scale, workers, &gradients);
  // What the lines of sight leave open is open even where the prior fills the gap.
  fit.open = solve_fit(fit.sums, fit.x, without_velocity, kUnobservableSigma_mps).open;
  fit.covariance = sandwich_covariance(rows, fit.sums, fit.open, model, gradients);
  return fit;
}

EgoVelocityStatus status_of(const Fit& fit, const ModeHypothesis& hypothesis) {
  if (hypothesis.ambiguous) {
    return EgoVelocityStatus::kAmbiguous;
  }
  if (!fit.open.isZero(0.0)) {
    return EgoVelocityStatus::kDegenerate;
  }
  return fit.converged ? EgoVelocityStatus::kConverged : EgoVelocityStatus::kIterationLimit;
}

/// The prior, as the result where the scan says nothing.
EgoVelocity nothing_but_prior(std::size_t points, const EgoPrior& prior) {
  EgoVelocity result;
  result.status = EgoVelocityStatus::kTooFewPoints;
  result.points = points;
  result.unobservable.setIdentity();
  result.joint_covariance = prior.covariance;
  if (prior.has_velocity) {
    result.velocity_sensor = prior.mean.head<3>();
  } else {
    result.joint_covariance.topLeftCorner<3, 3>() = kUnknown_mps * kUnknown_mps * Eigen::Matrix3d::Identity();
  }
  result.covariance = result.joint_covariance.topLeftCorner<3, 3>();
  result.acceleration_sensor = prior.mean.segment<3>(3);
  result.bias_mps = prior.mean[6];
  result.bias_variance = prior.covariance(6, 6);
  return result;
}

/// False when rows that hardly determine the motion have carried it away from anything that moves.
bool is_plausible_motion(const EgoVelocity& ego) {
  return ego.velocity_sensor.norm() <= kMaxDoppler_mps && ego.acceleration_sensor.norm() <= kMaxAcceleration_mps2 &&
         ego.joint_covariance.allFinite();
}

}  // namespace

bool agrees(const EgoPrior& prior, const Eigen::Vector3d& velocity) {
  constexpr double kSigmas2 = 16.0;
  const Eigen::Vector3d difference = velocity - prior.mean.head<3>();
  const Eigen::Matrix3d covariance =
      prior.covariance.topLeftCorner<3, 3>() + kMinVariance * Eigen::Matrix3d::Identity();
  return prior.has_velocity && difference.dot(covariance.ldlt().solve(difference)) < kSigmas2;
}

ConfigFields fields(ConsensusRegressionConfig& config) {
  return {
      {"cell_size_m", &config.cell_size_m, 0.01, 100.0, "m",
       "edge of the cubes over which the consensus on the static scene is weighted"},
      {"hypotheses", &config.hypotheses, 8, 100'000, "", "velocities tried, each from three points"},
      {"inlier_threshold_mps", &config.inlier_threshold_mps, 0.01, 10.0, "m/s",
       "inlier threshold of a velocity hypothesis"},
      {"tukey_cutoff", &config.tukey_cutoff, 2.0, 20.0, "", "Tukey cutoff in standard deviations of the noise"},
      {"min_noise_mps", &config.min_noise_mps, 1e-4, 1.0, "m/s", "smallest standard deviation of static Doppler"},
      {"max_noise_mps", &config.max_noise_mps, 1e-3, 10.0, "m/s", "largest standard deviation of static Doppler"},
      {"surface_noise_mps", &config.surface_noise_mps, 1e-4, 1.0, "m/s",
       "standard deviation of the error that all Doppler values of one cell have in common"},
      {"prior_weight", &config.prior_weight, 0.0, 10.0, "",
       "a hypothesis gains up to this share of its support by agreeing with the prior"},
      {"ambiguity_ratio", &config.ambiguity_ratio, 0.0, 1.0, "",
       "the scan is ambiguous when a second hypothesis has this share of the support of the first"},
      {"min_support", &config.min_support, 0.0, 1.0, "", "smallest support of a velocity hypothesis"},
  };
}

EgoVelocity estimate_velocity(const Scan& scan, const EgoPrior& prior, const ConsensusRegressionConfig& config,
                              const Workers& workers) {
  return estimate_velocity(sort_into_cells(scan, config.cell_size_m, workers), prior, config, workers);
}

EgoVelocity estimate_velocity(const DopplerRows& rows, const EgoPrior& prior, const ConsensusRegressionConfig& config,
                              const Workers& workers) {
  const EgoVelocity expected = nothing_but_prior(rows.size(), prior);
  EgoVelocity result = expected;
  if (rows.size() < kMinPoints) {
    return result;
  }
  result.reference_time_s = rows.reference_time_s;
  const ModeHypothesis hypothesis = choose_mode(rows, prior, consensus_model(prior), config, workers);
  if (hypothesis.support < config.min_support) {
    result.status = EgoVelocityStatus::kAmbiguous;
    return result;
  }
  const Fit fit = fit_all(rows, hypothesis, prior, config, workers);
  result.status = status_of(fit, hypothesis);
  result.iterations = fit.iterations;
  result.unobservable = fit.open;
  result.velocity_sensor = fit.x.head<3>() + fit.open * (result.velocity_sensor - fit.x.head<3>());
  result.joint_covariance = fit.covariance;
  result.joint_covariance.topLeftCorner<3, 3>() +=
      fit.open * result.covariance * fit.open +
      floor_variance(rows.duration_s) * (Eigen::Matrix3d::Identity() - fit.open);
  result.joint_covariance(6, 6) += floor_variance(0.0);
  result.covariance = result.joint_covariance.topLeftCorner<3, 3>();
  result.acceleration_sensor = fit.x.segment<3>(3);
  result.bias_mps = fit.x[6];
  result.bias_variance = result.joint_covariance(6, 6);
  result.inliers = fit.sums.inliers;
  if (result.inliers > 0) {
    result.inlier_rms_mps = std::sqrt(fit.sums.inlier_squared / static_cast<double>(result.inliers));
  }
  if (!is_plausible_motion(result)) {
    result = expected;
    result.reference_time_s = rows.reference_time_s;
    result.status = EgoVelocityStatus::kAmbiguous;
  }
  return result;
}

}  // namespace dynamic_icp::ego_motion
