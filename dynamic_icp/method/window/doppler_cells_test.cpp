// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "testing/one_thread.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kInterval_s = 0.0125;
constexpr double kSector = 2.0 * pi / 300.0;
constexpr double kGate_mps = 10.0;

/// Bundles of points, each well within one cell: of one line, one direction and one time.
struct Bundles {
  std::size_t lines = 4;
  std::size_t directions = 60;
  std::size_t each = 12;
  double near_sigma_mps = 0.0;
  double far_sigma_mps = 0.0;
  bool has_lines = true;

  [[nodiscard]] std::size_t count() const { return lines * directions; }
  [[nodiscard]] std::size_t points() const { return count() * each; }

  /// Bundle b has the rows [b each, (b + 1) each). Odd ones are far.
  [[nodiscard]] RawScan raw(unsigned seed = 1) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal;
    RawScan scan;
    for (std::size_t b = 0; b < count(); ++b) {
      const auto line = static_cast<double>(b % lines);
      const auto direction = static_cast<double>(b / lines);
      for (std::size_t k = 0; k < each; ++k) {
        const double azimuth = -pi + kSector * (5.0 * direction + 0.5 + 0.25 * uniform(random));
        const double elevation = std::asin((4.0 * line - 11.5 + 0.1 * uniform(random)) / 64.0);
        const double range_m = b % 2 == 0 ? 15.0 + uniform(random) : 80.0 + uniform(random);
        scan.points.push_back(range_m * Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation)));
        scan.doppler.push_back(level(b) + (b % 2 == 0 ? near_sigma_mps : far_sigma_mps) * normal(random));
        scan.times.push_back(kInterval_s * (std::fmod(direction, 8.0) + 0.5 + 0.3 * uniform(random)));
        scan.channels.intensity.push_back(static_cast<float>(20.0 + 10.0 * uniform(random)));
        if (has_lines) {
          scan.channels.line.push_back(static_cast<std::uint16_t>(b % lines));
        }
      }
    }
    scan.times.front() = 0.0;
    return scan;
  }

  [[nodiscard]] static double level(std::size_t bundle) { return std::sin(0.1 * static_cast<double>(bundle)); }
};

std::vector<std::uint8_t> all_static(const Scan& scan) { return std::vector<std::uint8_t>(scan.size(), 0); }

std::vector<DopplerCell> cells_of(const Scan& scan, const std::vector<std::uint8_t>& is_moving,
                                  double predicted_mps = 0.0) {
  DopplerCells cells;
  cells.sort(scan, kInterval_s, kOneThread);
  return cells.average(scan, is_moving, scan.doppler(), std::vector<double>(scan.size(), predicted_mps), kGate_mps,
                       kOneThread);
}

TEST(DopplerCells, AreMeansOverTheirPoints) {
  // Without scatter all points of a cell weigh the same.
  for (const bool has_lines : {true, false}) {
    Bundles bundles;
    bundles.has_lines = has_lines;
    const Scan scan = Scan::from_raw(bundles.raw());
    const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
    ASSERT_EQ(cells.size(), bundles.count());
    for (std::size_t b = 0; b < cells.size(); ++b) {  // in the order of their first points
      Vector3d u = Vector3d::Zero();
      double time_s = 0.0, range_m = 0.0, intensity = 0.0;
      for (std::size_t i = b * bundles.each; i < (b + 1) * bundles.each; ++i) {
        const double share = 1.0 / static_cast<double>(bundles.each);
        u += share * scan.directions()[i];
        time_s += share * scan.times()[i];
        range_m += share * scan.points()[i].norm();
        intensity += share * static_cast<double>(scan.channels().intensity[i]);
      }
      EXPECT_LT((cells[b].u - u).norm(), 1e-12);
      EXPECT_NEAR(cells[b].time_s, time_s, 1e-12);
      EXPECT_NEAR(cells[b].range_m, range_m, 1e-10);
      EXPECT_NEAR(cells[b].intensity, intensity, 1e-10);
      EXPECT_NEAR(cells[b].s, Bundles::level(b), 1e-12);
      EXPECT_NEAR(cells[b].points, static_cast<double>(bundles.each), 1e-6);
      EXPECT_EQ(cells[b].line, has_lines ? b % bundles.lines : DopplerCells::line_of(u));
      EXPECT_EQ(cells[b].lxu, Vector3d::Zero());
    }
  }
}

