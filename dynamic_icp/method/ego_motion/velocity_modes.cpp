// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/velocity_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kVoteLanes = 8;  // hypotheses that are counted together, one per lane

// Of the support of the best; a mode of three noisy rows has lost some to the noise.
constexpr double kMinModeShare = 0.4;

constexpr std::uint64_t kDraws = 5;  // rows looked at for the second and the third row of a sample

// Without a pull towards the start a sample in a plane would have no solution; velocities of 100 m/s are free of it.
constexpr double kFreeSpeedMps = 100.0;

using Lanes = std::array<float, kVoteLanes>;

/// What a vote needs, in single precision: the votes only rank, and twice as many fit into a register.
struct VoteRow {
  float ux, uy, uz;
  float e;  // residual of the start
  float weight;
  float per_width2;  // 1/width^2
};

std::vector<VoteRow> vote_rows(const ConsensusSet& consensus_set, const Vector7d& start, const ModeSearch& search) {
  const DopplerRows& rows = consensus_set.rows;
  std::vector<VoteRow> result(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double slack = search.acceleration_sigma * rows.dt[i];
    const Eigen::Vector3f u = rows.u(i).cast<float>();
    result[i] = {u.x(),
                 u.y(),
                 u.z(),
                 static_cast<float>(residual(rows, i, start)),
                 static_cast<float>(consensus_set.weights[i]),
                 static_cast<float>(1.0 / (search.width_mps * search.width_mps + slack * slack))};
  }
  return result;
}

/// Draws three rows whose lines of sight spread: the second and third are the best of a few drawn.
class Sampler {
 public:
  Sampler(const DopplerRows& rows, const Vector7d& start, const ModeSearch& search)
      : rows_(rows), random_(search.seed) {
    e_.resize(rows.size());
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      e_[i] = residual(rows, i, start);
      if (search.within_mps <= 0.0 || std::abs(e_[i]) < search.within_mps) {
        candidates_.push_back(i);
      }
    }
    pull_ = std::pow(search.width_mps / kFreeSpeedMps, 2.0);
  }

  [[nodiscard]] bool possible() const { return candidates_.size() >= 3; }

  /// Change of velocity from the start that the sample asks for.
  [[nodiscard]] Eigen::Vector3d change(std::uint64_t hypothesis) const {
    const RandomSource random = random_.fork(hypothesis);
    const std::uint32_t i = draw(random, 0);
    const Eigen::Vector3d& u = rows_.u(i);
    const std::uint32_t j = best(random, 1, [&](std::uint32_t k) { return u.cross(rows_.u(k)).squaredNorm(); });
    const Eigen::Vector3d normal = u.cross(rows_.u(j));
    const std::uint32_t l = best(random, 1 + kDraws, [&](std::uint32_t k) { return std::abs(normal.dot(rows_.u(k))); });
    Eigen::Matrix3d U;
    U << u.transpose(), rows_.u(j).transpose(), rows_.u(l).transpose();
    const Eigen::Vector3d e(e_[i], e_[j], e_[l]);
    const Eigen::Matrix3d normal_matrix = U.transpose() * U + pull_ * Eigen::Matrix3d::Identity();
    return -(normal_matrix.inverse() * (U.transpose() * e));
  }

 private:
  [[nodiscard]] std::uint32_t draw(const RandomSource& random, std::uint64_t stream) const {
    return candidates_[(random.bits(stream) >> 32) * candidates_.size() >> 32];
  }

  template <class Merit>
  [[nodiscard]] std::uint32_t best(const RandomSource& random, std::uint64_t stream, const Merit& merit) const {
    std::uint32_t chosen = draw(random, stream);
    double most = merit(chosen);
    for (std::uint64_t k = 1; k < kDraws; ++k) {
      const std::uint32_t other = draw(random, stream + k);
      const double value = merit(other);
      if (value > most) {
        most = value;
        chosen = other;
      }
    }
    return chosen;
  }

  const DopplerRows& rows_;
  RandomSource random_;
  std::vector<double> e_;
  std::vector<std::uint32_t> candidates_;
  double pull_ = 0.0;
};

