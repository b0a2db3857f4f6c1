// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_fit.hpp"

#include <algorithm>

namespace dynamic_icp::mapping {
namespace {

constexpr std::size_t kFitBlock = PlaneRows::kMost;

// A patch tells of itself with so many points on it.
constexpr std::uint32_t kInformativePoints = 5;

}  // namespace

PlaneFit::PlaneFit(const Scan& scan, const PlaneMap& map, const Workers& workers)
    : scan_(scan),
      map_(map),
      workers_(workers),
      span_(motion::time_span(scan)),
      at_stamp_(scan.size()),
      cells_(scan.size(), spatial::kNoCell),
      met_(scan.size(), nullptr),
      members_(map.patch_limit()) {}

void PlaneFit::associate(const Eigen::Isometry3d& T_map_sensor, const motion::SweepMotion& sweep, std::size_t stride) {
  T_map_sensor_ = T_map_sensor;
  stride_ = stride;
  const motion::Deskewer deskewer(sweep, span_);
  const std::size_t count = Workers::block_count(scan_.size(), stride);
  workers_.for_each(count, kFitBlock, [&](std::size_t k) {
    const std::size_t i = k * stride;
    const Eigen::Vector3d& point = scan_.points()[i];
    at_stamp_[i] = scan_.has_times() ? deskewer.at_stamp(point, scan_.times()[i]) : point;
    const std::uint64_t cell = map_.finest_cell(T_map_sensor * at_stamp_[i]);
    // Most points stay in their cell from one step to the next.
    if (cell != cells_[i]) {
      cells_[i] = cell;
      met_[i] = map_.find(cell);
    }
  });
  std::fill(members_.begin(), members_.end(), 0U);
  on_planes_ = 0;
  for (std::size_t i = 0; i < scan_.size(); i += stride) {
    if (met_[i] != nullptr) {
      ++members_[met_[i]->id];
      ++on_planes_;
    }
  }
}

PlaneSums PlaneFit::linearise(const PlaneNoise& noise, const PlaneWeights& weights) const {
  const std::size_t count = Workers::block_count(scan_.size(), stride_);
  return workers_.sum_blocks(count, kFitBlock, PlaneSums{}, [&](std::size_t begin, std::size_t end) {
    PlaneSums sums;
    PlaneRows rows;
    for (; begin < end; begin += kFitBlock) {
      fill(rows, begin, std::min(end, begin + kFitBlock), noise);
      sums += sum_planes(rows, T_map_sensor_.linear(), scan_.has_times(), weights);
    }
    return sums;
  });
}

/// The rows of the points [begin, end) of those that take part.
void PlaneFit::fill(PlaneRows& rows, std::size_t begin, std::size_t end, const PlaneNoise& noise) const {
  const double min_variance = noise.min_sigma_m * noise.min_sigma_m;
  const double model_variance = noise.model_sigma_m * noise.model_sigma_m;
  rows.size = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const std::size_t i = k * stride_;
    if (met_[i] == nullptr) {
      continue;
    }
    const Plane& plane = met_[i]->plane;
    const Eigen::Vector3d arm = T_map_sensor_.linear() * at_stamp_[i];
    const Eigen::Vector3d point = arm + T_map_sensor_.translation();
    const Eigen::Vector3d r = arm.cross(plane.normal);
    const std::size_t row = rows.size++;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows.r[axis][row] = r[static_cast<Eigen::Index>(axis)];
      rows.n[axis][row] = plane.normal[static_cast<Eigen::Index>(axis)];
    }
    rows.tau[row] = scan_.has_times() ? scan_.times()[i] : 0.0;
    rows.e[row] = plane.distance(point);
    rows.own[row] = std::max(plane.variance, min_variance);
    rows.common[row] = plane.height_variance(point) + model_variance;
    rows.members[row] = members_[met_[i]->id];
  }
}

Eigen::Matrix3d PlaneFit::position_information_of_noise(const PlaneNoise& noise, const PlaneWeights& weights) const {
  const std::size_t count = Workers::block_count(scan_.size(), stride_);
  const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
  return workers_.sum_blocks(count, kFitBlock, zero, [&](std::size_t begin, std::size_t end) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    PlaneRows rows;
    RowWeights row_weights;
    for (; begin < end; begin += kFitBlock) {
      const std::size_t last = std::min(end, begin + kFitBlock);
      fill(rows, begin, last, noise);
      weigh(rows, weights, row_weights);
      std::size_t row = 0;
      for (std::size_t k = begin; k < last; ++k) {
        if (const Patch* const patch = met_[k * stride_]; patch != nullptr) {
          // The height of a plane under a point d from its mean errs by variance / points * d^T tangential d more than
          // at the mean: by the normal.
          const double scale = patch->plane.variance / patch->plane.points;
          sum += row_weights.w[row++] * scale * patch->plane.tangential;
        }
      }
    }
    return sum;
  });
}

std::vector<PatchMean> PlaneFit::patch_means() const {
  std::vector<const Patch*> met(members_.size(), nullptr);
  std::vector<Eigen::Vector3d> sums(members_.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < scan_.size(); i += stride_) {
    if (met_[i] != nullptr) {
      met[met_[i]->id] = met_[i];
      sums[met_[i]->id] += at_stamp_[i];
    }
  }
  std::vector<PatchMean> means;
  for (std::size_t id = 0; id < met.size(); ++id) {
    if (met[id] != nullptr && members_[id] >= kInformativePoints) {
      const double m = members_[id];
      const Eigen::Vector3d middle = T_map_sensor_ * Eigen::Vector3d(sums[id] / m);
      const double distance = met[id]->plane.distance(middle);
      means.push_back({distance * distance, met[id]->plane.variance / m + met[id]->plane.height_variance(middle)});
    }
  }
  return means;
}

}  // namespace dynamic_icp::mapping
