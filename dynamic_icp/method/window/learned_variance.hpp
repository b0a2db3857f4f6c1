// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// Mean and variance of what is known of an unknown.
struct KnownValue {
  double value = 0.0;
  double variance = 0.0;
};

/// What is known of x ~ N(0, before) from data, had it been N(0, after) a priori.
KnownValue with_prior(const KnownValue& known, double before, double after);

/// The variance q of unknowns x ~ N(0, q), learned from their estimates, scan after scan. Old evidence fades.
class LearnedVariance {
 public:
  /// What is allowed, and what counts before anything was seen: so many unknowns of standard deviation `sigma`.
  struct Prior {
    double sigma = 1.0;
    double counts = 1.0;
    double min_sigma = 0.0;
    double max_sigma = 1.0;
    double memory = 0.87;  ///< what is left of the evidence after one more scan
  };

  LearnedVariance() = default;
  explicit LearnedVariance(const Prior& prior);

  [[nodiscard]] double value() const { return variance_; }

  /// From one unknown of a scan, its estimate and posterior variance, by Fisher's scoring: exact where the unknown is
  /// measured on its own. May be called again with a better estimate before `keep`. By which share q grew.
  double propose(double estimate, double posterior_variance);

  /// The same from the change x_1 - x_0 of one unknown to the next, of variance 2 q, where the unknowns may drift
  /// together. `expected` and `prior_variance` are mean and variance of the change before the scan was seen. A change
  /// that the data hardly know teaches nothing.
  double propose_change(double change, double posterior_variance, double expected, double prior_variance);

  /// The evidence of the last `propose` becomes part of the past.
  void keep();

  /// From several unknowns of a scan that depend on each other, by MacKay's fixed point
  /// q = sum x^2 / sum (1 - posterior variance / q): `squares` over `known`. May be called again before `keep`.
  void update(double squares, double known);

  /// q is held near a variance: so many unknowns of it that do not fade count besides those seen.
  void follow(double variance, double counts);

  [[nodiscard]] double counts() const { return next_counts_; }  ///< unknowns seen, faded

  void state(StateArchive& archive);

 private:
  double renew(double squares, double counts);

  double memory_ = 0.87;
  double variance_ = 1.0;
  double min_variance_ = 0.0;
  double max_variance_ = 1.0;
  double squares_ = 0.0;  ///< sum over the past, faded
  double counts_ = 0.0;
  double followed_squares_ = 0.0;  ///< that do not fade
  double followed_counts_ = 0.0;
  double next_squares_ = 0.0;
  double next_counts_ = 0.0;
};

}  // namespace dynamic_icp::window
