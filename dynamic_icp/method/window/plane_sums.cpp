// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/plane_sums.hpp"

namespace dynamic_icp::window {
namespace {

template <typename Sums>
typename Sums::value_type total(const Sums& of_nodes) {
  typename Sums::value_type sum = of_nodes.front();
  for (std::size_t j = 1; j < of_nodes.size(); ++j) {
    sum += of_nodes[j];
  }
  return sum;
}

}  // namespace

void PlaneSums::add(const PlaneRow& row) {
  const Vector6d wm = row.w * row.m;
  const Matrix6d wmm = wm * row.m.transpose();
  const Pointing wmJ = wm * row.J.transpose();
  const double L = (1.0 - row.recent) * (1.0 - row.beyond);
  const double L_next = (1.0 - row.recent) * row.beyond;
  LL_[row.node] += (L * L) * wmm;
  LL_next_[row.node] += (L * L_next) * wmm;
  LL_[row.node + 1] += (L_next * L_next) * wmm;
  E_[row.node] += (L * row.e) * wm;
  E_[row.node + 1] += (L_next * row.e) * wm;
  P_[row.node] += L * wmJ;
  P_[row.node + 1] += L_next * wmJ;
  if (row.recent > 0.0) {
    Lr_[row.node] += (L * row.recent) * wmm;
    Lr_[row.node + 1] += (L_next * row.recent) * wmm;
    rr_ += (row.recent * row.recent) * wmm;
    E_recent_ += (row.recent * row.e) * wm;
    P_recent_ += row.recent * wmJ;
  }
  PP_ += row.w * row.J * row.J.transpose();
  PE_ += (row.w * row.e) * row.J;
}

Matrix6d PlaneSums::S(std::size_t node) const {
  Matrix6d sum = LL_[node] + Lr_[node];
  if (node > 0) {
    sum += LL_next_[node - 1];
  }
  if (node + 1 < kMapNodes) {
    sum += LL_next_[node];
  }
  return sum;
}

Matrix6d PlaneSums::S() const { return total(LL_) + 2.0 * (total(LL_next_) + total(Lr_)) + rr_; }
Matrix6d PlaneSums::S_recent() const { return total(Lr_) + rr_; }
Vector6d PlaneSums::E() const { return total(E_) + E_recent_; }
PlaneSums::Pointing PlaneSums::P() const { return total(P_) + P_recent_; }

}  // namespace dynamic_icp::window
