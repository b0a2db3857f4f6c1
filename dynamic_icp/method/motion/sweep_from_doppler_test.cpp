// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_from_doppler.hpp"

#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Vector3d;
using Stretch = std::vector<SweepSums>;

constexpr double kPeriod_s = 0.1;

Vector3d swaying(double t) {
  return {10.0 + std::sin(3.0 * t), 0.2 * std::sin(5.0 * t + 1.0), 0.3 * std::sin(8.0 * t)};
}

/// A sensor in a static scene, by the equations of the header.
struct Sweeps {
  double duration_s = 0.0;    ///< negative: clockwise
  bool is_as_stored = false;  ///< the place in the file is the time, and has nothing to do with the azimuth
  std::function<Vector3d(double)> velocity = swaying;
  std::function<double(const Vector3d&)> error = [](const Vector3d&) { return 0.0; };
  std::function<double(int)> stamp = [](int scan) { return scan * kPeriod_s; };
  int scans = 24;
  int points = 1500;
  double noise_mps = 0.02;

  [[nodiscard]] RawScan scan(int k) const {
    const RandomSource random = RandomSource(3).fork(static_cast<std::uint64_t>(k));
    RawScan raw;
    for (int i = 0; i < points; ++i) {
      const RandomSource of_point = random.fork(static_cast<std::uint64_t>(i));
      const double share = i / (points - 1.0);
      const double place = i == 0 || i == points - 1 || !is_as_stored ? share : of_point.uniform(0);
      const double azimuth = 2.0 * (place - 0.5);
      const double elevation = of_point.uniform(1, -0.2, 0.2);
      const Vector3d u(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation));
      const double time_s = stamp(k) + std::abs(duration_s) * (duration_s < 0.0 ? 1.0 - share : share);
      raw.points.push_back(20.0 * u);
      raw.doppler.push_back(-u.dot(velocity(time_s)) + error(u) + noise_mps * of_point.normal(2));
    }
    return raw;
  }

  [[nodiscard]] Stretch sums(int threads = 1) const {
    const Workers workers(threads);
    Stretch stretch;
    for (int k = 0; k < scans; ++k) {
      const RawScan raw = scan(k);
      const Scan all = Scan::from_raw(raw);
      std::vector<std::uint32_t> rows(all.size());
      std::iota(rows.begin(), rows.end(), 0u);
      stretch.push_back(sweep_sums(raw, all, rows, stamp(k), workers));
    }
    return stretch;
  }

  [[nodiscard]] SweepDuration found(PointOrder order = PointOrder::kAzimuth) const {
    return sweep_duration(std::vector<Stretch>{sums()}, order, kPeriod_s);
  }
};

void expect_duration(const SweepDuration& found, double duration_s) {
  EXPECT_NEAR(found.duration_s, duration_s, 4.0 * found.sigma_s + 0.002);
  EXPECT_LT(found.sigma_s, 0.006);
}

TEST(SweepFromDoppler, MeasuresHowLongASweepTakesInEitherDirection) {
  for (const double duration_s : {0.1, 0.06, -0.06, -0.1}) {
    SCOPED_TRACE(duration_s);
    const SweepDuration found = Sweeps{.duration_s = duration_s}.found();
    expect_duration(found, duration_s);
    EXPECT_GT(found.explained, 100.0);
  }
}

TEST(SweepFromDoppler, OfAnInstantIsZero) { expect_duration(Sweeps{}.found(), 0.0); }

TEST(SweepFromDoppler, TellsTheOrderInWhichPointsAreStoredFromTheAzimuth) {
  const Sweeps sweeps{.duration_s = 0.1, .is_as_stored = true};
  expect_duration(sweeps.found(PointOrder::kAsStored), 0.1);
  expect_duration(sweeps.found(PointOrder::kAzimuth), 0.0);
}

TEST(SweepFromDoppler, ConstantErrorsOfTheDopplerDoNotMatter) {
  const auto brake = [](double t) { return Vector3d(15.0 - 2.0 * t + 0.3 * std::sin(6.0 * t), 0.0, 0.0); };
  // Looks like a change of velocity by 0.4 m/s over the scan, twice as much as braking makes in a sweep of 0.1 s.
  const auto error = [](const Vector3d& u) { return 0.2 - 0.2 * u.x() * std::atan2(u.y(), u.x()); };
  expect_duration(Sweeps{.velocity = brake, .error = error}.found(), 0.0);
  expect_duration(Sweeps{.duration_s = -0.1, .velocity = brake, .error = error}.found(), -0.1);
}

TEST(SweepFromDoppler, SaysNothingOfASteadyMotion) {
  const auto steady = [](double) { return Vector3d(10.0, 0.0, 0.0); };
  const SweepDuration found = Sweeps{.duration_s = 0.1, .velocity = steady}.found();
  EXPECT_GT(found.sigma_s, 0.05);
}

TEST(SweepFromDoppler, TakesUnevenStampsAndLeavesOutGaps) {
  const auto uneven = [](int scan) { return kPeriod_s * (scan + 0.2 * std::sin(2.0 * scan)); };
  expect_duration(Sweeps{.duration_s = 0.1, .stamp = uneven}.found(), 0.1);
  // Ten scans have six amid others; a gap after the fifth leaves one on either side.
  const auto with_gap = [](int scan) { return kPeriod_s * (scan < 5 ? scan : scan + 2); };
  const SweepDuration ten = Sweeps{.duration_s = 0.1, .scans = 10}.found();
  const SweepDuration nine = Sweeps{.duration_s = 0.1, .scans = 9}.found();
  const SweepDuration five_and_five = Sweeps{.duration_s = 0.1, .stamp = with_gap, .scans = 10}.found();
  EXPECT_TRUE(std::isfinite(ten.sigma_s));
  EXPECT_FALSE(std::isfinite(nine.sigma_s));
  EXPECT_FALSE(std::isfinite(five_and_five.sigma_s));
}

TEST(SweepFromDoppler, GetsBetterByStretches) {
  const Stretch first = Sweeps{.duration_s = 0.1}.sums();
  const Stretch second = Sweeps{.duration_s = 0.1, .stamp = [](int scan) { return 50.0 + scan * kPeriod_s; }}.sums();
  const SweepDuration one = sweep_duration(std::vector<Stretch>{first}, PointOrder::kAzimuth, kPeriod_s);
  const SweepDuration both = sweep_duration(std::vector<Stretch>{first, second}, PointOrder::kAzimuth, kPeriod_s);
  EXPECT_LT(both.sigma_s, one.sigma_s);
  expect_duration(both, 0.1);
}

TEST(SweepFromDoppler, IsTheSameForAnyNumberOfThreads) {
  const Sweeps sweeps{.duration_s = 0.1, .scans = 2, .points = 20000};
  const Stretch one = sweeps.sums(1);
  const Stretch three = sweeps.sums(3);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].products, three[k].products);
  }
}

}  // namespace
}  // namespace dynamic_icp::motion
