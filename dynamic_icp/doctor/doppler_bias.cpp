// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/doctor/no_doppler.hpp"
#include "dynamic_icp/doctor/questions.hpp"
#include "dynamic_icp/ego_motion/consensus_regression.hpp"

namespace dynamic_icp::doctor {
namespace {

constexpr double kWorthTelling_mps = 0.08;
constexpr double kDeviations = 4.0;
constexpr double kWellKnown_mps = 0.04;

// What sweeps, surfaces and the noise model leave to the bias of one scan.
constexpr double kScatter_mps = 0.03;

}  // namespace

Finding doppler_bias(const Evidence& evidence) {
  Finding finding{Question::kDopplerBias, Verdict::kCannotTell, ""};
  if (no_doppler(evidence)) {
    finding.sentence = "there is no Doppler";
    return finding;
  }
  const double prior = ego_motion::EgoPrior::default_covariance()(6, 6);
  double weights = 0.0;
  double weighted = 0.0;
  for (const ScanLook& look : evidence.looks) {
    if (!look.has_velocity() || !(look.ego.bias_variance > 0.0)) {
      continue;
    }
    // What the scan alone says: the fit began with a bias of 0 +- 0.2 m/s.
    const double information = 1.0 / look.ego.bias_variance - 1.0 / prior;
    if (information > 0.0) {
      const double bias = look.ego.bias_mps / look.ego.bias_variance / information;
      const double weight = 1.0 / (1.0 / information + kScatter_mps * kScatter_mps);
      weights += weight;
      weighted += weight * bias;
    }
  }
  const double error = weights > 0.0 ? 1.0 / std::sqrt(weights) : 1.0;
  const double bias = weights > 0.0 ? weighted / weights : 0.0;
  finding.evidence = {{"bias_mps", bias}, {"bias_error_mps", error}};
  if (std::abs(bias) > kWorthTelling_mps && std::abs(bias) > kDeviations * error) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "all Doppler is off by {:+.2f} m/s (+- {:.2f}); preset default takes that out by itself, others do not", bias,
        error);
  } else if (error < kWellKnown_mps) {
    finding.verdict = Verdict::kOk;
    finding.sentence = fmt::format("no constant error beyond {:.2f} m/s", kWorthTelling_mps);
  } else {
    finding.sentence = "a constant error cannot be told from a velocity here";
  }
  return finding;
}

}  // namespace dynamic_icp::doctor
