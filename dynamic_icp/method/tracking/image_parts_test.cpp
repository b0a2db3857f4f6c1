// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/image_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/image_cells.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

TEST(ImageCells, ColumnsFollowTheAzimuthThroughOneTurn) {
  int last = 0;
  for (int i = 0; i < 3600; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * (i + 0.5) / 3600.0;
    const ImageCell cell = image_cell(std::cos(azimuth), std::sin(azimuth), 0.0);
    EXPECT_GE(cell.column, last);
    EXPECT_LE(cell.column, last + 1);
    EXPECT_EQ(cell.row, kImageRows / 2);
    last = cell.column;
  }
  EXPECT_EQ(last, kImageColumns - 1);
}

TEST(ImageCells, RowsFollowTheSlopeToTheOutermost) {
  EXPECT_EQ(image_cell(3.0, 4.0, 5.0 * 0.0176).row, kImageRows / 2 + 1);
  EXPECT_EQ(image_cell(3.0, 4.0, -5.0 * 0.0174).row, kImageRows / 2 - 1);
  EXPECT_EQ(image_cell(3.0, 4.0, 100.0).row, kImageRows - 1);
  EXPECT_EQ(image_cell(3.0, 4.0, -100.0).row, 0);
  EXPECT_EQ(image_cell(0.0, 0.0, 1.0).row, kImageRows - 1);
}

/// Points of all sorts of patches: lines around and upright lines, near and far, all around and across the sensor.
Scan mixed_patches(std::size_t patches) {
  RawScan raw;
  for (std::uint64_t k = 0; k < patches; ++k) {
    const RandomSource of_patch = RandomSource(4).fork(k);
    const double azimuth = of_patch.uniform(0, -std::numbers::pi, std::numbers::pi);
    const double width = k % 3 == 0 ? 0.002 : of_patch.uniform(1, 0.0, k % 7 == 0 ? 3.0 : 0.3);
    const double range = of_patch.uniform(2, 1.0, 80.0);
    const double slope = of_patch.uniform(3, -0.4, 0.4);
    for (std::uint64_t i = 0; i < PatchBlock::kRows; ++i) {
      const RandomSource one = of_patch.fork(i);
      const double a = azimuth + width * one.uniform(0, -1.0, 1.0);
      const double r = range * one.uniform(1, 0.3, 1.0);
      const double s = slope + (k % 3 == 0 ? 0.3 : 0.02) * one.uniform(2, -1.0, 1.0);
      raw.points.emplace_back(r * std::cos(a), r * std::sin(a), r * s);
      raw.doppler.push_back(0.0);
    }
  }
  return Scan::from_raw(raw);
}

TEST(ImageParts, EveryPatchWithPointsInAPartIsFoundUntilItIsSeen) {
  constexpr std::size_t kPatches = 150;  // no full blocks of patches
  const Scan scan = mixed_patches(kPatches);
  ASSERT_EQ(scan.size(), kPatches * PatchBlock::kRows);
  ScanPatches patches;
  patches.bound(scan, Workers(1));
  ImageParts parts;
  parts.reset(patches);
  std::size_t needed = 0;
  std::size_t found = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const RandomSource one = RandomSource(5).fork(k);
    ImagePart part;
    part.first_column = static_cast<int>(one.uniform(0, 0.0, kImageColumns - 8.0));
    part.last_column = part.first_column + static_cast<int>(one.uniform(1, 0.0, 8.0));
    part.lowest_row = static_cast<int>(one.uniform(2, 20.0, 90.0));
    part.highest_row = part.lowest_row + static_cast<int>(one.uniform(3, 0.0, 15.0));
    const std::vector<std::uint32_t> unseen = parts.unseen_in(part);
    EXPECT_TRUE(std::ranges::is_sorted(unseen));
    found += unseen.size();
    for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
      const auto points = std::span(scan.points()).subspan(patch * PatchBlock::kRows, PatchBlock::kRows);
      const bool is_there = std::ranges::any_of(points, [&](const Vector3d& point) {
        const ImageCell cell = image_cell(point);
        return cell.column >= part.first_column && cell.column <= part.last_column && cell.row >= part.lowest_row &&
               cell.row <= part.highest_row;
      });
      EXPECT_TRUE(!is_there || std::ranges::binary_search(unseen, patch)) << "patch " << patch << ", part " << k;
      needed += is_there ? 1 : 0;
    }
  }
  EXPECT_GT(needed, 200u);
  EXPECT_LT(found, 300 * kPatches / 8) << "most others are not";

  const ImagePart all{0, kImageColumns - 1, 0, kImageRows - 1};
  EXPECT_EQ(parts.unseen_in(all).size(), kPatches);
  parts.set_seen(7);
  parts.set_seen(kPatches - 1);
  const std::vector<std::uint32_t>& left = parts.unseen_in(all);
  EXPECT_EQ(left.size(), kPatches - 2);
  EXPECT_FALSE(std::ranges::binary_search(left, 7u));
  EXPECT_TRUE(std::ranges::binary_search(parts.seen_in(all), 7u));
  EXPECT_FALSE(std::ranges::binary_search(parts.seen_in(all), 8u));
  EXPECT_TRUE(parts.is_seen(7));
  EXPECT_FALSE(parts.is_seen(8));
  parts.reset(patches);
  EXPECT_EQ(parts.unseen_in(all).size(), kPatches);
}

}  // namespace
}  // namespace dynamic_icp::tracking
