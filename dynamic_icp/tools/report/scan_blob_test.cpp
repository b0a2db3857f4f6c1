// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/scan_blob.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "testing/read_blob.hpp"

namespace dynamic_icp::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

figures::ShownScan random_scan(std::size_t n, double reach_m) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  figures::ShownScan scan;
  for (std::size_t i = 0; i < n; ++i) {
    scan.points.emplace_back(uniform(-reach_m, reach_m), uniform(-reach_m, reach_m), uniform(-3.0, 10.0));
    scan.doppler.push_back(uniform(-40.0, 40.0));
    scan.compensated.push_back(uniform(-40.0, 40.0));
    scan.labels.push_back(static_cast<std::uint8_t>(random() % 256));
    scan.residual.push_back(uniform(0.0, 1.2));
  }
  return scan;
}

TEST(ScanBlob, IsReadBackWithinHalfAUnit) {
  for (const double reach_m : {0.5, 50.0, 300.0, figures::kFarthestShown_m}) {
    const figures::ShownScan scan = random_scan(2000, reach_m);
    const ReadScan read = read_scan_blob(blob(scan_bytes(scan)));
    ASSERT_EQ(read.points.size(), scan.size());
    EXPECT_LT(read.unit, std::max(0.0021, reach_m / 32000.0)) << "as fine as 16 bits allow";
    for (std::size_t i = 0; i < scan.size(); ++i) {
      EXPECT_LE((read.points[i] - scan.points[i]).cwiseAbs().maxCoeff(), 0.5001 * read.unit);
      EXPECT_NEAR(read.doppler[i], scan.doppler[i], 0.00501);
      EXPECT_NEAR(0.01 * read.compensated[i], scan.compensated[i], 0.00501);
      EXPECT_EQ(read.labels[i], scan.labels[i]);
      EXPECT_NEAR(0.005 * read.residual[i], scan.residual[i], 0.00251);
    }
  }
}

TEST(ScanBlob, LimitsWhatIsTooLargeAndMarksWhatIsUnknown) {
  figures::ShownScan scan = random_scan(4, 10.0);
  scan.doppler = {400.0, -400.0, 0.004, -0.006};
  scan.compensated = {kNaN, 400.0, -400.0, 0.0};
  scan.residual = {kNaN, 1.265, 1.27, 99.0};
  const ReadScan read = read_scan_blob(blob(scan_bytes(scan)));
  EXPECT_NEAR(read.doppler[0], 327.67, 1e-9);
  EXPECT_NEAR(read.doppler[1], -327.67, 1e-9);
  EXPECT_NEAR(read.doppler[2], 0.0, 1e-9);
  EXPECT_NEAR(read.doppler[3], -0.01, 1e-9);
  EXPECT_EQ(read.compensated, (std::vector<std::int16_t>{-32768, 32767, -32767, 0}));
  EXPECT_EQ(read.residual, (std::vector<int>{255, 253, 254, 254}));
}

TEST(ScanBlob, TakesScansWithoutPoints) {
  EXPECT_TRUE(read_scan_blob(blob(scan_bytes({}))).points.empty());
  EXPECT_TRUE(read_map_blob(blob(map_bytes({}))).empty());
}

TEST(ScanBlob, MapIsReadBackFarFromTheOrigin) {
  std::vector<Eigen::Vector3d> points;
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(-40'000.0 + static_cast<double>(random() % 100'000), 3e6 + static_cast<double>(random() % 997),
                        0.001 * static_cast<double>(random() % 10'000));
  }
  const std::vector<Eigen::Vector3d> read = read_map_blob(blob(map_bytes(points)));
  ASSERT_EQ(read.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((read[i] - points[i]).cwiseAbs().maxCoeff(), 0.0051) << "half a centimetre";
  }
}

}  // namespace
}  // namespace dynamic_icp::report
