// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/estimation/normal_equations.hpp"

namespace dynamic_icp::window {

/// What planes say of rigid motions m = [phi; p], in one scan or in several.
struct MotionInformation {
  Matrix6d all = Matrix6d::Zero();    ///< sum of w m m^T; positive definite, but for none at all
  Matrix6d noise = Matrix6d::Zero();  ///< its part by the noise of normals
};

/// The motions of which the noise of normals is most and least of the information.
struct PrincipalMotions {
  Matrix6d motions = Matrix6d::Identity();  ///< columns, each with information 1
  Vector6d noise_shares = Vector6d::Zero();
};

PrincipalMotions principal_motions(const MotionInformation& scan);

/// Of a scan, with what past scans showed.
struct ContinuedMotions {
  PrincipalMotions principal;
  MotionInformation sums;  ///< of the scan and the past, as far as they agree: the past of the next one
};

/// A motion that no plane shows is known from one scan as well as its normals are. Found anew in each scan it turns to
/// and fro, and what is held beside it is measured along changing mixtures with it: what the map has drifted along it
/// then looks measured. So the motions are those of sums over scans. The scan may contradict the past, where what is
/// seen has changed. Of a motion v that only noise shows,
///   n (v^T all v / v^T noise v - the least of any motion),
/// over n patches that err each by itself, is chi-squared with five degrees of freedom. The past has the largest weight
/// up to 1 for which this stays below its 95 % in all motions of which noise by `max_noise_share` takes a tenth or
/// more.
ContinuedMotions continue_motions(const MotionInformation& scan, const MotionInformation& past, double patches,
                                  double max_noise_share);

}  // namespace dynamic_icp::window
