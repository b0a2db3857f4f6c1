// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_sums.hpp"

#include "dynamic_icp/method/base/lane_sums.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::mapping {
namespace {

constexpr std::size_t kLanes = simd::kSumLanes;
using Lanes = simd::LaneSum;

/// Sums over rows in lanes that are added up at the end. Upper triangles in the order xx, xy, xz, yy, yz, zz.
struct LaneSums {
  std::array<std::array<Lanes, 6>, 5> rr{};  // w tau^k r r^T
  std::array<std::array<Lanes, 9>, 3> nr{};  // w tau^k n r^T, row by row
  std::array<Lanes, 6> nn{};                 // w n n^T
  std::array<std::array<Lanes, 3>, 3> er{};  // w e tau^k r
  std::array<Lanes, 3> en{};                 // w e n
  Lanes weights{};
  Lanes squares{};
  Lanes chi_squares{};
};

/// Adds `lanes` rows from `first` on, row first + l to lane l.
template <bool kTimed>
DYNAMIC_ICP_INLINE void add_rows(const PlaneRows& rows, const RowWeights& weights, std::size_t first, std::size_t lanes,
                                 LaneSums& sums) {
  const double* const __restrict rx = rows.r[0].data() + first;
  const double* const __restrict ry = rows.r[1].data() + first;
  const double* const __restrict rz = rows.r[2].data() + first;
  const double* const __restrict nx = rows.n[0].data() + first;
  const double* const __restrict ny = rows.n[1].data() + first;
  const double* const __restrict nz = rows.n[2].data() + first;
  const double* const __restrict tau = rows.tau.data() + first;
  const double* const __restrict e = rows.e.data() + first;
  const double* const __restrict own = rows.own.data() + first;
  const double* const __restrict common = rows.common.data() + first;
  const double* const __restrict robust = weights.robust.data() + first;
  const double* const __restrict w = weights.w.data() + first;
  DYNAMIC_ICP_LANE_LOOP for (std::size_t l = 0; l < lanes; ++l) {
    const double wrx = w[l] * rx[l];
    const double wry = w[l] * ry[l];
    const double wrz = w[l] * rz[l];
    const double wnx = w[l] * nx[l];
    const double wny = w[l] * ny[l];
    const double wnz = w[l] * nz[l];
    const double rr[6] = {wrx * rx[l], wrx * ry[l], wrx * rz[l], wry * ry[l], wry * rz[l], wrz * rz[l]};
    const double nr[9] = {wnx * rx[l], wnx * ry[l], wnx * rz[l], wny * rx[l], wny * ry[l],
                          wny * rz[l], wnz * rx[l], wnz * ry[l], wnz * rz[l]};
    const double er[3] = {e[l] * wrx, e[l] * wry, e[l] * wrz};
    const double e2 = robust[l] * e[l] * e[l];
    sums.weights[l] += robust[l];
    sums.squares[l] += e2;
    sums.chi_squares[l] += e2 / (own[l] + common[l]);
    sums.nn[0][l] += wnx * nx[l];
    sums.nn[1][l] += wnx * ny[l];
    sums.nn[2][l] += wnx * nz[l];
    sums.nn[3][l] += wny * ny[l];
    sums.nn[4][l] += wny * nz[l];
    sums.nn[5][l] += wnz * nz[l];
    sums.en[0][l] += e[l] * wnx;
    sums.en[1][l] += e[l] * wny;
    sums.en[2][l] += e[l] * wnz;
    for (std::size_t k = 0; k < 6; ++k) {
      sums.rr[0][k][l] += rr[k];
    }
    for (std::size_t k = 0; k < 9; ++k) {
      sums.nr[0][k][l] += nr[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sums.er[0][k][l] += er[k];
    }
    if constexpr (kTimed) {
      const double t = tau[l];
      const double t2 = t * t;
      const double t3 = t2 * t;
      const double t4 = t2 * t2;
      for (std::size_t k = 0; k < 6; ++k) {
        sums.rr[1][k][l] += t * rr[k];
        sums.rr[2][k][l] += t2 * rr[k];
        sums.rr[3][k][l] += t3 * rr[k];
        sums.rr[4][k][l] += t4 * rr[k];
      }
      for (std::size_t k = 0; k < 9; ++k) {
        sums.nr[1][k][l] += t * nr[k];
        sums.nr[2][k][l] += t2 * nr[k];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        sums.er[1][k][l] += t * er[k];
        sums.er[2][k][l] += t2 * er[k];
      }
    }
  }
}

template <bool kTimed>
void add_all(const PlaneRows& rows, const RowWeights& weights, LaneSums& sums) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    LaneSums own;  // nothing else points to it, which the compiler must know to use vectors
    std::size_t i = 0;
    for (; i + kLanes <= rows.size; i += kLanes) {
      add_rows<kTimed>(rows, weights, i, kLanes, own);
    }
    add_rows<kTimed>(rows, weights, i, rows.size - i, own);
    sums = own;
  });
}