/// Votes of up to kVoteLanes changes of velocity at once. Lanes do not mix, so the width of a register changes no bit.
void vote(const std::vector<VoteRow>& rows, const Eigen::Vector3d* changes, std::size_t n, double* result) {
  Lanes x{};
  Lanes y{};
  Lanes z{};
  for (std::size_t h = 0; h < n; ++h) {
    x[h] = static_cast<float>(changes[h].x());
    y[h] = static_cast<float>(changes[h].y());
    z[h] = static_cast<float>(changes[h].z());
  }
  Lanes sums{};
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const Lanes vx = x;  // in registers
    const Lanes vy = y;
    const Lanes vz = z;
    Lanes sum{};
    for (const VoteRow& row : rows) {
      DYNAMIC_ICP_LANE_LOOP for (std::size_t l = 0; l < kVoteLanes; ++l) {
        const float e = row.e + row.ux * vx[l] + row.uy * vy[l] + row.uz * vz[l];
        const float share = 1.0F - e * e * row.per_width2;
        sum[l] += row.weight * (share > 0.0F ? share : 0.0F);
      }
    }
    sums = sum;
  });
  for (std::size_t h = 0; h < n; ++h) {
    result[h] = static_cast<double>(sums[h]);
  }
}

}  // namespace

double inlier_weight(const ConsensusSet& consensus_set, const Vector7d& x, double width_mps) {
  const double per_width2 = 1.0 / (width_mps * width_mps);
  double sum = 0.0;
  for (std::size_t i = 0; i < consensus_set.rows.size(); ++i) {
    const double e = residual(consensus_set.rows, i, x);
    sum += consensus_set.weights[i] * std::max(0.0, 1.0 - e * e * per_width2);
  }
  return sum;
}

StateDistance::StateDistance(const DopplerRows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Vector7d J;
    J << rows.u(i), rows.dt[i] * rows.u(i), -1.0;
    gram_ += J * J.transpose();
  }
  if (rows.size() > 0) {
    gram_ /= static_cast<double>(rows.size());
  }
}

double StateDistance::operator()(const Vector7d& a, const Vector7d& b) const {
  const Vector7d change = a - b;
  return std::sqrt(std::max(0.0, change.dot(gram_ * change)));
}

std::vector<VelocityMode> find_modes(const ConsensusSet& consensus_set, const Vector7d& start, const ModeSearch& search,
                                     const Workers& workers) {
  const DopplerRows& rows = consensus_set.rows;
  const Sampler sampler(rows, start, search);
  const std::vector<VoteRow> inlier_weight_by_row = vote_rows(consensus_set, start, search);
  const std::size_t n = sampler.possible() ? search.hypotheses + 1 : 1;
  std::vector<Eigen::Vector3d> changes(n, Eigen::Vector3d::Zero());
  std::vector<double> support(n);
  workers.for_blocks(n, 4 * kVoteLanes, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t h = std::max<std::size_t>(begin, 1); h < end; ++h) {
      changes[h] = sampler.change(h);
    }
    for (std::size_t h = begin; h < end; h += kVoteLanes) {
      vote(inlier_weight_by_row, &changes[h], std::min<std::size_t>(kVoteLanes, end - h), &support[h]);
    }
  });
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return support[a] > support[b]; });

  const StateDistance distance(rows);
  std::vector<VelocityMode> modes;
  for (const std::size_t h : order) {
    if (support[h] < kMinModeShare * support[order.front()]) {
      break;
    }
    Vector7d x = start;
    x.head<3>() += changes[h];
    const bool is_new =
        std::ranges::all_of(modes, [&](const VelocityMode& mode) { return distance(mode.x, x) > search.width_mps; });
    if (is_new) {
      modes.push_back({x, support[h]});
    }
    if (modes.size() == search.max_modes) {
      break;
    }
  }
  return modes;
}

}  // namespace dynamic_icp::ego_motion
