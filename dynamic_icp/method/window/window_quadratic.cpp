// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_quadratic.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/replace.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

// Columns that are mirrored together.
constexpr Eigen::Index kMirrored = 16;

std::vector<Eigen::Index> range(Eigen::Index first, Eigen::Index count) {
  std::vector<Eigen::Index> result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), first);
  return result;
}

std::vector<Eigen::Index> join(std::vector<Eigen::Index> a, const std::vector<Eigen::Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

WindowQuadratic::WindowQuadratic(Eigen::Index field_size, std::size_t coefficients, bool vibrates)
    : layout_{field_size, static_cast<Eigen::Index>(coefficients), vibrates},
      Q_(Eigen::MatrixXd::Zero(layout_.size(), layout_.size())),
      g_(Eigen::VectorXd::Zero(layout_.size())) {}

void WindowQuadratic::set(Eigen::MatrixXd Q, Eigen::VectorXd g) {
  Q_ = std::move(Q);
  g_ = std::move(g);
  mirror(Q_.rows());
}

/// The upper triangle of the first rows and columns from the lower one.
void WindowQuadratic::mirror(Eigen::Index size) {
  for (Eigen::Index first = 0; first < size; first += kMirrored) {
    const Eigen::Index n = std::min(kMirrored, size - first);
    Q_.block(0, first, first, n) = Q_.block(first, 0, n, first).transpose();
    for (Eigen::Index k = first + 1; k < first + n; ++k) {
      Q_.block(first, k, k - first, 1) = Q_.block(k, first, 1, k - first).transpose();
    }
  }
}

/// Q - W^T W and g - W^T w in the first rows and columns, as many as W has.
void WindowQuadratic::subtract(const Eigen::MatrixXd& W, const Eigen::VectorXd& w) {
  const Eigen::Index n = W.cols();
  Q_.topLeftCorner(n, n).selfadjointView<Eigen::Lower>().rankUpdate(W.transpose(), -1.0);
  g_.head(n).noalias() -= W.transpose() * w;
  mirror(n);
}

void WindowQuadratic::set_field(const Eigen::MatrixXd& Q, const Eigen::VectorXd& g) {
  Q_.topLeftCorner(layout_.field, layout_.field) = Q;
  g_.head(layout_.field) = g;
}

void WindowQuadratic::add_field(const Eigen::MatrixXd& H, const Eigen::VectorXd& g) {
  Q_.topLeftCorner(layout_.field, layout_.field) += H.selfadjointView<Eigen::Lower>().toDenseMatrix();
  g_.head(layout_.field) += g;
}

void WindowQuadratic::append_coefficients(std::size_t count) {
  const Eigen::Index begin = layout_.coefficient(0);
  const Eigen::Index before = 6 * layout_.coefficients;
  const Eigen::Index size = layout_.size();
  layout_.coefficients += static_cast<Eigen::Index>(count);
  const std::vector<Eigen::Index> to = join(range(0, begin + before), range(layout_.vibration(0), before));
  Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(layout_.size(), layout_.size());
  Eigen::VectorXd g = Eigen::VectorXd::Zero(layout_.size());
  for (Eigen::Index k = 0; k < size; ++k) {
    const Eigen::Index at = to[static_cast<std::size_t>(k)];
    g[at] = g_[k];
    for (Eigen::Index i = 0; i < size; ++i) {
      Q(to[static_cast<std::size_t>(i)], at) = Q_(i, k);
    }
  }
  Q_ = std::move(Q);
  g_ = std::move(g);
}

void WindowQuadratic::next_stamp() {
  const Eigen::Index last = layout_.last_stamp();
  const Eigen::Index now = layout_.stamp();
  const double information = Q_(last, last);
  if (information > 0.0) {
    const double scale = 1.0 / std::sqrt(information);
    subtract(scale * Q_.row(last).head(layout_.head()), Eigen::VectorXd::Constant(1, scale * g_[last]));
  }
  Q_.row(last) = Q_.row(now);
  Q_.col(last) = Q_.col(now);
  Q_(last, last) = Q_(now, now);
  g_[last] = g_[now];
  Q_.row(now).setZero();
  Q_.col(now).setZero();
  g_[now] = 0.0;
}

void WindowQuadratic::drop_coefficients(std::size_t count) {
  if (count == 0) {
    return;
  }
  const Eigen::Index first = layout_.coefficient(0);
  const auto gone = 6 * static_cast<Eigen::Index>(count);
  const Eigen::Index left = 6 * layout_.coefficients - gone;
  std::vector<Eigen::Index> dropped = range(first, gone);
  std::vector<Eigen::Index> remaining = join(range(0, first), range(first + gone, left));
  if (layout_.vibrates) {
    dropped = join(std::move(dropped), range(layout_.vibration(0), gone));
    remaining = join(std::move(remaining), range(layout_.vibration(0) + gone, left));
  }
  Eigen::MatrixXd old = Q_(dropped, dropped);
  old.diagonal().array() += kNothing;
  const Eigen::LLT<Eigen::MatrixXd> eliminated(old);
  layout_.coefficients -= static_cast<Eigen::Index>(count);
  // The tail of what remains has nothing to do with what is dropped.
  Eigen::MatrixXd W = Q_(dropped, std::vector(remaining.begin(), remaining.begin() + layout_.head()));
  Eigen::VectorXd w = g_(dropped);
  eliminated.matrixL().solveInPlace(W);
  eliminated.matrixL().solveInPlace(w);
  replace(Q_, Q_(remaining, remaining));
  replace(g_, g_(remaining));
  subtract(W, w);
}

void WindowQuadratic::keep_field_only(std::size_t coefficients) {
  const Eigen::Index begin = layout_.field;
  const Eigen::Index rest = layout_.size() - begin;
  Eigen::MatrixXd others = Q_.bottomRightCorner(rest, rest);
  others.diagonal().array() += kNothing;
  const Eigen::LLT<Eigen::MatrixXd> eliminated(others);
  const Eigen::MatrixXd W = eliminated.matrixL().solve(Q_.bottomLeftCorner(rest, begin));
  const Eigen::VectorXd w = eliminated.matrixL().solve(g_.tail(rest));
  Eigen::MatrixXd field = Q_.topLeftCorner(begin, begin);
  field.noalias() -= W.transpose() * W;
  const Eigen::VectorXd field_g = g_.head(begin) - W.transpose() * w;
  layout_.coefficients = static_cast<Eigen::Index>(coefficients);
  replace(Q_, Eigen::MatrixXd::Zero(layout_.size(), layout_.size()));
  replace(g_, Eigen::VectorXd::Zero(layout_.size()));
  Q_.topLeftCorner(begin, begin) = field;
  g_.head(begin) = field_g;
}

void WindowQuadratic::move_reference(const std::vector<Matrix6d>& changes, const Matrix6d& map_change) {
  // A^T Q A, the lower triangle, block by block
  const auto apply = [&](Eigen::Index at, const Matrix6d& A) {
    constexpr int n = 6;
    for (Eigen::Index k = 0; k < at + n; ++k) {
      Q_.col(k).segment<n>(at) = (A.transpose() * Q_.col(k).segment<n>(at)).eval();
    }
    auto below = Q_.middleCols<n>(at).bottomRows(Q_.rows() - at);
    below = below.lazyProduct(A).eval();
    g_.segment<n>(at) = (A.transpose() * g_.segment<n>(at)).eval();
  };
  for (std::size_t j = 0; j < static_cast<std::size_t>(Layout::kMapNodes); ++j) {
    apply(layout_.map_node(j), map_change);
  }
  for (std::size_t k = 0; k < changes.size(); ++k) {
    apply(layout_.coefficient(k), changes[k]);
    if (layout_.vibrates) {
      apply(layout_.vibration(k), changes[k]);
    }
  }
  mirror(Q_.rows());
}

void WindowQuadratic::mix_map_error(double share, const Eigen::MatrixXd& J) {
  // map error = (map error' - share J dc) / (1 - share)
  const Eigen::Index d = layout_.map_error();
  const Eigen::Index c = layout_.coefficient(0);
  const Eigen::Index n = J.cols();
  const double scale = 1.0 / (1.0 - share);
  const Eigen::MatrixXd B = -share * scale * J;
  const Eigen::MatrixXd d_rows = Q_.middleRows(d, Layout::kMapError);
  const Eigen::VectorXd d_g = g_.segment(d, Layout::kMapError);
  Q_.middleRows(c, n) += B.transpose() * d_rows;
  Q_.middleCols(c, n) += Q_.middleCols(d, Layout::kMapError) * B;
  Q_.middleRows(d, Layout::kMapError) *= scale;
  Q_.middleCols(d, Layout::kMapError) *= scale;
  g_.segment(c, n) += B.transpose() * d_g;
  g_.segment(d, Layout::kMapError) *= scale;
}

void WindowQuadratic::walk(Eigen::Index begin, const Eigen::MatrixXd& W) {
  // (Q^-1 + E W E^T)^-1 = Q - Q E (W^-1 + E^T Q E)^-1 E^T Q
  const Eigen::Index n = W.rows();
  Eigen::MatrixXd A = W.llt().solve(Eigen::MatrixXd::Identity(n, n));
  A += Q_.block(begin, begin, n, n);
  const Eigen::LLT<Eigen::MatrixXd> sum(A);
  const Eigen::MatrixXd Z = sum.matrixL().solve(Q_.block(begin, 0, n, layout_.head()));
  subtract(Z, sum.matrixL().solve(g_.segment(begin, n)));
}

void WindowQuadratic::state(StateArchive& archive) {
  const bool vibrates = layout_.vibrates;
  archive(layout_.field, layout_.coefficients, layout_.vibrates, Q_, g_);
  archive.require(layout_.vibrates == vibrates && layout_.field >= 0 && layout_.field <= Q_.rows() &&
                      layout_.coefficients >= 0 && layout_.coefficients <= Q_.rows() && Q_.rows() == layout_.size() &&
                      Q_.cols() == Q_.rows() && g_.size() == Q_.rows(),
                  "the size of what past scans say");
}

}  // namespace dynamic_icp::window