Eigen::Matrix3d matrix_of(const std::array<Lanes, 9>& a) {
  Eigen::Matrix3d matrix;
  matrix << simd::total(a[0]), simd::total(a[1]), simd::total(a[2]), simd::total(a[3]), simd::total(a[4]),
      simd::total(a[5]), simd::total(a[6]), simd::total(a[7]), simd::total(a[8]);
  return matrix;
}

/// Puts a block and its transpose in their places; blocks on the diagonal are made symmetric to the last bit.
void set_block(Matrix12d& H, int row, int column, const Eigen::Matrix3d& block) {
  const bool diagonal = row == column;
  H.block<3, 3>(3 * row, 3 * column) = diagonal ? Eigen::Matrix3d(0.5 * (block + block.transpose())) : block;
  if (!diagonal) {
    H.block<3, 3>(3 * column, 3 * row) = block.transpose();
  }
}

}  // namespace

PlaneSums& PlaneSums::operator+=(const PlaneSums& other) {
  H += other.H;
  b += other.b;
  weights += other.weights;
  squares += other.squares;
  chi_squares += other.chi_squares;
  return *this;
}

void weigh(const PlaneRows& rows, const PlaneWeights& weights, RowWeights& result) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const e = rows.e.data();
    const double* const own = rows.own.data();
    const double* const common = rows.common.data();
    const double* const members = rows.members.data();
    double* const __restrict robust_out = result.robust.data();
    double* const __restrict w_out = result.w.data();
    const double kernel2 = weights.kernel * weights.kernel;
    const double gate2 = weights.gate_m * weights.gate_m;
    for (std::size_t i = 0; i < rows.size; ++i) {
      const double expected2 = kernel2 * (own[i] + common[i]);
      const double reach2 = expected2 > gate2 ? expected2 : gate2;
      const double inside = 1.0 - e[i] * e[i] / reach2;
      const double positive = inside > 0.0 ? inside : 0.0;
      const double robust = positive * positive;
      robust_out[i] = robust;
      w_out[i] = robust / (own[i] + members[i] * common[i]);
    }
  });
}

PlaneSums sum_planes(const PlaneRows& rows, const Eigen::Matrix3d& R_map_sensor, bool has_times,
                     const PlaneWeights& weights) {
  RowWeights row_weights;
  weigh(rows, weights, row_weights);
  LaneSums lanes;
  if (has_times) {
    add_all<true>(rows, row_weights, lanes);
  } else {
    add_all<false>(rows, row_weights, lanes);
  }
  PlaneSums sums;
  sums.weights = simd::total(lanes.weights);
  sums.squares = simd::total(lanes.squares);
  sums.chi_squares = simd::total(lanes.chi_squares);
  set_block(sums.H, 0, 0, simd::symmetric_total(lanes.rr[0]));
  set_block(sums.H, 1, 0, matrix_of(lanes.nr[0]));
  set_block(sums.H, 1, 1, simd::symmetric_total(lanes.nn));
  sums.b.segment<3>(0) = simd::total(lanes.er[0]);
  sums.b.segment<3>(3) = simd::total(lanes.en);
  if (has_times) {
    const Eigen::Matrix3d G = R_map_sensor.transpose();
    set_block(sums.H, 2, 0, G * simd::symmetric_total(lanes.rr[1]));
    set_block(sums.H, 2, 1, G * matrix_of(lanes.nr[1]).transpose());
    set_block(sums.H, 2, 2, G * simd::symmetric_total(lanes.rr[2]) * R_map_sensor);
    set_block(sums.H, 3, 0, 0.5 * G * simd::symmetric_total(lanes.rr[2]));
    set_block(sums.H, 3, 1, 0.5 * G * matrix_of(lanes.nr[2]).transpose());
    set_block(sums.H, 3, 2, 0.5 * G * simd::symmetric_total(lanes.rr[3]) * R_map_sensor);
    set_block(sums.H, 3, 3, 0.25 * G * simd::symmetric_total(lanes.rr[4]) * R_map_sensor);
    sums.b.segment<3>(6) = G * simd::total(lanes.er[1]);
    sums.b.segment<3>(9) = 0.5 * G * simd::total(lanes.er[2]);
  }
  return sums;
}

}  // namespace dynamic_icp::mapping
