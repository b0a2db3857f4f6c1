// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/assignment.hpp"

#include <algorithm>
#include <limits>

namespace dynamic_icp::evaluation {
namespace {

constexpr Eigen::Index kNone = -1;

/// Rows are added one after the other, each along the cheapest path of changes. `cost` is not wider than high.
class Assignment {
 public:
  explicit Assignment(const Eigen::MatrixXd& cost)
      : cost_(cost),
        of_rows_(Eigen::VectorXd::Zero(cost.rows())),
        of_columns_(Eigen::VectorXd::Zero(cost.cols())),
        row_of_(static_cast<std::size_t>(cost.cols()), kNone) {
    for (Eigen::Index row = 0; row < cost.rows(); ++row) {
      add(row);
    }
  }

  /// The row of each column.
  [[nodiscard]] const std::vector<Eigen::Index>& row_of() const { return row_of_; }

 private:
  void add(Eigen::Index row) {
    const Eigen::Index columns = cost_.cols();
    const double infinity = std::numeric_limits<double>::infinity();
    Eigen::VectorXd distance = Eigen::VectorXd::Constant(columns, infinity);
    std::vector<Eigen::Index> before(static_cast<std::size_t>(columns), kNone);  // column before it on the path
    std::vector<bool> done(static_cast<std::size_t>(columns), false);
    Eigen::Index column = kNone;
    double length = 0.0;
    of_rows_[row] = 0.0;
    for (Eigen::Index from = row; from != kNone; from = row_of_[static_cast<std::size_t>(column)]) {
      Eigen::Index nearest = kNone;
      for (Eigen::Index j = 0; j < columns; ++j) {
        if (done[static_cast<std::size_t>(j)]) {
          continue;
        }
        const double through = length + cost_(from, j) - of_rows_[from] - of_columns_[j];
        if (through < distance[j]) {
          distance[j] = through;
          before[static_cast<std::size_t>(j)] = column;
        }
        if (nearest == kNone || distance[j] < distance[nearest]) {
          nearest = j;
        }
      }
      column = nearest;
      length = distance[column];
      done[static_cast<std::size_t>(column)] = true;
    }
    raise_prices(row, length, distance, done);
    while (column != kNone) {
      const Eigen::Index previous = before[static_cast<std::size_t>(column)];
      row_of_[static_cast<std::size_t>(column)] = previous == kNone ? row : row_of_[static_cast<std::size_t>(previous)];
      column = previous;
    }
  }

  /// Dual variables, so that no pair costs less than its row and column together, and chosen ones cost as much.
  void raise_prices(Eigen::Index row, double length, const Eigen::VectorXd& distance, const std::vector<bool>& done) {
    for (Eigen::Index j = 0; j < cost_.cols(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      if (done[at]) {
        of_columns_[j] += distance[j] - length;
        if (row_of_[at] != kNone) {
          of_rows_[row_of_[at]] += length - distance[j];
        }
      }
    }
    of_rows_[row] += length;
  }

  const Eigen::MatrixXd& cost_;
  Eigen::VectorXd of_rows_;
  Eigen::VectorXd of_columns_;
  std::vector<Eigen::Index> row_of_;
};

}  // namespace

std::vector<std::optional<std::size_t>> best_assignment(const Eigen::MatrixXd& scores) {
  std::vector<std::optional<std::size_t>> result(static_cast<std::size_t>(scores.rows()));
  // To pair nothing costs nothing: a column of that for each row.
  Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(scores.rows(), scores.cols() + scores.rows());
  cost.leftCols(scores.cols()) = -scores.cwiseMax(0.0);
  const Assignment assignment(cost);
  for (Eigen::Index j = 0; j < scores.cols(); ++j) {
    const Eigen::Index row = assignment.row_of()[static_cast<std::size_t>(j)];
    if (row != kNone && scores(row, j) > 0.0) {
      result[static_cast<std::size_t>(row)] = static_cast<std::size_t>(j);
    }
  }
  return result;
}

}  // namespace dynamic_icp::evaluation
