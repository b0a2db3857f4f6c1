// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/tracking/body_filter.hpp"
#include "dynamic_icp/method/tracking/tracked_object.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// Which model a body follows: the states of a hidden Markov chain. It stays in one for some seconds, and then changes
/// to either of the others.
///
/// Each model is the state of `BodyFilter` under a constraint c = 0: on velocity and yaw rate of what stands, on the
/// yaw rate of what goes straight, and on nothing of what turns. So the likelihood of measurements z under it, relative
/// to that under the filter alone, is a ratio of densities of the filter's state (Savage and Dickey):
///   p(z | c = 0) / p(z) = p(c = 0 | z) / p(c = 0).
class MotionModels {
 public:
  [[nodiscard]] const MotionProbabilities& probabilities() const { return probabilities_; }

  void predict(double dt_s);

  /// The body before a scan, and after it.
  void correct(const BodyFilter& before, const BodyFilter& after);

  void state(StateArchive& archive);

 private:
  MotionProbabilities probabilities_;
};

/// Makes the body follow the model from now on: the constraint taken for a measurement.
void constrain(MotionModel model, BodyFilter& body);

/// How its motion then changes.
MotionNoise noise_under(MotionModel model, const MotionNoise& noise);

}  // namespace dynamic_icp::tracking
