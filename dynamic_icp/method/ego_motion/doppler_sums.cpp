// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/method/base/lane_sums.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kCellsPerBlock = 128;
constexpr std::size_t kMaxRows = 1024;  // at a time: what is computed of them stays near the processor
constexpr std::size_t kLanes = simd::kSumLanes;
constexpr double kMinSlope = 0.6;  // of psi' to the weights; 0.8 for normal noise at the default cutoff
constexpr double kWider = 1.4;     // of the scale, in one step: twice the variance

/// What is computed of some rows that follow each other.
struct RowWork {
  std::array<double, kMaxRows> e;            // m/s, residuals
  std::array<double, kMaxRows> w;            // weights
  std::array<double, kMaxRows> cell_weight;  // of the cell that the row belongs to
};

/// The rows [begin, end), at most kMaxRows of them.
struct RowRange {
  std::size_t begin;
  std::size_t end;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Residuals and weights of the points alone.
void evaluate_rows(const DopplerRows& rows, const RowRange& range, const Vector7d& x, double cutoff_mps,
                   RowWork& work) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const ux = rows.ux.data() + range.begin;
    const double* const uy = rows.uy.data() + range.begin;
    const double* const uz = rows.uz.data() + range.begin;
    const double* const s = rows.s.data() + range.begin;
    const double* const dt = rows.dt.data() + range.begin;
    double* const __restrict e_out = work.e.data();
    double* const __restrict w_out = work.w.data();
    const double vx = x[0];
    const double vy = x[1];
    const double vz = x[2];
    const double ax = x[3];
    const double ay = x[4];
    const double az = x[5];
    const double bias = x[6];
    const double per_cutoff2 = 1.0 / (cutoff_mps * cutoff_mps);
    for (std::size_t i = 0; i < range.size(); ++i) {
      const double e =
          s[i] + (ux[i] * (vx + dt[i] * ax) + uy[i] * (vy + dt[i] * ay) + uz[i] * (vz + dt[i] * az)) - bias;
      const double inside = 1.0 - e * e * per_cutoff2;
      const double positive = inside > 0.0 ? inside : 0.0;
      e_out[i] = e;
      w_out[i] = positive * positive;
    }
  });
}

/// The weight of a cell, or a part of one, by the mean of its residuals. That mean is known better than one point: what
/// creeps below the noise of a point shows here.
double evaluate_cell(const RowWork& work, std::size_t begin, std::size_t end, const RobustScale& scale) {
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    weight += work.w[i];
    sum += work.w[i] * work.e[i];
  }
  if (scale.surface_mps <= 0.0 || weight <= 1.0) {
    return 1.0;
  }
  const double variance = scale.noise_mps * scale.noise_mps / weight + scale.surface_mps * scale.surface_mps;
  const double cutoff = scale.cutoff_mps / scale.noise_mps;
  return estimation::tukey_weight(sum / weight, cutoff * std::sqrt(variance));
}

/// Sums over rows, each in lanes that are added up at the end; J = [u; dt u; -1].
struct LaneSums {
  using Lanes = simd::LaneSum;
  std::array<std::array<Lanes, 6>, 3> uu{};  // w dt^k u u^T, upper triangles, k = 0, 1, 2
  std::array<std::array<Lanes, 3>, 2> u{};   // w dt^k u
  std::array<std::array<Lanes, 3>, 2> eu{};  // w e dt^k u
  Lanes w{};
  Lanes we{};
  Lanes slopes{};
  Lanes squares{};
  Lanes inliers{};
};

