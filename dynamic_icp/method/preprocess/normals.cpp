// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/normals.hpp"

#include <array>
#include <numeric>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/preprocess/least_scatter.hpp"
#include "dynamic_icp/method/spatial/neighbourhoods.hpp"

namespace dynamic_icp::preprocess {
namespace {

using simd::kLanes;
using simd::Lanes;
using spatial::KdTree;

constexpr std::size_t kLeavesPerBlock = 32;
constexpr std::size_t kMinNeighbours = 3;

// Scatter (m^2, summed over the neighbours) across which points still count as lying on one line.
constexpr double kLineScatter = 1e-12;

/// Some points of a tree as columns, seen from one of them (m), filled up with zeros to full lanes.
class Columns {
 public:
  explicit Columns(std::size_t most) : most_(most + kLanes), values_(3 * most_) {}

  DYNAMIC_ICP_INLINE void fill(const KdTree& tree, std::span<const std::uint32_t> positions,
                               const Eigen::Vector3d& origin) {
    double* const x = &values_[0];
    double* const y = x + most_;
    double* const z = y + most_;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double* const row = tree.leaf(positions[i] / KdTree::kLeafSize).data() + positions[i] % KdTree::kLeafSize;
      x[i] = row[0] - origin.x();
      y[i] = row[KdTree::kLeafSize] - origin.y();
      z[i] = row[2 * KdTree::kLeafSize] - origin.z();
    }
    count_ = positions.size();
    for (std::size_t i = count_; i < count_ + kLanes; ++i) {
      x[i] = y[i] = z[i] = 0.0;
    }
  }

  /// Sum of (p - mean)(p - mean)^T. Seen from one of them the points are so near that nothing is lost by subtracting
  /// the mean at the end.
  DYNAMIC_ICP_INLINE void add_up(Eigen::Matrix3d& scatter) const {
    std::array<Lanes, 9> sums{};
    for (std::size_t i = 0; i < count_; i += kLanes) {
      Lanes x;
      Lanes y;
      Lanes z;
      simd::load(x, &values_[i]);
      simd::load(y, &values_[most_ + i]);
      simd::load(z, &values_[2 * most_ + i]);
      sums[0] += x;
      sums[1] += y;
      sums[2] += z;
      sums[3] += x * x;
      sums[4] += x * y;
      sums[5] += x * z;
      sums[6] += y * y;
      sums[7] += y * z;
      sums[8] += z * z;
    }
    const auto n = static_cast<double>(count_);
    const double x = simd::sum(sums[0]);
    const double y = simd::sum(sums[1]);
    const double z = simd::sum(sums[2]);
    const double xy = simd::sum(sums[4]) - x * y / n;
    const double xz = simd::sum(sums[5]) - x * z / n;
    const double yz = simd::sum(sums[7]) - y * z / n;
    scatter << simd::sum(sums[3]) - x * x / n, xy, xz,  //
        xy, simd::sum(sums[6]) - y * y / n, yz,         //
        xz, yz, simd::sum(sums[8]) - z * z / n;
  }

 private:
  std::size_t most_;
  std::size_t count_ = 0;
  std::vector<double> values_;
};

}  // namespace

ConfigFields fields(NormalsConfig& config) {
  return {{"radius_m", &config.radius_m, 0.01, 100.0, "m", "neighbours farther away do not take part in the plane fit"},
          {"max_neighbours", &config.max_neighbours, 3, 1000, "", "number of nearest points in the plane fit"}};
}

std::size_t Normals::count() const { return std::accumulate(valid.begin(), valid.end(), std::size_t{0}); }

Normals estimate_normals(std::span<const Eigen::Vector3d> points, const spatial::KdTree& tree,
                         const NormalsConfig& config, const Workers& workers) {
  Normals normals;
  normals.vectors.assign(points.size(), Eigen::Vector3d::Zero());
  normals.valid.assign(points.size(), 0);
  const auto most = static_cast<std::size_t>(config.max_neighbours);
  workers.for_blocks(tree.leaf_count(), kLeavesPerBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    spatial::Neighbourhoods neighbourhoods(tree, most, config.radius_m);
    Columns columns(std::min(most, points.size()));
    Eigen::Matrix3d scatter;
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      neighbourhoods.search(leaf);
      for (std::size_t row = 0; row < neighbourhoods.rows(); ++row) {
        const std::span<const std::uint32_t> neighbours = neighbourhoods.positions(row);
        if (neighbours.size() < kMinNeighbours) {
          continue;
        }
        const std::uint32_t i = tree.order()[leaf * KdTree::kLeafSize + row];
        simd::run([&]() DYNAMIC_ICP_KERNEL {
          columns.fill(tree, neighbours, points[i]);
          columns.add_up(scatter);
        });
        const LeastScatter least = least_scatter(scatter);
        if (least.middle >= kLineScatter) {
          normals.vectors[i] = least.direction;
          normals.valid[i] = 1;
        }
      }
    }
  });
  return normals;
}

}  // namespace dynamic_icp::preprocess
