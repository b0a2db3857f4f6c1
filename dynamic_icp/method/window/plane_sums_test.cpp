// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/plane_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

using Eigen::Vector2d;

std::vector<PlaneRow> some_rows() {
  std::vector<PlaneRow> rows(40);
  double k = 0.0;
  for (PlaneRow& row : rows) {
    const double phase = 0.025 * k * static_cast<double>(PlaneSums::kMapNodes - 1);
    row.node = static_cast<std::size_t>(phase);
    row.beyond = phase - std::floor(phase);
    row.m = Vector6d::NullaryExpr([&](Eigen::Index i) { return std::sin(1.3 * k + static_cast<double>(i)); });
    row.J = Vector2d(std::cos(k), std::sin(2.0 * k));
    row.e = std::cos(0.7 * k);
    row.w = 1.0 + 0.1 * k;
    row.recent = std::max(0.0, std::sin(0.9 * k));
    k += 1.0;
  }
  return rows;
}

/// The share of a node: a hat over the phase, without that of the last sweep.
double hat(const PlaneRow& row, std::size_t node) {
  return (1.0 - row.recent) *
         std::max(0.0, 1.0 - std::abs(static_cast<double>(row.node) + row.beyond - static_cast<double>(node)));
}

TEST(PlaneSums, AreTheSumsOverTheirRows) {
  PlaneSums sums;
  for (const PlaneRow& row : some_rows()) {
    sums.add(row);
  }
  for (std::size_t node = 0; node < PlaneSums::kMapNodes; ++node) {
    Matrix6d LL = Matrix6d::Zero();
    Matrix6d LL_next = Matrix6d::Zero();
    Matrix6d S = Matrix6d::Zero();
    Vector6d E = Vector6d::Zero();
    PlaneSums::Pointing P = PlaneSums::Pointing::Zero();
    for (const PlaneRow& row : some_rows()) {
      const double L = hat(row, node);
      LL += row.w * L * L * row.m * row.m.transpose();
      LL_next += row.w * L * hat(row, node + 1) * row.m * row.m.transpose();
      S += row.w * L * row.m * row.m.transpose();
      E += row.w * L * row.e * row.m;
      P += row.w * L * row.m * row.J.transpose();
    }
    EXPECT_TRUE(sums.LL(node).isApprox(LL, 1e-12)) << node;
    EXPECT_TRUE(sums.S(node).isApprox(S, 1e-12)) << node;
    EXPECT_TRUE(sums.E(node).isApprox(E, 1e-12)) << node;
    EXPECT_TRUE(sums.P(node).isApprox(P, 1e-12)) << node;
    if (node + 1 < PlaneSums::kMapNodes) {
      EXPECT_TRUE(sums.LL_next(node).isApprox(LL_next, 1e-12)) << node;
    }
  }
}

TEST(PlaneSums, TellTheLastSweepApart) {
  PlaneSums sums;
  std::array<Matrix6d, PlaneSums::kMapNodes> Lr;
  Lr.fill(Matrix6d::Zero());
  Matrix6d rr = Matrix6d::Zero();
  Matrix6d S = Matrix6d::Zero();
  Vector6d E = Vector6d::Zero();
  PlaneSums::Pointing P = PlaneSums::Pointing::Zero();
  for (const PlaneRow& row : some_rows()) {
    sums.add(row);
    const double r = row.recent;
    for (std::size_t node = 0; node < PlaneSums::kMapNodes; ++node) {
      Lr[node] += row.w * hat(row, node) * r * row.m * row.m.transpose();
    }
    rr += row.w * r * r * row.m * row.m.transpose();
    S += row.w * r * row.m * row.m.transpose();
    E += row.w * r * row.e * row.m;
    P += row.w * r * row.m * row.J.transpose();
  }
  for (std::size_t node = 0; node < PlaneSums::kMapNodes; ++node) {
    EXPECT_TRUE(sums.Lr(node).isApprox(Lr[node], 1e-12)) << node;
  }
  EXPECT_TRUE(sums.rr().isApprox(rr, 1e-12));
  EXPECT_TRUE(sums.S_recent().isApprox(S, 1e-12));
  EXPECT_TRUE(sums.E_recent().isApprox(E, 1e-12));
  EXPECT_TRUE(sums.P_recent().isApprox(P, 1e-12));
}

TEST(PlaneSums, OfAllNodesAreThoseWithoutThem) {
  PlaneSums sums;
  Matrix6d S = Matrix6d::Zero();
  Vector6d E = Vector6d::Zero();
  PlaneSums::Pointing P = PlaneSums::Pointing::Zero();
  Eigen::Matrix2d PP = Eigen::Matrix2d::Zero();
  Vector2d PE = Vector2d::Zero();
  for (const PlaneRow& row : some_rows()) {
    sums.add(row);
    S += row.w * row.m * row.m.transpose();
    E += row.w * row.e * row.m;
    P += row.w * row.m * row.J.transpose();
    PP += row.w * row.J * row.J.transpose();
    PE += row.w * row.e * row.J;
  }
  EXPECT_TRUE(sums.S().isApprox(S, 1e-12));
  EXPECT_TRUE(sums.E().isApprox(E, 1e-12));
  EXPECT_TRUE(sums.P().isApprox(P, 1e-12));
  EXPECT_TRUE(sums.PP().isApprox(PP, 1e-12));
  EXPECT_TRUE(sums.PE().isApprox(PE, 1e-12));
  sums.clear();
  EXPECT_EQ(sums.S().norm(), 0.0);
  EXPECT_EQ(sums.PE().norm(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::window