/// Adds rows to the lanes they fall into. Of rows at the reference time only the sums with k = 0 are not zero.
template <bool kTimed>
DYNAMIC_ICP_INLINE void add_rows(const DopplerRows& rows, const RowRange& range, const RowWork& work,
                                 double per_cutoff2, std::size_t first, std::size_t lanes, LaneSums& sums) {
  const double* const __restrict ux = rows.ux.data() + range.begin + first;
  const double* const __restrict uy = rows.uy.data() + range.begin + first;
  const double* const __restrict uz = rows.uz.data() + range.begin + first;
  const double* const __restrict dt = rows.dt.data() + range.begin + first;
  const double* const __restrict e = work.e.data() + first;
  const double* const __restrict w = work.w.data() + first;
  const double* const __restrict cell_weight = work.cell_weight.data() + first;
  DYNAMIC_ICP_LANE_LOOP for (std::size_t l = 0; l < lanes; ++l) {
    const double weight = cell_weight[l] * w[l];
    const double counts = weight > 0.0 ? 1.0 : 0.0;
    const double e2 = e[l] * e[l];
    const double x2 = e2 * per_cutoff2;
    const double wx = weight * ux[l];
    const double wy = weight * uy[l];
    const double wz = weight * uz[l];
    const double xx = wx * ux[l];
    const double xy = wx * uy[l];
    const double xz = wx * uz[l];
    const double yy = wy * uy[l];
    const double yz = wy * uz[l];
    const double zz = wz * uz[l];
    sums.w[l] += weight;
    sums.we[l] += weight * e[l];
    sums.slopes[l] += counts * cell_weight[l] * (1.0 - x2) * (1.0 - 5.0 * x2);
    sums.squares[l] += counts * e2;
    sums.inliers[l] += counts;
    sums.u[0][0][l] += wx;
    sums.u[0][1][l] += wy;
    sums.u[0][2][l] += wz;
    sums.eu[0][0][l] += e[l] * wx;
    sums.eu[0][1][l] += e[l] * wy;
    sums.eu[0][2][l] += e[l] * wz;
    sums.uu[0][0][l] += xx;
    sums.uu[0][1][l] += xy;
    sums.uu[0][2][l] += xz;
    sums.uu[0][3][l] += yy;
    sums.uu[0][4][l] += yz;
    sums.uu[0][5][l] += zz;
    if constexpr (kTimed) {
      const double t = dt[l];
      const double t2 = t * t;
      sums.u[1][0][l] += t * wx;
      sums.u[1][1][l] += t * wy;
      sums.u[1][2][l] += t * wz;
      sums.eu[1][0][l] += t * e[l] * wx;
      sums.eu[1][1][l] += t * e[l] * wy;
      sums.eu[1][2][l] += t * e[l] * wz;
      sums.uu[1][0][l] += t * xx;
      sums.uu[1][1][l] += t * xy;
      sums.uu[1][2][l] += t * xz;
      sums.uu[1][3][l] += t * yy;
      sums.uu[1][4][l] += t * yz;
      sums.uu[1][5][l] += t * zz;
      sums.uu[2][0][l] += t2 * xx;
      sums.uu[2][1][l] += t2 * xy;
      sums.uu[2][2][l] += t2 * xz;
      sums.uu[2][3][l] += t2 * yy;
      sums.uu[2][4][l] += t2 * yz;
      sums.uu[2][5][l] += t2 * zz;
    }
  }
}

template <bool kTimed>
void add_range(const DopplerRows& rows, const RowRange& range, const RowWork& work, double per_cutoff2,
               LaneSums& sums) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    LaneSums own = sums;  // nothing else points to it, which the compiler must know to use vectors
    std::size_t i = 0;
    for (; i + kLanes <= range.size(); i += kLanes) {
      add_rows<kTimed>(rows, range, work, per_cutoff2, i, kLanes, own);
    }
    add_rows<kTimed>(rows, range, work, per_cutoff2, i, range.size() - i, own);
    sums = own;
  });
}

FitSums finish(const LaneSums& lanes, double noise_mps) {
  FitSums sums;
  sums.H.block<3, 3>(0, 0) = simd::symmetric_total(lanes.uu[0]);
  sums.H.block<3, 3>(0, 3) = simd::symmetric_total(lanes.uu[1]);
  sums.H.block<3, 3>(3, 0) = sums.H.block<3, 3>(0, 3);
  sums.H.block<3, 3>(3, 3) = simd::symmetric_total(lanes.uu[2]);
  sums.gradient.head<3>() = simd::total(lanes.eu[0]);
  sums.gradient.segment<3>(3) = simd::total(lanes.eu[1]);
  sums.weights = simd::total(lanes.w);
  sums.H.block<3, 1>(0, 6) = -simd::total(lanes.u[0]);
  sums.H.block<3, 1>(3, 6) = -simd::total(lanes.u[1]);
  sums.H.block<1, 6>(6, 0) = sums.H.block<6, 1>(0, 6).transpose();
  sums.H(6, 6) = sums.weights;
  sums.gradient[6] = -simd::total(lanes.we);
  const double factor = 1.0 / (noise_mps * noise_mps);
  sums.H *= factor;
  sums.gradient *= factor;
  sums.slopes = simd::total(lanes.slopes);
  sums.inlier_squared = simd::total(lanes.squares);
  sums.inliers = static_cast<std::size_t>(simd::total(lanes.inliers));
  return sums;
}

