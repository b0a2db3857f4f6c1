// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/preprocess/normals.hpp"

#include <numeric>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::preprocess {
namespace {

constexpr std::size_t kBlock = 256;
constexpr std::size_t kFewestNeighbours = 3;

// Scatter (m^2, summed over the neighbours) across which points still count as lying on one line.
constexpr double kLineScatter = 1e-12;

/// Sum of (p - mean)(p - mean)^T over the neighbours.
Eigen::Matrix3d scatter_matrix(std::span<const Eigen::Vector3d> points,
                               const std::vector<spatial::Neighbour>& neighbours) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const spatial::Neighbour& neighbour : neighbours) {
    mean += points[neighbour.index];
  }
  mean /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const spatial::Neighbour& neighbour : neighbours) {
    const Eigen::Vector3d d = points[neighbour.index] - mean;
    scatter += d * d.transpose();
  }
  return scatter;
}

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
  workers.for_blocks(points.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> neighbours;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points[i], static_cast<std::size_t>(config.max_neighbours), config.radius_m, neighbours);
      if (neighbours.size() < kFewestNeighbours) {
        continue;
      }
      eigen.compute(scatter_matrix(points, neighbours));
      if (eigen.eigenvalues()[1] >= kLineScatter) {
        normals.vectors[i] = eigen.eigenvectors().col(0).normalized();
        normals.valid[i] = 1;
      }
    }
  });
  return normals;
}

}  // namespace dynamic_icp::preprocess
