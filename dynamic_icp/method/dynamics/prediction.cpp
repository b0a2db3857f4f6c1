// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/prediction.hpp"

#include <vector>

namespace dynamic_icp::dynamics {
namespace {

constexpr std::int32_t kStatic = -1;
constexpr std::int32_t kLeftOut = -2;

}  // namespace

Scan predict(const Scan& scan, std::span<const std::uint8_t> is_dynamic, std::span<const ObjectEstimate> objects,
             double dt_s) {
  std::vector<std::int32_t> object_of(scan.size());
  for (std::size_t row = 0; row < scan.size(); ++row) {
    object_of[row] = is_dynamic[row] != 0 ? kLeftOut : kStatic;
  }
  for (std::size_t k = 0; k < objects.size(); ++k) {
    for (const std::uint32_t row : objects[k].members) {
      object_of[row] = static_cast<std::int32_t>(k);
    }
  }
  std::vector<std::uint32_t> kept;
  kept.reserve(scan.size());
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    if (object_of[row] != kLeftOut) {
      kept.push_back(row);
    }
  }
  Scan source = scan.select(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::int32_t k = object_of[kept[i]];
    if (k >= 0) {
      source.displace(i, objects[static_cast<std::size_t>(k)].velocity_sensor * dt_s);
    }
  }
  return source;
}

}  // namespace dynamic_icp::dynamics
