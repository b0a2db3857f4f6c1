// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::datasets {

/// Which of some columns without names may be the Doppler of the points: the one that a velocity of the sensor explains
/// best, to a third of its spread at least, by a robust fit to some of the rows. Columns of whole numbers (lines,
/// times), columns that hardly vary and angles of the points are none. Each column is as long as the points. For
/// proposals only: a sensor at rest has no such column.
std::optional<std::size_t> likely_doppler(std::span<const Eigen::Vector3d> points,
                                          std::span<const std::vector<double>> columns);

/// The velocity v that explains the Doppler of most points best, doppler = v . p / |p|, by the same fit; nothing where
/// there are hardly any. Points and Doppler are equally many; those that are not finite do not count.
std::optional<Eigen::Vector3d> likely_velocity(std::span<const Eigen::Vector3d> points,
                                               const std::vector<double>& doppler);

/// Which columns of rows of numbers may be point and Doppler: the first three are x, y and z, or the three after a
/// column that numbers the rows, and another one is likely to be their Doppler. Nothing where none is. Columns are
/// equally long.
struct LikelyRow {
  std::size_t x = 0;  ///< y and z are the next ones
  std::size_t doppler = 0;
};
std::optional<LikelyRow> likely_row(std::span<const std::vector<double>> columns);

/// What rows of numbers may be, for a proposal: "x,y,z,_,doppler". The first three are taken for the point and the last
/// for the Doppler where there is no likely row. `columns` are those of a row, three at least.
std::string proposed_columns(std::span<const std::vector<double>> columns);

}  // namespace dynamic_icp::datasets
