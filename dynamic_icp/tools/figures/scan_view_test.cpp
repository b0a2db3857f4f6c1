// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"

namespace dynamic_icp::figures {
namespace {

/// Points on a plane in front of a sensor that moves with `velocity`, and a car, rows 0 to 99, with a velocity of its
/// own.
struct Scene {
  Eigen::Vector3d velocity{13.0, 0.4, -0.2};
  runs::ObjectRow car{
      .id = 2, .velocity = {-9.0, 1.0, 0.0}, .centroid = {30.0, 3.0, 0.5}, .extent = {4.0, 1.8, 1.4}, .points = 100};
  ScanView view;

  Scene() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    RawScan raw;
    for (int k = 0; k < 3000; ++k) {
      const bool on_car = k < 100;
      const Eigen::Vector3d box(car.extent.x() * unit(random), car.extent.y() * unit(random),
                                car.extent.z() * unit(random));
      const Eigen::Vector3d wide(60.0 * unit(random) + 35.0, 50.0 * unit(random), -1.9);
      const Eigen::Vector3d p = on_car ? Eigen::Vector3d(car.centroid + box) : wide;
      const Eigen::Vector3d point_velocity = on_car ? car.velocity : Eigen::Vector3d::Zero();
      raw.points.push_back(p);
      raw.doppler.push_back(p.normalized().dot(point_velocity - velocity));
      view.labels.push_back(on_car ? 2 : 0);
    }
    view.scan = Scan::from_raw(raw);
    view.ego_velocity = velocity;
    view.objects = {car};
  }
};

TEST(ScanView, StaticPointsHaveNoCompensatedDoppler) {
  const Scene scene;
  const std::vector<double> compensated = ego_motion::compensated_doppler(scene.view.scan, scene.velocity);
  for (std::size_t k = 100; k < compensated.size(); ++k) {
    EXPECT_NEAR(compensated[k], 0.0, 1e-12);
  }
  EXPECT_LT(compensated[0], -5.0) << "the car comes closer";
}

TEST(ScanView, OneRowPerCellWithTheMedianDoppler) {
  const Scene scene;
  const double cell = 2.0;
  std::map<std::pair<int, int>, std::vector<double>> cells;
  const auto cell_of = [&](std::size_t row) {
    const Eigen::Vector3d& p = scene.view.scan.points()[row];
    return std::pair(static_cast<int>(std::floor(p.x() / cell)), static_cast<int>(std::floor(p.y() / cell)));
  };
  for (std::size_t k = 0; k < scene.view.scan.size(); ++k) {
    cells[cell_of(k)].push_back(scene.view.scan.doppler()[k]);
  }
  const std::vector<std::uint32_t> rows = rows_per_cell(scene.view.scan, cell);
  ASSERT_EQ(rows.size(), cells.size());
  for (const std::uint32_t row : rows) {
    std::vector<double>& values = cells.at(cell_of(row));
    std::sort(values.begin(), values.end());
    EXPECT_EQ(scene.view.scan.doppler()[row], values[values.size() / 2]);
  }
}

TEST(ScanView, FindsTheRowsOfAnObjectWithAndWithoutLabels) {
  Scene scene;
  const std::vector<double> compensated = ego_motion::compensated_doppler(scene.view.scan, scene.velocity);
  std::vector<std::uint32_t> car(100);
  for (std::uint32_t k = 0; k < 100; ++k) {
    car[k] = k;
  }
  EXPECT_EQ(rows_on_object(scene.view, compensated, scene.car), car);
  scene.view.labels.clear();
  EXPECT_EQ(rows_on_object(scene.view, compensated, scene.car), car);
  // The centroid of the points a sensor sees lies off the middle of the box.
  runs::ObjectRow near_side = scene.car;
  near_side.centroid.x() -= 1.9;
  EXPECT_EQ(rows_on_object(scene.view, compensated, near_side), car);
  runs::ObjectRow other_way = scene.car;
  other_way.velocity = -other_way.velocity;
  EXPECT_TRUE(rows_on_object(scene.view, compensated, other_way).empty());
}

TEST(ScanView, FootprintIsTheBoxOfTheRowsOrTheExtent) {
  const Scene scene;
  const std::vector<double> compensated = ego_motion::compensated_doppler(scene.view.scan, scene.velocity);
  const Region box = footprint(scene.view, rows_on_object(scene.view, compensated, scene.car), scene.car);
  EXPECT_NEAR(box.middle().x(), 30.0, 0.3);
  EXPECT_NEAR(box.x.length(), 4.0, 0.4);
  EXPECT_NEAR(box.y.length(), 1.8, 0.2);
  const Region bare = footprint(scene.view, {}, scene.car);
  EXPECT_DOUBLE_EQ(bare.x.minimum, 28.0);
  EXPECT_DOUBLE_EQ(bare.y.maximum, 3.9);
}

TEST(ScanView, RegionHoldsSensorAndObjects) {
  Scene scene;
  scene.view.objects.front().centroid = {90.0, -40.0, 0.0};
  const Region region = region_of_interest(scene.view.scan, rows_per_cell(scene.view.scan, 0.5), scene.view.objects);
  EXPECT_TRUE(region.contains(0.0, 0.0));
  EXPECT_TRUE(region.contains(92.0, -40.9));
  EXPECT_LT(region.x.maximum, 100.0);
}

TEST(ScanView, RegionIsFiniteWhateverTheObjectsSay) {
  runs::ObjectRow wild;
  for (const double value : {std::nan(""), 1e300, -1e300}) {
    wild.centroid = {value, value, 0.0};
    const Region region = region_of_interest(Scan(), {}, std::vector<runs::ObjectRow>{wild});
    EXPECT_TRUE(region.contains(0.0, 0.0));
    EXPECT_LT(region.x.length() + region.y.length(), 1000.0);
  }
}

TEST(ScanView, FieldOfViewOfASector) {
  RawScan raw;
  for (int k = -600; k <= 600; ++k) {
    const double azimuth = k * std::numbers::pi / 1800.0;
    raw.points.emplace_back(20.0 * std::cos(azimuth), 20.0 * std::sin(azimuth), 0.0);
    raw.doppler.push_back(0.0);
  }
  const drawing::Range view = field_of_view(Scan::from_raw(raw));
  EXPECT_NEAR(view.minimum, -std::numbers::pi / 3.0, 0.01);
  EXPECT_NEAR(view.maximum, std::numbers::pi / 3.0, 0.01);
}

}  // namespace
}  // namespace dynamic_icp::figures
