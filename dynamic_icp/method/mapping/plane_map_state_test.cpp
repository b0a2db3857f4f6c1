// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// What a map of planes remembers: as bytes and back, and what of such bytes is not believed.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"

#include "testing/crafted_state.hpp"
#include "testing/one_thread.hpp"

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;

constexpr int kScans = 8;

/// Scans fade, and cells are dropped soon.
PlaneMapConfig forgetful() {
  PlaneMapConfig config;
  config.memory_scans = 2.0;
  config.max_range_m = 15.0;
  return config;
}

Vector3d place_of_scan(int scan) { return {3.0 * scan, 0.0, 1.5}; }

/// Adds a scan of a floor, a wall and leaves in no plane, taken from where a drive is by then.
void add_scan(PlaneMap& map, int scan) {
  std::vector<Vector3d> points;
  std::vector<double> phases;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const RandomSource one = RandomSource(6).fork(static_cast<std::uint64_t>(scan)).fork(i);
    const double x = one.uniform(0, -10.0, 10.0);
    const double noise = 0.01 * one.normal(1);
    const Vector3d on_floor(x, one.uniform(2, -6.0, 6.0), noise - 1.5);
    const Vector3d on_wall(x, 6.1 + noise, one.uniform(2, -1.5, 2.0));
    const Vector3d in_leaves(one.uniform(2, 4.0, 6.0), one.uniform(3, -4.0, -2.0), one.uniform(4, 0.0, 2.0));
    points.push_back(place_of_scan(scan) + (i % 3 == 0 ? on_floor : i % 3 == 1 ? on_wall : in_leaves));
    phases.push_back(one.uniform(5));
  }
  map.add(points, place_of_scan(scan), kOneThread, phases);
}

PlaneMap map_of_drive() {
  PlaneMap map(forgetful());
  for (int scan = 0; scan < kScans; ++scan) {
    add_scan(map, scan);
  }
  return map;
}

std::string saved(PlaneMap& map) {
  StateArchive archive;
  archive(map);
  return archive.take();
}

void load(const std::string& state, PlaneMap& map) {
  StateArchive archive(state);
  archive(map);
  archive.end();
}

/// The message of the DataError that reading these bytes gives; empty if it gives none.
std::string refusal_of(std::string state, const PlaneMapConfig& config = forgetful()) {
  StateArchive::seal(state);
  PlaneMap map(config);
  try {
    load(state, map);
  } catch (const DataError& error) {
    return error.what();
  }
  return {};
}

std::string without_checksum(std::string state) {
  crafted::remove_checksum(state);
  return state;
}

template <typename Number>
Number number_at(const std::string& state, std::size_t at) {
  Number number{};
  std::memcpy(&number, state.data() + at, sizeof number);
  return number;
}

template <typename Number>
std::string with_number(std::string state, std::size_t at, Number number) {
  std::memcpy(state.data() + at, &number, sizeof number);
  return state;
}

bool are_same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

template <typename Matrix>
bool are_same_bits(const Matrix& a, const Matrix& b) {
  return std::equal(a.data(), a.data() + a.size(), b.data(),
                    [](double one, double other) { return are_same_bits(one, other); });
}

bool are_same_bits(const Plane& a, const Plane& b) {
  return are_same_bits(a.mean, b.mean) && are_same_bits(a.normal, b.normal) &&
         are_same_bits(a.tangential, b.tangential) && are_same_bits(a.variance, b.variance) &&
         are_same_bits(a.points, b.points) && are_same_bits(a.bend, b.bend) && are_same_bits(a.phase, b.phase);
}

/// Whether both maps have the same patch everywhere around the drive; the number of patches that were looked at.
int expect_same_patches(const PlaneMap& a, const PlaneMap& b) {
  EXPECT_EQ(a.patch_limit(), b.patch_limit());
  EXPECT_EQ(a.cell_count(), b.cell_count());
  EXPECT_TRUE(are_same_bits(a.range_sigma_m(), b.range_sigma_m()));
  int found = 0;
  for (double x = -12.0; x < 3.0 * kScans + 15.0; x += 0.5) {
    for (double y = -8.0; y < 8.0; y += 0.5) {
      for (double z = -2.0; z < 4.0; z += 0.5) {
        const Patch* const one = a.find(Vector3d(x, y, z));
        const Patch* const other = b.find(Vector3d(x, y, z));
        EXPECT_EQ(one == nullptr, other == nullptr);
        if (one == nullptr || other == nullptr) {
          continue;
        }
        ++found;
        EXPECT_EQ(one->id, other->id);
        EXPECT_TRUE(are_same_bits(one->plane, other->plane));
      }
    }
  }
  return found;
}

TEST(PlaneMapState, AMapIsTheSameAfterwardsAndGoesOnInTheSameWay) {
  PlaneMap map = map_of_drive();
  PlaneMap loaded(forgetful());
  add_scan(loaded, 20);  // nothing of what it knew may be left
  load(saved(map), loaded);
  EXPECT_GT(expect_same_patches(map, loaded), 500);
  for (int scan = kScans; scan < kScans + 6; ++scan) {
    add_scan(map, scan);
    add_scan(loaded, scan);
    EXPECT_EQ(saved(map), saved(loaded)) << "scan " << scan;
  }
  EXPECT_GT(expect_same_patches(map, loaded), 500);
}

