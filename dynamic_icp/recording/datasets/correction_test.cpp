// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/correction.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

using Eigen::Vector3d;

/// Two scans of two points, 0.1 s apart, late in this century: nanoseconds that no double holds.
class TwoScans final : public Dataset {
 public:
  explicit TwoScans(std::vector<std::int64_t> truth_ns = {}, std::int64_t first_ns = kFirst,
                    std::int64_t second_ns = kFirst + 100'000'001)
      : stamps_{Stamp{first_ns}, Stamp{second_ns}} {
    for (const std::int64_t ns : truth_ns) {
      truth_.push_back({Stamp{ns}, Eigen::Isometry3d::Identity()});
    }
  }
  [[nodiscard]] std::string_view format() const override { return "test"; }
  [[nodiscard]] std::size_t size() const override { return 2; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return stamps_.at(index); }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t index) const override {
    return index == 0 ? "first.bin" : "second.bin";
  }
  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan raw;
    raw.stamp = stamp(index);
    raw.points = {{1.0, 2.0, 3.0}, {std::numeric_limits<double>::quiet_NaN(), 5.0, 6.0}};
    raw.doppler = {4.0, -7.0};
    raw.times = {0.0, 0.05};
    raw.directions = {{0.0, 0.6, 0.8}, {1.0, 0.0, 0.0}};
    raw.channels.sensor = {0, 0};
    raw.mountings = {kMounting};
    return raw;
  }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return none_; }

  static constexpr std::int64_t kFirst = 3'724'479'779'384'729'507;
  static inline const Eigen::Isometry3d kMounting =
      Eigen::Translation3d(1.0, -2.0, 0.5) * Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 3.0).normalized());

 private:
  std::array<Stamp, 2> stamps_;
  formats::Trajectory truth_;
  std::vector<std::string> none_;
};

std::unique_ptr<Dataset> with(const Correction& correction, std::vector<std::int64_t> truth_ns = {}) {
  return corrected(std::make_unique<TwoScans>(std::move(truth_ns)), correction);
}

TEST(Correction, NothingToCorrectChangesNothing) {
  auto dataset = std::make_unique<TwoScans>();
  const Dataset* before = dataset.get();
  EXPECT_EQ(corrected(std::move(dataset), {}).get(), before);
}

TEST(Correction, DopplerIsTurnedRoundAndScaled) {
  Correction correction;
  correction.doppler_sign = DopplerSign::kTowards;
  correction.doppler_scale = 0.5;
  const RawScan scan = with(correction)->scan(0);
  EXPECT_EQ(scan.doppler, (std::vector<double>{-2.0, 3.5}));
  EXPECT_EQ(scan.points[0], Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(scan.times, (std::vector<double>{0.0, 0.05}));
}

TEST(Correction, TheKindIsWhatWasSaid) {
  Correction correction;
  correction.doppler_kind = DopplerKind::kCompensated;
  const auto dataset = with(correction);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_EQ(dataset->scan(1).doppler_kind, DopplerKind::kCompensated);
}

TEST(Correction, ApplyingTakesOverWhatTheOtherStates) {
  Correction correction{.doppler_kind = DopplerKind::kCompensated, .doppler_scale = 0.5};
  const Correction other{.doppler_sign = DopplerSign::kTowards,
                         .doppler_scale = 2.0,
                         .point_scale = 3.0,
                         .time_scale = 4.0,
                         .columns = std::array{3, 2, 1, 0},
                         .coordinates = Coordinates::kSphericalRadians};
  correction.apply(other);
  EXPECT_EQ(correction.doppler_kind, DopplerKind::kCompensated) << "the other one states none";
  correction.doppler_kind.reset();
  EXPECT_EQ(correction, other);
}

TEST(Correction, PointsAreScaledAndWhatIsNotFiniteStays) {
  Correction correction;
  correction.point_scale = 0.25;
  const RawScan scan = with(correction)->scan(0);
  EXPECT_EQ(scan.points[0], Vector3d(0.25, 0.5, 0.75));
  EXPECT_TRUE(std::isnan(scan.points[1].x()));
  EXPECT_EQ(scan.points[1].y(), 1.25);
  EXPECT_EQ(scan.directions[0], Vector3d(0.0, 0.6, 0.8));
}

TEST(Correction, ColumnsArePutInOrder) {
  Correction correction;
  correction.columns = std::array{1, 0, 2, 3};  // read y, x, z, Doppler
  RawScan scan = with(correction)->scan(0);
  EXPECT_EQ(scan.points[0], Vector3d(2.0, 1.0, 3.0));
  EXPECT_EQ(scan.doppler[0], 4.0);
  EXPECT_EQ(scan.directions[0], Vector3d(0.6, 0.0, 0.8));
  correction.columns = std::array{1, 2, 3, 0};  // read Doppler, x, y, z
  scan = with(correction)->scan(0);
  EXPECT_EQ(scan.points[0], Vector3d(2.0, 3.0, 4.0));
  EXPECT_EQ(scan.doppler[0], 1.0);
  EXPECT_TRUE(scan.directions.empty());
}

// Against rotations of the x axis: up by the elevation, then to the left by the azimuth.
TEST(Correction, SphericalCoordinatesAreMadeCartesian) {
  Correction correction;
  correction.columns = std::array{1, 2, 0, 3};  // read range, azimuth, elevation, Doppler
  correction.point_scale = 2.0;
  for (const auto& [coordinates, unit] : {std::pair{Coordinates::kSphericalRadians, 1.0},
                                          std::pair{Coordinates::kSphericalDegrees, std::acos(-1.0) / 180.0}}) {
    correction.coordinates = coordinates;
    const RawScan scan = with(correction)->scan(0);
    const Vector3d expected = Eigen::AngleAxisd(2.0 * unit, Vector3d::UnitZ()) *
                              (Eigen::AngleAxisd(-3.0 * unit, Vector3d::UnitY()) * Vector3d(2.0, 0.0, 0.0));
    EXPECT_TRUE(scan.points[0].isApprox(expected, 1e-14)) << scan.points[0].transpose();
    EXPECT_EQ(scan.doppler[0], 4.0);
    EXPECT_FALSE(scan.points[1].allFinite());
    EXPECT_TRUE(scan.directions.empty());
    EXPECT_TRUE(scan.mountings.empty());
  }
}

// A point that one of the sensors sees: corrected in the sensor's axes and moved, or moved and corrected, is the same.
TEST(Correction, MountingsStayWithThePoints) {
  const Vector3d seen(4.0, 5.0, 6.0);
  const auto permuted = [](const Vector3d& p, const std::array<int, 4>& columns) {
    return Vector3d(p[columns[0]], p[columns[1]], p[columns[2]]);
  };
  for (const std::array<int, 4> columns : {std::array{0, 1, 2, 3}, {1, 0, 2, 3}, {1, 2, 0, 3}}) {
    Correction correction;
    correction.columns = columns;
    correction.point_scale = 0.001;
    const RawScan scan = with(correction)->scan(0);
    ASSERT_EQ(scan.mountings.size(), 1U);
    const Eigen::Isometry3d& T = scan.mountings[0];
    EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12) << "a rotation";
    EXPECT_TRUE((T * Vector3d(0.001 * permuted(seen, columns)))
                    .isApprox(0.001 * permuted(TwoScans::kMounting * seen, columns), 1e-12));
  }
  Correction correction;
  correction.columns = std::array{1, 2, 3, 0};
  EXPECT_TRUE(with(correction)->scan(0).mountings.empty()) << "as the lines of sight";
}

