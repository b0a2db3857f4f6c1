// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kWorthReporting_mps = 0.08;
constexpr double kWellKnown_mps = 0.04;
constexpr double kHalfLeft = 0.5;

// What sweeps, surfaces and the noise model leave to the bias of a stretch.
constexpr double kScatter_mps = 0.03;

/// Biases of stretches, each with the weight of what its scans know, and how they scatter: scans of a stretch see the
/// same surfaces at the same angles and err alike.
struct Bias {
  double mps = 0.0;
  double error_mps = 1.0;
  std::size_t stretches = 0;
};

Bias mean_bias(const Evidence& evidence) {
  const double prior = ego_motion::EgoPrior::default_covariance()(6, 6);
  std::vector<double> means;
  std::vector<double> weights;
  for (std::size_t k = 0; k < evidence.looks.size(); k += kLooksOfStretch) {
    double information = 0.0;
    double weighted = 0.0;
    for (std::size_t i = k; i < std::min(k + kLooksOfStretch, evidence.looks.size()); ++i) {
      const ego_motion::EgoVelocity& ego = evidence.looks[i].ego;
      if (!evidence.looks[i].has_velocity() || !(ego.bias_variance > 0.0)) {
        continue;
      }
      // What the scan alone says: the fit began with a bias of 0 +- 0.2 m/s.
      information += std::max(0.0, 1.0 / ego.bias_variance - 1.0 / prior);
      weighted += ego.bias_mps / ego.bias_variance;
    }
    if (information > 0.0) {
      means.push_back(weighted / information);
      weights.push_back(1.0 / (1.0 / information + kScatter_mps * kScatter_mps));
    }
  }
  Bias bias;
  bias.stretches = means.size();
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (sum <= 0.0) {
    return bias;
  }
  bias.mps = std::inner_product(weights.begin(), weights.end(), means.begin(), 0.0) / sum;
  double scatter = 0.0;
  for (std::size_t k = 0; k < means.size(); ++k) {
    scatter += weights[k] / sum * (means[k] - bias.mps) * (means[k] - bias.mps);
  }
  const double count = static_cast<double>(means.size());
  bias.error_mps = std::sqrt(std::max(1.0 / sum, means.size() > 1 ? scatter / (count - 1.0) : 0.0));
  return bias;
}

/// The bias that is left when the speed is that of the reference. Of points that all lie ahead a bias and a speed look
/// alike: what the fit calls one may be the other.
std::optional<double> bias_by_reference(const Evidence& evidence, double bias_mps) {
  const Comparison* const reference = evidence.reference();
  if (reference == nullptr || !reference->is_same()) {
    return std::nullopt;
  }
  std::vector<double> along;
  for (const ScanLook& look : evidence.looks) {
    if (look.has_velocity() && look.ego.velocity_sensor.norm() > kMoves_mps) {
      along.push_back(look.look_direction.dot(look.ego.velocity_sensor.normalized()));
    }
  }
  const double faster_mps = (1.0 - reference->ratio) * reference->reference_speed_mps;
  return bias_mps + faster_mps * quantile(along, 0.5);
}

}  // namespace

Finding doppler_bias(const Evidence& evidence) {
  Finding finding{Question::kDopplerBias, Verdict::kCannotTell, ""};
  if (no_doppler(evidence)) {
    finding.sentence = "there is no Doppler";
    return finding;
  }
  const auto [bias, error, stretches] = mean_bias(evidence);
  finding.evidence = {{"bias_mps", bias}, {"bias_error_mps", error}, {"stretches", static_cast<double>(stretches)}};
  const std::optional<double> by_reference = bias_by_reference(evidence, bias);
  if (by_reference) {
    finding.evidence.emplace_back("bias_by_reference_mps", *by_reference);
  }
  const bool is_told = std::abs(bias) > kWorthReporting_mps && std::abs(bias) > kCertain * error;
  if (is_told && by_reference && std::abs(*by_reference) < kHalfLeft * std::abs(bias)) {
    finding.sentence = fmt::format(
        "a constant error of {:+.2f} m/s (+- {:.2f}) would explain the Doppler, but so would a speed that is {:.1f} % "
        "higher, as it is {}",
        bias, error, 100.0 * (1.0 / evidence.reference()->ratio - 1.0),
        reference_name(evidence, *evidence.reference()));
  } else if (is_told) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "all Doppler is off by {:+.2f} m/s (+- {:.2f}); preset default takes that out by itself, others "
        "do not",
        bias, error);
  } else if (error < kWellKnown_mps) {
    finding.verdict = Verdict::kOk;
    finding.sentence = fmt::format("no constant error beyond {:.2f} m/s", kWorthReporting_mps);
  } else {
    finding.sentence = "a constant error cannot be distinguished from a velocity here";
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
