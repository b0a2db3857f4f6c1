// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/correspondences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/spatial/space_order.hpp"

namespace dynamic_icp::registration {
namespace {

using simd::kLanes;
using simd::LaneMask;
using simd::Lanes;

constexpr std::size_t kSearchBlock = 128;  // groups
constexpr std::size_t kBatch = 64;         // points that are looked up together
constexpr double kCell_m = 0.5;            // points in the same cell are neighbours in the groups

// Points are looked up beyond the gate, so that the nearest few are found where they are sparse, and that those without
// a partner need no new search at every step.
constexpr double kReachOverGate = 1.75;

// Far more than the rounding of the distances compared, far less than any distance that matters.
constexpr double kRounding_m = 1e-9;

constexpr unsigned kAllLanes = (1U << kLanes) - 1;

/// Rotation and translation as numbers.
struct Pose {
  explicit Pose(const Eigen::Isometry3d& T) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        R[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = T.linear()(i, j);
      }
      t[static_cast<std::size_t>(i)] = T.translation()[i];
    }
  }
  std::array<std::array<double, 3>, 3> R;
  std::array<double, 3> t;
};

DYNAMIC_ICP_INLINE void subtract(Lanes& a, const double* b) {
  Lanes other;
  simd::load(other, b);
  a -= other;
}

DYNAMIC_ICP_INLINE void squared_distance(const SourceRows::Vectors& a, const SourceRows::Vectors& b, Lanes& squared) {
  Lanes dx;
  Lanes dy;
  Lanes dz;
  simd::load(dx, a[0].data());
  simd::load(dy, a[1].data());
  simd::load(dz, a[2].data());
  subtract(dx, b[0].data());
  subtract(dy, b[1].data());
  subtract(dz, b[2].data());
  squared = (dx * dx + dy * dy) + dz * dz;
}

/// Moves a group and measures the distances to its partners. A bit for each lane whose partner is not known.
DYNAMIC_ICP_INLINE unsigned move(SourceRows& group, const Pose& pose) {
  Lanes x;
  Lanes y;
  Lanes z;
  simd::load(x, group.point[0].data());
  simd::load(y, group.point[1].data());
  simd::load(z, group.point[2].data());
  for (std::size_t i = 0; i < 3; ++i) {
    const Lanes moved = ((pose.R[i][0] * x + pose.R[i][1] * y) + pose.R[i][2] * z) + pose.t[i];
    simd::store(group.moved[i].data(), moved);
  }
  Lanes distance;
  squared_distance(group.moved, group.target, distance);
  simd::store(group.squared_distance.data(), distance);
  Lanes validity;
  simd::load(validity, group.squared_validity.data());
  squared_distance(group.moved, group.at, distance);
  const LaneMask known = distance < validity;
  const LaneMask weighted = ~known & LaneMask{1, 2, 4, 8};
  return static_cast<unsigned>((weighted[0] | weighted[1]) | (weighted[2] | weighted[3]));
}

void put(SourceRows::Vectors& vectors, std::size_t lane, const Eigen::Vector3d& v) {
  vectors[0][lane] = v.x();
  vectors[1][lane] = v.y();
  vectors[2][lane] = v.z();
}

Eigen::Vector3d get(const SourceRows::Vectors& vectors, std::size_t lane) {
  return {vectors[0][lane], vectors[1][lane], vectors[2][lane]};
}

}  // namespace

Fit fit_of(std::size_t pairs, double squared_distances, std::size_t source_size) {
  if (pairs == 0) {
    return {};
  }
  const auto count = static_cast<double>(pairs);
  return {pairs, count / static_cast<double>(source_size), std::sqrt(squared_distances / count)};
}

Correspondences evaluated(std::vector<Correspondence> pairs, std::size_t source_size) {
  double sum = 0.0;
  for (const Correspondence& pair : pairs) {
    sum += pair.squared_distance;
  }
  const Fit fit = fit_of(pairs.size(), sum, source_size);
  return {std::move(pairs), fit.fitness, fit.inlier_rmse};
}

