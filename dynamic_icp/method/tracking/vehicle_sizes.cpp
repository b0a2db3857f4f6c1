// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/vehicle_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kAlike = 0.07;    // standard deviation of the logarithm of what is seen of vehicles that are alike ...
constexpr double kScatter = 0.1;   // ... and of what is not seen of them
constexpr double kUnlike = -12.0;  // logarithm of a weight that counts for nothing
constexpr double kLogLargest = 4.0;  // of 55 m, and 2 cm: no vehicle is longer or less wide

struct Weighted {
  double value;
  double weight;
};

bool is_possible(const Eigen::Vector3d& log_size) { return log_size.cwiseAbs().maxCoeff() < kLogLargest; }

/// Half of the weight lies at or below it.
double median_of(std::span<Weighted> values) {
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double total = 0.0;
  for (const Weighted& one : values) {
    total += one.weight;
  }
  double below = 0.0;
  for (const Weighted& one : values) {
    below += one.weight;
    if (below >= 0.5 * total) {
      return one.value;
    }
  }
  return values.back().value;
}

}  // namespace

void VehicleSizes::note(std::int64_t id, const Eigen::Vector3d& size_m) {
  const Vehicle vehicle{id, size_m.array().log()};
  if (!is_possible(vehicle.log_size)) {
    return;
  }
  const auto known =
      std::find_if(vehicles_.begin(), vehicles_.end(), [&](const Vehicle& other) { return other.id == id; });
  if (known != vehicles_.end()) {
    *known = vehicle;
  } else if (vehicles_.size() < kMemory) {
    vehicles_.reserve(kMemory);  // at once, so that later ones ask for nothing
    vehicles_.push_back(vehicle);
  } else {
    vehicles_[next_] = vehicle;
    next_ = (next_ + 1) % kMemory;
  }
}

std::array<Belief, 3> VehicleSizes::complete(const std::array<SeenSize, 3>& seen,
                                             const std::array<Belief, 3>& otherwise) const {
  const double peak = 1.0 / (std::sqrt(2.0 * std::numbers::pi) * kAlike);
  double density = 1.0;
  std::array<double, 3> log_seen;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    log_seen[axis] = std::log(std::max(1e-3, seen[axis].m));
    density *= seen[axis].is_whole ? peak : 1.0;
  }
  struct Resembling {
    const Vehicle* vehicle;
    double weight;
  };
  std::array<Resembling, kMemory> memory;
  std::size_t count = 0;
  double sum = 1.0;  // that of none
  for (const Vehicle& vehicle : vehicles_) {
    double log_weight = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double more = log_seen[axis] - vehicle.log_size[static_cast<Eigen::Index>(axis)];
      const double off = (seen[axis].is_whole ? more : std::max(0.0, more)) / kAlike;
      log_weight -= 0.5 * off * off;
    }
    if (log_weight > kUnlike) {
      memory[count] = {&vehicle, density * std::exp(log_weight)};
      sum += memory[count++].weight;
    }
  }
  const std::span<const Resembling> resembling = std::span(memory).first(count);
  std::array<Belief, 3> result = otherwise;
  if (resembling.empty() || density == 1.0) {  // what little is seen may be a part of any vehicle
    return result;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (seen[axis].is_whole) {
      continue;
    }
    std::array<Weighted, kMemory + 1> values;  // of those that it resembles, and last of none
    values[count] = {otherwise[axis].mean, 1.0};
    std::ranges::transform(resembling, values.begin(), [&](const Resembling& one) {
      const double m = std::exp(one.vehicle->log_size[static_cast<Eigen::Index>(axis)]);
      return Weighted{std::max(seen[axis].m, m), one.weight};
    });
    const double median = median_of(std::span(values).first(count + 1));
    double square = otherwise[axis].variance;
    for (const Weighted& one : std::span(values).first(count + 1)) {
      square += one.weight * (one.value - median) * (one.value - median);
    }
    for (const Resembling& one : resembling) {
      square += one.weight * kScatter * kScatter * median * median;
    }
    result[axis] = {median, square / sum};
  }
  return result;
}

void VehicleSizes::state(StateArchive& archive) {
  archive.each(vehicles_, [&](Vehicle& vehicle) { archive(vehicle.id, vehicle.log_size); });
  archive(next_);
  const auto is_right = [](const Vehicle& vehicle) { return vehicle.id > 0 && is_possible(vehicle.log_size); };
  archive.require(vehicles_.size() <= kMemory && next_ < kMemory && std::ranges::all_of(vehicles_, is_right),
                  "the sizes of vehicles");
}

}  // namespace dynamic_icp::tracking
