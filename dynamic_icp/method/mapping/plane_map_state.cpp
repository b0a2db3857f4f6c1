// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"

// What the map remembers from scan to scan.
namespace dynamic_icp::mapping {

void PlaneMap::state(StateArchive& archive) {
  archive(scans_, oldest_, root_keys_, roots_, range_noise_.position, range_noise_.variance, free_cells_,
          free_patches_);
  archive.each(cells_, [&](Cell& cell) { archive(cell.parts, cell.patch, cell.last_scan, cell.is_stale); });
  archive.each(moments_, [&](Moments& sums) { archive(sums.weight, sums.first, sums.second, sums.phase, sums.scan); });
  archive.each(patches_, [&](Patch& patch) {
    Plane& plane = patch.plane;
    archive(plane.mean, plane.normal, plane.tangential, plane.variance, plane.points, plane.bend, plane.phase,
            plane.scan, patch.id);
  });
  if (archive.reads()) {
    root_numbers_.clear();
    for (const std::uint64_t key : root_keys_) {
      root_numbers_.number_of(key);
    }
    check_read(archive);
  }
}

/// Whether the cells are trees of so many levels, each cell and patch in one place at most.
void PlaneMap::check_read(const StateArchive& archive) const {
  archive.require(scans_ < kNone / 2 && oldest_ <= scans_ && range_noise_.variance >= 0.0, "the age of the map");
  archive.require(root_keys_.size() == roots_.size() && root_numbers_.count() == roots_.size() &&
                      moments_.size() == cells_.size() && cells_.size() < kNone && patches_.size() < kNone,
                  "the size of the map");
  std::vector<std::uint8_t> is_used(cells_.size(), 0);
  std::vector<std::uint8_t> is_patch_used(patches_.size(), 0);
  const auto use = [&](std::vector<std::uint8_t>& used, std::uint32_t number) {
    archive.require(number < used.size() && used[number] == 0, "a cell of the map");
    used[number] = 1;
  };
  std::vector<std::uint32_t> level;
  for (const std::uint32_t root : roots_) {
    if (root != kNone) {
      level.push_back(root);
    }
  }
  for (int below = config_.levels - 1; !level.empty(); --below) {
    std::vector<std::uint32_t> parts;
    for (const std::uint32_t number : level) {
      use(is_used, number);
      const Cell& cell = cells_[number];
      archive.require(cell.last_scan <= scans_ && moments_[number].weight >= 0.0, "a cell of the map");
      if (cell.patch != kNone) {
        use(is_patch_used, cell.patch);
      }
      std::ranges::copy_if(cell.parts, std::back_inserter(parts), [](std::uint32_t part) { return part != kNone; });
    }
    archive.require(below > 0 || parts.empty(), "a cell of the map");
    level = std::move(parts);
  }
  for (const std::uint32_t cell : free_cells_) {
    use(is_used, cell);
  }
  for (const std::uint32_t patch : free_patches_) {
    use(is_patch_used, patch);
  }
  for (std::size_t number = 0; number < patches_.size(); ++number) {
    archive.require(patches_[number].id == number, "a plane of the map");
  }
}

}  // namespace dynamic_icp::mapping