TEST(DopplerCells, AzimuthsWithLittleThatStandsAreHidden) {
  // Lines of one direction are its bundles: in a third of the directions all points move, in another third all but one
  // line of the four.
  Bundles bundles;
  const Scan scan = Scan::from_raw(bundles.raw());
  std::vector<std::uint8_t> is_moving = all_static(scan);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::size_t bundle = i / bundles.each;
    const std::size_t direction = bundle / bundles.lines;
    is_moving[i] = direction % 3 == 0 || (direction % 3 == 1 && bundle % bundles.lines != 0) ? 1 : 0;
  }
  DopplerCells cells;
  cells.sort(scan, kInterval_s, kOneThread);
  cells.average(scan, is_moving, scan.doppler(), std::vector<double>(scan.size(), 0.0), kGate_mps, kOneThread);
  ASSERT_EQ(cells.hidden_azimuths(scan).size(), 1U);
  EXPECT_DOUBLE_EQ(cells.hidden_azimuths(scan)[0], 1.0 / 3.0);
}

TEST(DopplerCells, AFewFalsePointsHideNoAzimuth) {
  RawScan raw = Bundles{}.raw();
  std::vector<std::uint8_t> is_moving(raw.points.size(), 0);
  for (int k = 0; k < 60; ++k) {  // between the directions of the bundles
    const double azimuth = -pi + kSector * (5.0 * k + 2.5);
    raw.points.emplace_back(90.0 * std::cos(azimuth), 90.0 * std::sin(azimuth), 1.0);
    raw.doppler.push_back(30.0);
    raw.times.push_back(raw.times.front());
    raw.channels.intensity.push_back(20.0F);
    raw.channels.line.push_back(0);
    is_moving.push_back(1);
  }
  const Scan scan = Scan::from_raw(raw);
  DopplerCells cells;
  cells.sort(scan, kInterval_s, kOneThread);
  cells.average(scan, is_moving, scan.doppler(), std::vector<double>(scan.size(), 0.0), kGate_mps, kOneThread);
  EXPECT_EQ(cells.hidden_azimuths(scan), std::vector<double>{0.0});
}

TEST(DopplerCells, HiddenAzimuthsAreThoseOfEachSensor) {
  RawScan raw = Bundles{}.raw();
  const std::size_t half = raw.points.size() / 2;
  raw.mountings = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    raw.channels.sensor.push_back(i < half ? std::uint8_t{0} : std::uint8_t{1});
  }
  const Scan scan = Scan::from_raw(raw);
  std::vector<std::uint8_t> is_moving(scan.size(), 0);
  std::fill(is_moving.begin() + static_cast<std::ptrdiff_t>(half), is_moving.end(), std::uint8_t{1});
  DopplerCells cells;
  cells.sort(scan, kInterval_s, kOneThread);
  cells.average(scan, is_moving, scan.doppler(), std::vector<double>(scan.size(), 0.0), kGate_mps, kOneThread);
  EXPECT_EQ(cells.hidden_azimuths(scan), (std::vector<double>{0.0, 1.0}));
}

TEST(DopplerCells, PointsFartherApartInTimeAreApart) {
  RawScan raw;
  for (int k = 0; k < 40; ++k) {
    raw.points.emplace_back(20.0, 0.1, 1.0);
    raw.doppler.push_back(1.0);
    raw.times.push_back(k == 0 ? 0.0 : 0.1 * k / 40.0 + 0.0005);
  }
  const Scan scan = Scan::from_raw(raw);
  const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
  EXPECT_EQ(cells.size(), 8U);
  for (const DopplerCell& cell : cells) {
    EXPECT_NEAR(cell.points, 5.0, 1e-9);
  }
}

TEST(DopplerCells, LearnTheNoiseOfPoints) {
  Bundles bundles;
  bundles.directions = 60;
  bundles.lines = 8;
  bundles.near_sigma_mps = 0.05;
  bundles.far_sigma_mps = 0.2;
  const Scan scan = Scan::from_raw(bundles.raw());
  DopplerCells cells;
  cells.sort(scan, kInterval_s, kOneThread);
  cells.average(scan, all_static(scan), scan.doppler(), std::vector<double>(scan.size(), 0.0), kGate_mps, kOneThread);
  // A median of m deviations tells sigma to 1.17 / sqrt(m): of 240 points in a bin 8 %, of the 12 bins together 2 %.
  for (const auto& [range_m, sigma] : {std::pair{15.0, 0.05}, std::pair{80.0, 0.2}}) {
    double sum = 0.0;
    for (const double intensity : {11.0, 17.0, 23.0, 29.0}) {
      const double variance = cells.noise().variance[cells.noise().bin(range_m, intensity)];
      EXPECT_NEAR(std::sqrt(variance), sigma, 0.25 * sigma);
      sum += 0.25 * variance;
    }
    EXPECT_NEAR(std::sqrt(sum), sigma, 0.1 * sigma);
  }
}