TEST(Correction, TimeIsScaledFromTheFirstScanToTheNanosecond) {
  Correction correction;
  correction.time_scale = 0.5;
  const auto dataset = with(correction);
  EXPECT_EQ(dataset->stamp(0).ns, TwoScans::kFirst);
  EXPECT_EQ(dataset->stamp(1).ns, TwoScans::kFirst + 50'000'001);  // half away from zero
  EXPECT_EQ(dataset->scan(1).stamp, dataset->stamp(1));
  EXPECT_EQ(dataset->scan(1).times, (std::vector<double>{0.0, 0.025}));
}

TEST(Correction, TimesThatNoStampHoldsNameTheScan) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  const auto message = [](std::int64_t first_ns, std::int64_t second_ns, double scale) -> std::string {
    Correction correction;
    correction.time_scale = scale;
    try {
      const auto dataset =
          corrected(std::make_unique<TwoScans>(std::vector<std::int64_t>{}, first_ns, second_ns), correction);
      return "taken: " + std::to_string(dataset->stamp(1).ns);
    } catch (const DataError& error) {
      return error.what();
    }
  };
  const std::string refused = "second.bin: scan 1 is ";
  EXPECT_EQ(message(0, 3'600'000'000'000, 1e9).find(refused + "3600 s after the first one; 1e+09 times"), 0U);
  EXPECT_EQ(message(0, 1, 9223372036854775808.0).find(refused), 0U) << "one more than the last";
  EXPECT_EQ(message(kMax - 1, kMax, 2.0).find(refused), 0U);
  EXPECT_EQ(message(kMin, kMax, 2.0).find(refused), 0U);
  EXPECT_EQ(message(0, 1, 1e308).find(refused), 0U);
  EXPECT_EQ(message(kMin, kMin + 10, 3.0), "taken: " + std::to_string(kMin + 30));
  EXPECT_EQ(message(kMax - 4, kMax - 2, 2.0), "taken: " + std::to_string(kMax));
}

TEST(Correction, GroundTruthMovesWithTheScansOnlyWhereItHasTheirStamps) {
  Correction correction;
  correction.time_scale = 2.0;
  const std::int64_t first = TwoScans::kFirst;
  const auto same_clock = with(correction, {first, first + 100'000'001});
  EXPECT_EQ(same_clock->ground_truth()[1].stamp.ns, first + 200'000'002);
  const auto own_clock = with(correction, {first, first + 50'000'000, first + 100'000'001});
  EXPECT_EQ(own_clock->ground_truth()[1].stamp.ns, first + 50'000'000);
  EXPECT_EQ(own_clock->ground_truth()[2].stamp.ns, first + 100'000'001);
}

TEST(Correction, WhatCannotBeIsWrongUse) {
  for (const double scale :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Correction doppler;
    doppler.doppler_scale = scale;
    EXPECT_THROW(with(doppler), UsageError);
    Correction points;
    points.point_scale = scale;
    EXPECT_THROW(with(points), UsageError);
    Correction time;
    time.time_scale = scale;
    EXPECT_THROW(with(time), UsageError);
  }
  for (const std::array<int, 4>& columns : {std::array{0, 0, 2, 3}, std::array{1, 2, 3, 4}, std::array{-1, 0, 1, 2}}) {
    Correction correction;
    correction.columns = columns;
    EXPECT_THROW(with(correction), UsageError);
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