TEST(PlaneMapState, OfAnEmptyMapIsAnEmptyMap) {
  PlaneMap map(forgetful());
  PlaneMap loaded = map_of_drive();
  load(saved(map), loaded);
  EXPECT_TRUE(loaded.empty());
  EXPECT_EQ(loaded.find(place_of_scan(kScans) + Vector3d(0.0, 0.0, -1.5)), nullptr);
  add_scan(map, 0);
  add_scan(loaded, 0);
  EXPECT_EQ(saved(map), saved(loaded));
}

TEST(PlaneMapState, DamagedBytesAreRefused) {
  PlaneMap map = map_of_drive();
  const std::string state = saved(map);
  const RandomSource random(12);
  for (std::uint64_t k = 0; k < 200; ++k) {
    std::string damaged = state;
    char& byte = damaged[random.bits(2 * k) % state.size()];
    byte = static_cast<char>(byte ^ static_cast<char>(1U << (random.bits(2 * k + 1) % 8)));
    PlaneMap other(forgetful());
    EXPECT_THROW(load(damaged, other), DataError);
  }
}

TEST(PlaneMapState, CutBytesAreRefusedWhereverTheyEndAndSoAreMore) {
  PlaneMap map = map_of_drive();
  const std::string state = saved(map);
  const std::string bytes = without_checksum(state);
  const RandomSource random(13);
  for (std::uint64_t k = 0; k < 200; ++k) {
    const std::size_t left = k < 40 ? k : random.bits(k) % bytes.size();
    PlaneMap other(forgetful());
    EXPECT_THROW(load(state.substr(0, left), other), DataError) << left << " bytes";
    EXPECT_NE(refusal_of(bytes.substr(0, left)), "") << left << " bytes with a checksum that fits";
  }
  EXPECT_EQ(refusal_of(bytes), "");
  EXPECT_NE(refusal_of(bytes + '\0').find("more than this program reads"), std::string::npos);
}

TEST(PlaneMapState, WhatCannotBeIsRefusedByName) {
  PlaneMap map = map_of_drive();
  const std::string bytes = without_checksum(saved(map));
  // The bytes begin with scans, the oldest of them that counts, the number of the coarsest cells and their keys.
  constexpr std::size_t kOldest = sizeof(std::uint32_t);
  constexpr std::size_t kKeys = 2 * sizeof(std::uint32_t);
  const auto coarsest = static_cast<std::size_t>(number_at<std::uint64_t>(bytes, kKeys));
  ASSERT_EQ(number_at<std::uint32_t>(bytes, 0), static_cast<std::uint32_t>(kScans));
  ASSERT_GT(coarsest, 10u);
  const std::size_t first_key = kKeys + sizeof(std::uint64_t);
  const std::size_t first_root = first_key + coarsest * sizeof(std::uint64_t) + sizeof(std::uint64_t);
  ASSERT_EQ(number_at<std::uint64_t>(bytes, first_root - sizeof(std::uint64_t)), coarsest);
  const auto root_at = [&](std::size_t number) { return first_root + number * sizeof(std::uint32_t); };
  const auto last_root = number_at<std::uint32_t>(bytes, root_at(coarsest - 1));
  ASSERT_NE(last_root, ~std::uint32_t{0}) << "a cell that lives";

  const auto expect_refused = [](const std::string& message, const std::string& what) {
    EXPECT_NE(message.find(what), std::string::npos) << what << ": " << message;
  };
  expect_refused(refusal_of(with_number(bytes, kOldest, std::uint32_t{kScans + 1})), "the age of the map");
  expect_refused(refusal_of(with_number(bytes, first_key, number_at<std::uint64_t>(bytes, first_key + 8))),
                 "the size of the map");  // one place twice
  expect_refused(refusal_of(with_number(bytes, root_at(coarsest - 2), last_root)), "a cell of the map");  // one cell
  expect_refused(refusal_of(with_number(bytes, root_at(coarsest - 1), std::uint32_t{1U << 30U})), "a cell of the map");
  // The numbers of patches are the last bytes.
  expect_refused(refusal_of(with_number(bytes, bytes.size() - sizeof(std::uint32_t), std::uint32_t{0})),
                 "a plane of the map");
  // Cells with parts of parts, for a map of two sizes.
  PlaneMapConfig fewer = forgetful();
  fewer.levels = 2;
  expect_refused(refusal_of(bytes, fewer), "a cell of the map");
}

TEST(PlaneMapState, WhatSomebodyChangedIsRefusedOrDoesNoHarm) {
  PlaneMap map = map_of_drive();
  const std::string bytes = without_checksum(saved(map));
  const RandomSource random(14);
  int refused = 0;
  int loaded = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    std::string state = bytes;
    crafted::StateEdit(random.bits(2 * k), random.bits(2 * k + 1)).apply(state);
    StateArchive::seal(state);
    PlaneMap other(forgetful());
    try {
      load(state, other);
    } catch (const DataError&) {
      ++refused;
      continue;
    }
    ++loaded;
    add_scan(other, kScans);
    for (double x = -12.0; x < 3.0 * kScans + 15.0; x += 0.5) {
      const Patch* const patch = other.find(Vector3d(x, 0.3, -1.5));
      ASSERT_TRUE(patch == nullptr || patch->id < other.patch_limit());
    }
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(loaded, 20);
}

}  // namespace
}  // namespace dynamic_icp::mapping
