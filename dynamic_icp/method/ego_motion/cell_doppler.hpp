// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

/// So many cells on the surface that carries the scene tell how it moves.
constexpr std::size_t kEnoughOnSupport = 20;

/// What those points of a cell say together that may be static.
struct CellDoppler {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();  ///< mean line of sight
  double off_mps = 0.0;                         ///< mean of s + u . v(t) - bias
  double variance = 0.0;                        ///< (m/s)^2, of that by the noise of points alone
  double share = 0.0;                           ///< of the points of the cell
};

/// `noise_mps` is the standard deviation of single points; those that are off by `moving_mps` or more move or are
/// false, and tell nothing of the others in their cell.
CellDoppler doppler_of_cell(const DopplerRows& rows, std::size_t cell, const EgoVelocity& ego, double noise_mps,
                            double moving_mps);

/// The cells on the surface that carries the scene, where that is known.
std::vector<std::size_t> support_cells(const DopplerRows& rows);

}  // namespace dynamic_icp::ego_motion
