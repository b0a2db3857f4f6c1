// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::evaluation {

/// The pairing of rows with columns, each at most once, of which the sum of scores is greatest: the column of each row.
/// Scores that are not positive pair nothing. Shortest augmenting paths, O(n^3).
std::vector<std::optional<std::size_t>> best_assignment(const Eigen::MatrixXd& scores);

}  // namespace dynamic_icp::evaluation