/// Of rows [begin, end) of the work that belong to one cell; `offset` is the first row of the work.
Vector7d gradient_of(const DopplerRows& rows, std::size_t offset, std::size_t begin, std::size_t end,
                     const RowWork& work) {
  Vector7d gradient = Vector7d::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    const double we = work.cell_weight[i] * work.w[i] * work.e[i];
    const Eigen::Vector3d weu = we * rows.u(offset + i);
    gradient.head<3>() += weu;
    gradient.segment<3>(3) += rows.dt[offset + i] * weu;
    gradient[6] -= we;
  }
  return gradient;
}

/// The longest range of rows from `begin` on that is made of whole cells from `cell` on and fits into the work; a part
/// of the cell where that is too large. Moves `cell` to that of the next range.
RowRange next_range(const DopplerRows& rows, std::size_t begin, std::size_t end_cell, std::size_t& cell) {
  RowRange range{begin, begin};
  while (cell < end_cell && rows.first[cell + 1] - begin <= kMaxRows) {
    ++cell;
    range.end = rows.first[cell];
  }
  if (range.size() == 0) {
    range.end = begin + kMaxRows;
  }
  return range;
}

}  // namespace

FitSums& FitSums::operator+=(const FitSums& other) {
  H += other.H;
  gradient += other.gradient;
  weights += other.weights;
  slopes += other.slopes;
  inlier_squared += other.inlier_squared;
  inliers += other.inliers;
  return *this;
}

bool widen_if_too_narrow(const FitSums& sums, double max_noise_mps, RobustScale& scale) {
  if (sums.slopes >= kMinSlope * sums.weights || scale.noise_mps >= max_noise_mps) {
    return false;
  }
  scale.noise_mps *= kWider;
  scale.cutoff_mps *= kWider;
  scale.surface_mps *= kWider;
  return true;
}

FitSums sum_fit(const DopplerRows& rows, const Vector7d& x, const RobustScale& scale, const Workers& workers,
                std::vector<Vector7d>* cell_gradients) {
  if (cell_gradients != nullptr) {
    cell_gradients->assign(rows.cells(), Vector7d::Zero());
  }
  const double factor = 1.0 / (scale.noise_mps * scale.noise_mps);
  const double per_cutoff2 = 1.0 / (scale.cutoff_mps * scale.cutoff_mps);
  return workers.sum_blocks(rows.cells(), kCellsPerBlock, FitSums{}, [&](std::size_t begin, std::size_t end) {
    LaneSums sums;
    RowWork work;
    std::size_t next_cell = begin;
    for (std::size_t row = rows.first[begin]; row < rows.first[end];) {
      std::size_t cell = next_cell;
      const RowRange range = next_range(rows, row, end, next_cell);
      evaluate_rows(rows, range, x, scale.cutoff_mps, work);
      for (; cell < end && rows.first[cell] < range.end; ++cell) {
        const std::size_t part_begin = std::max<std::size_t>(rows.first[cell], range.begin) - range.begin;
        const std::size_t part_end = std::min<std::size_t>(rows.first[cell + 1], range.end) - range.begin;
        std::fill(work.cell_weight.begin() + static_cast<std::ptrdiff_t>(part_begin),
                  work.cell_weight.begin() + static_cast<std::ptrdiff_t>(part_end),
                  evaluate_cell(work, part_begin, part_end, scale));
        if (cell_gradients != nullptr) {
          (*cell_gradients)[cell] += factor * gradient_of(rows, range.begin, part_begin, part_end, work);
        }
      }
      if (rows.takes_time) {
        add_range<true>(rows, range, work, per_cutoff2, sums);
      } else {
        add_range<false>(rows, range, work, per_cutoff2, sums);
      }
      row = range.end;
    }
    return finish(sums, scale.noise_mps);
  });
}

}  // namespace dynamic_icp::ego_motion
