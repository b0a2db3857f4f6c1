// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/lazy_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kImageVelocity(20.0, -3.0, 0.5);

/// Half a turn of upright lines of sight, some of them without a point.
Scan half_turn(std::uint64_t seed, bool has_times) {
  RawScan raw;
  for (std::uint64_t column = 0; column < 400; ++column) {
    const RandomSource of_column = RandomSource(seed).fork(column);
    const double azimuth = 2.0 + std::numbers::pi * static_cast<double>(column) / 400.0;
    if (of_column.uniform(0) < 0.2) {
      continue;
    }
    for (std::uint64_t row = 0; row < 48; ++row) {
      const RandomSource one = of_column.fork(row);
      const double range = std::exp(one.uniform(0, 1.0, 4.5));
      const double slope = -0.3 + 0.01 * static_cast<double>(row);
      raw.points.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), range * slope);
      raw.doppler.push_back(0.0);
      if (has_times) {
        raw.times.push_back(0.1 * static_cast<double>(column) / 400.0);
      }
    }
  }
  return Scan::from_raw(raw);
}

/// The whole image, point by point, as it is defined.
struct WholeImage {
  std::vector<double> nearest_m;
  int lowest = kImageRows;
  int highest = 0;

  explicit WholeImage(const Scan& scan)
      : nearest_m(std::size_t{kImageColumns} * kImageRows, std::numeric_limits<double>::infinity()) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const ImageCell cell = image_cell(scan.has_times() ? scan.directions()[i] : scan.points()[i]);
      const double closing = scan.has_times() ? scan.times()[i] * scan.directions()[i].dot(kImageVelocity) : 0.0;
      double& nearest = nearest_m[place_in_image(cell.column, cell.row)];
      nearest = std::min(nearest, std::max(0.0, scan.points()[i].norm() - closing));
      lowest = std::min(lowest, cell.row);
      highest = std::max(highest, cell.row);
    }
  }
};

TEST(LazyImage, AnswersAsIfAllWasDrawnWhoeverAsksFirst) {
  LazyImage image;
  for (const std::uint64_t seed : {1u, 2u}) {  // in the same memory
    for (const bool has_times : {false, true}) {
      Scan scan = half_turn(seed, has_times);
      ScanPatches patches;
      patches.bound(scan, Workers(1));
      for (std::size_t i = 0; has_times && i < scan.size(); ++i) {  // deskewed after that
        scan.displace(i, 2.0 * RandomSource(7).fork(i).uniform(0) * kImageVelocity.normalized());
      }
      const WholeImage whole(scan);
      for (const int threads : {1, 2}) {
        image.begin(scan, patches, kImageVelocity);
        std::vector<std::string> wrong(64);
        Workers(threads).for_each(wrong.size(), 1, [&](std::size_t k) {
          const auto expect = [&](bool is_right, const char* what) { wrong[k] += is_right ? "" : what; };
          for (std::uint64_t i = 0; i < 40; ++i) {
            const RandomSource one = RandomSource(3).fork(k).fork(i);
            const auto column = static_cast<int>(one.uniform(0, 0.0, kImageColumns - 0.01));
            const auto row = static_cast<int>(one.uniform(1, 20.0, 80.0));
            const double expected_m = whole.nearest_m[place_in_image(column, row)];
            const double nearest_m = std::sqrt(static_cast<double>(image.nearest_squared(column, row)));
            expect(nearest_m == expected_m || std::abs(nearest_m - expected_m) < 1e-5 * expected_m, "nearest ");
            const auto cells = std::span(whole.nearest_m).subspan(place_in_image(column, 0), kImageRows);
            expect(image.sees(column) == std::ranges::any_of(cells, [](double m) { return std::isfinite(m); }),
                   "column ");
            expect(image.is_below_all(row) == (row < whole.lowest), "below ");
            expect(image.is_above_all(row) == (row > whole.highest), "above ");
          }
        });
        for (const std::string& text : wrong) {
          EXPECT_EQ(text, "") << "seed " << seed << ", times " << has_times << ", threads " << threads;
        }
      }
    }
  }
}

TEST(LazyImage, DrawsNoMoreThanIsAsked) {
  const Scan scan = half_turn(1, false);
  ScanPatches patches;
  patches.bound(scan, Workers(1));
  LazyImage image;
  image.begin(scan, patches, kImageVelocity);
  const auto drawn = [&](const ImagePart& part = {0, kImageColumns - 1, 0, kImageRows - 1}) {
    std::size_t points = 0;
    image.visit_drawn(part, [&](std::uint32_t) { ++points; });
    return points;
  };
  EXPECT_EQ(drawn(), 0u);
  const ImageCell cell = image_cell(scan.points()[5000]);
  EXPECT_LT(image.nearest_squared(cell.column, cell.row), std::numeric_limits<float>::infinity());
  EXPECT_GT(drawn(), 0u);
  EXPECT_LT(drawn(), scan.size() / 4);
  const std::vector<std::uint32_t> rows{1, 2};
  image.draw_rows(rows);
  EXPECT_EQ(image.place(2), place_in_image(image_cell(scan.points()[2]).column, image_cell(scan.points()[2]).row));
  EXPECT_NEAR(image.squared(2), scan.points()[2].squaredNorm(), 1e-5 * scan.points()[2].squaredNorm());
  EXPECT_LT(drawn(), scan.size() / 4);
  const ImagePart part{cell.column, cell.column + 5, cell.row, cell.row + 5};
  image.draw_part(part);
  EXPECT_LT(drawn(), scan.size() / 4);
  std::size_t in_part = 0;
  image.visit_drawn(part, [&](std::uint32_t row) {
    const ImageCell at = image_cell(scan.points()[row]);
    in_part += at.column >= part.first_column && at.column <= part.last_column && at.row >= part.lowest_row &&
                       at.row <= part.highest_row
                   ? 1
                   : 0;
  });
  EXPECT_EQ(in_part, static_cast<std::size_t>(std::ranges::count_if(scan.points(), [&](const Eigen::Vector3d& point) {
              const ImageCell at = image_cell(point);
              return at.column >= part.first_column && at.column <= part.last_column && at.row >= part.lowest_row &&
                     at.row <= part.highest_row;
            })));
  EXPECT_GT(in_part, 0u);
  image.draw_all();
  EXPECT_EQ(drawn(), scan.size());
  EXPECT_LT(drawn(part), scan.size() / 4) << "no more is visited than is asked";
}

TEST(LazyImage, OfNoPointsNothingIsSeen) {
  LazyImage image;
  image.begin(Scan{}, {}, kImageVelocity);
  EXPECT_EQ(image.nearest_squared(3, 60), std::numeric_limits<float>::infinity());
  EXPECT_FALSE(image.sees(3));
  EXPECT_TRUE(image.is_below_all(60));
  EXPECT_TRUE(image.is_above_all(60));
}

}  // namespace
}  // namespace dynamic_icp::tracking