CorrespondenceSearch::CorrespondenceSearch(const Scan& source, const Target& target, const Gate& gate,
                                           bool needs_normals, const Workers& workers)
    : source_(source),
      target_(target),
      gate_m_(source.size()),
      widest_gate_m_(gate.max_distance_m),
      needs_normals_(needs_normals),
      workers_(workers),
      place_of_(source.size()),
      groups_((source.size() + kLanes - 1) / kLanes),
      lanes_of_last_group_(kAllLanes >> (kLanes * groups_.size() - source.size())),
      cache_(source.size()) {
  const std::vector<std::uint32_t> order = spatial::space_order(source.points(), kCell_m);
  for (std::uint32_t place = 0; place < kLanes * groups_.size(); ++place) {
    SourceRows& group = groups_[place / kLanes];
    const std::size_t lane = place % kLanes;
    if (place < source.size()) {
      const std::uint32_t row = order[place];
      place_of_[row] = place;
      gate_m_[place] = gate.at(source.points()[row]);
      widest_gate_m_ = std::max(widest_gate_m_, gate_m_[place]);
      put(group.point, lane, source.points()[row]);
      put(group.ray, lane, source.doppler()[row] * source.directions()[row]);
    }
    group.squared_validity[lane] = -1.0;
    group.squared_gate[lane] = -1.0;
    group.partner[lane] = SourceRows::kNone;
  }
}

void CorrespondenceSearch::locate(const Eigen::Isometry3d& T_target_source, std::size_t begin, std::size_t end) {
  const Pose pose(T_target_source);
  std::vector<std::uint32_t> unknown(kLanes * (end - begin) + 1);
  std::size_t count = 0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t g = begin; g < end; ++g) {
      const bool is_last = g + 1 == groups_.size();
      const unsigned lanes = move(groups_[g], pose) & (is_last ? lanes_of_last_group_ : kAllLanes);
      for (unsigned lane = 0; lanes != 0 && lane < kLanes; ++lane) {
        unknown[count] = static_cast<std::uint32_t>(kLanes * g + lane);
        count += lanes >> lane & 1U;
      }
    }
  });
  unknown.resize(count);
  look_up(unknown);
}

void CorrespondenceSearch::look_up(std::span<const std::uint32_t> places) {
  std::vector<std::uint32_t> unknown;
  unknown.reserve(places.size());
  for (const std::uint32_t place : places) {
    if (!choose_among_known(place)) {
      unknown.push_back(place);
    }
  }
  search(unknown);
}

/// False when a point that is not among the known ones might be nearer.
bool CorrespondenceSearch::choose_among_known(std::uint32_t place) {
  const NeighbourCache& known = cache_[place];
  const Eigen::Vector3d point = get(groups_[place / kLanes].moved, place % kLanes);
  const double others = known.others - std::sqrt(spatial::squared_distance(point, known.at)) - kRounding_m;
  if (!(others > 0.0)) {
    return false;
  }
  const double squared_others = others * others;
  spatial::Neighbour first{SourceRows::kNone, squared_others};
  double second = squared_others;
  for (std::size_t k = 0; k < known.count; ++k) {
    const std::uint32_t j = known.nearest[k];
    const spatial::Neighbour candidate{j, spatial::squared_distance(target_.scan.points()[j], point)};
    if (spatial::is_nearer(candidate, first)) {
      second = first.squared_distance;
      first = candidate;
    } else {
      second = std::min(second, candidate.squared_distance);
    }
  }
  if (first.index != SourceRows::kNone) {
    remember(place, point, &first, std::sqrt(second));
    return true;
  }
  if (others > gate_m_[place]) {
    remember(place, point, nullptr, others);
    return true;
  }
  return false;
}