TEST(DopplerCells, WeighTheirMeansByTheNoise) {
  Bundles bundles;
  bundles.lines = 8;
  bundles.near_sigma_mps = 0.05;
  bundles.far_sigma_mps = 0.2;
  double chi_squares = 0.0;
  std::size_t count = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Scan scan = Scan::from_raw(bundles.raw(seed));
    const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
    ASSERT_EQ(cells.size(), bundles.count());
    for (std::size_t b = 0; b < cells.size(); ++b, ++count) {
      chi_squares += std::pow(cells[b].s - Bundles::level(b), 2) * cells[b].weight;
    }
  }
  // 2400 squares of normal errors average to one within 0.03; a kernel costs a few hundredths.
  EXPECT_NEAR(chi_squares / static_cast<double>(count), 1.0, 0.15);
}

TEST(DopplerCells, WeighPointsByHowFarTheyAreFromTheOthers) {
  // Tukey's weight, 4.5 standard deviations wide, around the plain mean of what differs from the prediction.
  Bundles bundles;
  bundles.near_sigma_mps = 0.05;
  bundles.far_sigma_mps = 0.2;
  const Scan scan = Scan::from_raw(bundles.raw());
  DopplerCells sorter;
  sorter.sort(scan, kInterval_s, kOneThread);
  const std::vector<double> predicted = Scan::from_raw(Bundles{}.raw()).doppler();
  const std::vector<DopplerCell>& cells =
      sorter.average(scan, all_static(scan), scan.doppler(), predicted, kGate_mps, kOneThread);
  ASSERT_EQ(cells.size(), bundles.count());
  for (std::size_t b = 0; b < cells.size(); ++b) {
    double mean = 0.0, points = 0.0, weight = 0.0, s = 0.0;
    for (std::size_t i = b * bundles.each; i < (b + 1) * bundles.each; ++i) {
      mean += (scan.doppler()[i] - predicted[i]) / static_cast<double>(bundles.each);
    }
    for (std::size_t i = b * bundles.each; i < (b + 1) * bundles.each; ++i) {
      const double variance =
          sorter.noise()
              .variance[sorter.noise().bin(scan.points()[i].norm(), static_cast<double>(scan.channels().intensity[i]))];
      const double off = scan.doppler()[i] - predicted[i] - mean;
      const double robust = std::pow(std::max(0.0, 1.0 - off * off / (4.5 * 4.5 * variance)), 2);
      points += robust;
      weight += robust / variance;
      s += robust / variance * scan.doppler()[i];
    }
    EXPECT_NEAR(cells[b].points, points, 1e-9);
    EXPECT_NEAR(cells[b].weight, weight, 1e-9 * weight);
    EXPECT_NEAR(cells[b].s, s / weight, 1e-10);
  }
}

TEST(DopplerCells, OutliersWithinACellWeighNothing) {
  Bundles bundles;
  bundles.each = 30;
  bundles.near_sigma_mps = bundles.far_sigma_mps = 0.05;
  RawScan raw = bundles.raw();
  for (std::size_t b = 0; b < bundles.count(); ++b) {
    raw.doppler[b * bundles.each + 3] += b % 3 == 0 ? 2.0 : 0.5;
  }
  const Scan scan = Scan::from_raw(raw);
  const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
  ASSERT_EQ(cells.size(), bundles.count());
  const Scan clean = Scan::from_raw(bundles.raw());
  const std::vector<DopplerCell> expected = cells_of(clean, all_static(clean));
  double squares = 0.0;
  double by_outlier = 0.0;
  for (std::size_t b = 0; b < cells.size(); ++b) {
    EXPECT_LT(cells[b].points, static_cast<double>(bundles.each - 1) + 1e-9);
    by_outlier += (cells[b].s - expected[b].s) / static_cast<double>(cells.size());
    squares += std::pow(cells[b].s - Bundles::level(b), 2) / static_cast<double>(cells.size());
  }
  // Averaged with the others an outlier would shift the mean by 0.033 m/s: 0.5 / 30 of most, 2.0 / 30 of some.
  EXPECT_LT(std::abs(by_outlier), 0.008);
  EXPECT_LT(std::sqrt(squares), 2.0 * 0.05 / std::sqrt(30.0));
}

