// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"

namespace dynamic_icp::simulation {

/// What decides on the strength of a return.
struct Echo {
  double range_m = 0.0;
  double reflectivity = 0.0;   ///< see world::TriangleMesh
  double cos_incidence = 1.0;  ///< between ray and surface normal, in [0, 1]
  double beam_share = 1.0;     ///< part of the beam that falls on the surface
};

/// Power of the return relative to a surface of 10 % reflectivity met head-on at 1 m: (reflectivity / 0.1) *
/// cos_incidence * beam_share / range^2, with range in m. What the sensor's switches take out counts as 0.1 and 1.
double relative_power(const FmcwLidarConfig& config, const Echo& echo);

/// Probability that the return is found in the noise. A rough surface under coherent light has a power that fluctuates
/// as speckle does (Swerling's first case): P_d = P_fa^(1 / (1 + SNR)) with P_fa = 1e-6. The SNR is proportional to
/// `relative_power` and such that P_d = 1/2 for a 10 % surface head-on at `detection_range_m`. 1 when that is 0.
double detection_probability(const FmcwLidarConfig& config, const Echo& echo);

}  // namespace dynamic_icp::simulation