void CorrespondenceSearch::search(std::span<const std::uint32_t> places) {
  if (places.empty()) {
    return;
  }
  const double reach = kReachOverGate * widest_gate_m_;
  spatial::FewNearestSearch search(target_.tree, reach);
  std::array<Eigen::Vector3d, kBatch> points;
  std::array<spatial::FewNearest, kBatch> found;
  for (std::size_t first = 0; first < places.size(); first += kBatch) {
    const std::size_t size = std::min(kBatch, places.size() - first);
    for (std::size_t k = 0; k < size; ++k) {
      points[k] = get(groups_[places[first + k] / kLanes].moved, places[first + k] % kLanes);
    }
    search.search(std::span(points).first(size), std::span(found).first(size));
    for (std::size_t k = 0; k < size; ++k) {
      const auto& [neighbours, count] = found[k];
      NeighbourCache& known = cache_[places[first + k]];
      known.at = points[k];
      known.count = static_cast<std::uint32_t>(count);
      for (std::size_t n = 0; n < count; ++n) {
        known.nearest[n] = neighbours[n].index;
      }
      // Of a full list the last one says how far the rest is.
      known.others = count == neighbours.size() ? std::sqrt(neighbours.back().squared_distance) : reach;
      const double second = count > 1 ? std::sqrt(neighbours[1].squared_distance) : known.others;
      remember(places[first + k], points[k], count > 0 ? neighbours.data() : nullptr, second);
    }
  }
}

/// `others`: how far all target points but the nearest are at least, m.
void CorrespondenceSearch::remember(std::uint32_t place, const Eigen::Vector3d& point,
                                    const spatial::Neighbour* nearest, double others) {
  const bool has_partner = nearest != nullptr;
  const std::uint32_t j = has_partner ? nearest->index : SourceRows::kNone;
  // Moved by m, the nearest one is at most as far as now and m, all others at least others - m.
  const double validity =
      (has_partner ? 0.5 * (others - std::sqrt(nearest->squared_distance)) : others - gate_m_[place]) - kRounding_m;

  SourceRows& group = groups_[place / kLanes];
  const std::size_t lane = place % kLanes;
  const bool pairs = has_partner && (!needs_normals_ || target_.has_normal[j] != 0);
  const bool has_normal = has_partner && !target_.normals.empty();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  put(group.at, lane, point);
  group.squared_validity[lane] = validity > 0.0 ? validity * validity : -1.0;
  group.squared_gate[lane] = pairs ? gate_m_[place] * gate_m_[place] : -1.0;
  put(group.target, lane, has_partner ? target_.scan.points()[j] : zero);
  put(group.normal, lane, has_normal ? target_.normals[j] : zero);
  put(group.direction, lane, has_partner ? target_.scan.directions()[j] : zero);
  group.doppler[lane] = has_partner ? target_.scan.doppler()[j] : 0.0;
  group.partner[lane] = j;
  group.squared_distance[lane] = has_partner ? nearest->squared_distance : 0.0;
}

Correspondences CorrespondenceSearch::find(const Eigen::Isometry3d& T_target_source) {
  workers_.for_blocks(groups_.size(), kSearchBlock,
                      [&](std::size_t, std::size_t begin, std::size_t end) { locate(T_target_source, begin, end); });
  return pairs();
}

Correspondences CorrespondenceSearch::pairs() const {
  std::vector<Correspondence> pairs;
  pairs.reserve(source_.size());
  for (std::uint32_t i = 0; i < source_.size(); ++i) {
    const SourceRows& group = groups_[place_of_[i] / kLanes];
    const std::size_t lane = place_of_[i] % kLanes;
    if (group.squared_distance[lane] <= group.squared_gate[lane]) {
      pairs.push_back({i, group.partner[lane], group.squared_distance[lane]});
    }
  }
  return evaluated(std::move(pairs), source_.size());
}

}  // namespace dynamic_icp::registration