TEST(DopplerCells, WhatIsBeyondTheGateTakesNoPart) {
  Bundles bundles;
  RawScan raw = bundles.raw();
  raw.doppler[0] += 15.0;
  const Scan scan = Scan::from_raw(raw);
  const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
  EXPECT_NEAR(cells[0].s, Bundles::level(0), 1e-12);
  EXPECT_NEAR(cells[0].points, static_cast<double>(bundles.each - 1), 1e-6);
  EXPECT_TRUE(cells_of(scan, all_static(scan), 100.0).empty()) << "nothing is within the gate";
}

TEST(DopplerCells, MovingRowsTakeNoPart) {
  Bundles bundles;
  RawScan raw = bundles.raw();
  std::vector<std::uint8_t> is_moving(bundles.points(), 0);
  for (std::size_t i = 0; i < bundles.each; ++i) {
    is_moving[i] = 1;  // the whole of bundle 0
  }
  is_moving[bundles.each + 2] = 1;  // one of bundle 1
  raw.doppler[bundles.each + 2] = 3.0;
  const Scan scan = Scan::from_raw(raw);
  const std::vector<DopplerCell> cells = cells_of(scan, is_moving);
  ASSERT_EQ(cells.size(), bundles.count() - 1);
  EXPECT_NEAR(cells[0].s, Bundles::level(1), 1e-12);
  EXPECT_NEAR(cells[0].points, static_cast<double>(bundles.each - 1), 1e-6);
  EXPECT_TRUE(cells_of(scan, std::vector<std::uint8_t>(bundles.points(), 1)).empty());
}

TEST(DopplerCells, SensorsOfARigHaveCellsAndLeverArmsOfTheirOwn) {
  RawScan raw;
  const std::vector<Vector3d> arms = {{1.0, 0.0, 2.0}, {-1.0, 0.5, 2.0}};
  for (const Vector3d& arm : arms) {
    raw.mountings.push_back(Eigen::Isometry3d(Eigen::Translation3d(arm)));
  }
  for (std::uint8_t k = 0; k < 20; ++k) {
    const std::uint8_t sensor = k % 2;
    raw.points.push_back(arms[sensor] + Vector3d(30.0, 0.2, 0.5));
    raw.doppler.push_back(sensor == 0 ? 1.0 : -2.0);
    raw.channels.sensor.push_back(sensor);
  }
  const Scan scan = Scan::from_raw(raw);
  const std::vector<DopplerCell> cells = cells_of(scan, all_static(scan));
  ASSERT_EQ(cells.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(cells[k].sensor, k);
    EXPECT_NEAR(cells[k].s, k == 0 ? 1.0 : -2.0, 1e-12);
    EXPECT_LT((cells[k].u - Vector3d(30.0, 0.2, 0.5).normalized()).norm(), 1e-9);
    EXPECT_LT((cells[k].lxu - arms[k].cross(cells[k].u)).norm(), 1e-12);
  }
}

TEST(DopplerCells, AllDirectionsHaveCells) {
  // Straight ahead, to the sides, behind, up and down: no direction falls out of the numbering.
  RawScan raw;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 20000; ++k) {
    raw.points.push_back(20.0 * Vector3d(normal(random), normal(random), normal(random)).normalized());
    raw.doppler.push_back(0.0);
  }
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                               Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(-1, -1e-300, 0)}) {
    raw.points.push_back(5.0 * axis);
    raw.doppler.push_back(0.0);
  }
  const Scan scan = Scan::from_raw(raw);
  double points = 0.0;
  for (const DopplerCell& cell : cells_of(scan, all_static(scan))) {
    points += cell.points;
    EXPECT_GT(cell.u.norm(), 0.5);
  }
  EXPECT_NEAR(points, static_cast<double>(scan.size()), 1e-3);
}

TEST(DopplerCells, AnEmptyScanHasNone) {
  const Scan nothing;
  DopplerCells cells;
  cells.sort(nothing, kInterval_s, kOneThread);
  EXPECT_TRUE(cells.average(nothing, {}, {}, {}, kGate_mps, kOneThread).empty());
  // And the next scan is as if there had been none.
  const Bundles bundles;
  const Scan scan = Scan::from_raw(bundles.raw());
  cells.sort(scan, kInterval_s, kOneThread);
  EXPECT_EQ(
      cells
          .average(scan, all_static(scan), scan.doppler(), std::vector<double>(scan.size(), 0.0), kGate_mps, kOneThread)
          .size(),
      bundles.count());
}

}  // namespace
}  // namespace dynamic_icp::window
