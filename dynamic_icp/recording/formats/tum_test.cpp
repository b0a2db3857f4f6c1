// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/tum.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

std::string message_of(std::string_view text) {
  try {
    parse_tum(text, "a.tum");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

/// The message for `text` must name the file, the line and `expected`.
void expect_error(std::string_view text, std::size_t line, const std::string& expected) {
  const std::string message = message_of(text);
  EXPECT_NE(message.find("a.tum: line " + std::to_string(line) + ":"), std::string::npos) << message;
  EXPECT_NE(message.find("expected"), std::string::npos) << message;
  EXPECT_NE(message.find(expected), std::string::npos) << message;
}

TEST(Tum, ReadsPosesByHand) {
  const TumFile file =
      parse_tum("# a comment\n\n1.5 1 2 3 0 0 0 1\n 2.25\t-4e-1 +0.5 6 0 0 0.6 0.8 # turned\r\n", "a.tum");
  ASSERT_EQ(file.trajectory.size(), 2u);
  EXPECT_EQ(file.repeated_lines, 0u);
  EXPECT_EQ(file.trajectory[0].stamp.ns, 1'500'000'000);
  EXPECT_EQ(file.trajectory[0].T_world_sensor.matrix()(2, 3), 3.0);
  EXPECT_TRUE(file.trajectory[0].T_world_sensor.linear().isIdentity(0.0));
  EXPECT_EQ(file.trajectory[1].stamp.ns, 2'250'000'000);
  EXPECT_EQ(file.trajectory[1].T_world_sensor.translation(), Eigen::Vector3d(-0.4, 0.5, 6.0));
  // Quaternion (0, 0, 0.6, 0.8): cos = 0.64 - 0.36, sin = 2 * 0.6 * 0.8, about z.
  Eigen::Matrix3d turned;
  turned << 0.28, -0.96, 0.0, 0.96, 0.28, 0.0, 0.0, 0.0, 1.0;
  EXPECT_TRUE(file.trajectory[1].T_world_sensor.linear().isApprox(turned, 1e-15));
}

TEST(Tum, CommasSeparateAsWell) {
  for (const char* text : {"1,2,3,4,0,0,0,1", "1, 2, 3, 4, 0, 0, 0, 1\n", "1 ,2 3 4,0 0 0 1",
                           "\xEF\xBB\xBF"
                           "1 2 3 4 0 0 0 1"}) {
    const TumFile file = parse_tum(text, "a.tum");
    ASSERT_EQ(file.trajectory.size(), 1u) << text;
    EXPECT_EQ(file.trajectory[0].T_world_sensor.translation(), Eigen::Vector3d(2.0, 3.0, 4.0)) << text;
  }
}

TEST(Tum, StampsAreExactToTheNanosecond) {
  const TumFile file = parse_tum("1724479779.384729506 0 0 0 0 0 0 1\n1724479779.384729507 0 0 0 0 0 0 1\n", "a.tum");
  EXPECT_EQ(file.trajectory[0].stamp.ns, 1724479779384729506);
  EXPECT_EQ(file.trajectory[1].stamp.ns, 1724479779384729507);
}

TEST(Tum, IntegersBeyondSecondsAreSmallerUnits) {
  const auto stamp = [](const std::string& text) {
    return parse_tum(text + " 0 0 0 0 0 0 1", "a.tum").trajectory[0].stamp.ns;
  };
  EXPECT_EQ(stamp("1724479779384729506"), 1724479779384729506);
  EXPECT_EQ(stamp("1724479779384729"), 1724479779384729000);
  EXPECT_EQ(stamp("1724479779384"), 1724479779384000000);
  EXPECT_EQ(stamp("1724479779"), 1724479779000000000);
  expect_error("17244797793847295 0 0 0 0 0 0 1", 1, "seconds");
  expect_error("9779384729506 0 0 0 0 0 0 1", 1, "seconds");  // more nanoseconds than 64 bits hold
  expect_error("9223372036854775807 0 0 0 0 0 0 1", 1, "seconds");
  expect_error("-9000000000 0 0 0 0 0 0 1", 1, "seconds");
}

TEST(Tum, QuaternionsAreNormalisedOrRefused) {
  const TumFile file = parse_tum("1 0 0 0 0 0 0.60054 0.80072\n", "a.tum");
  const Eigen::Matrix3d R = file.trajectory[0].T_world_sensor.linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(R(0, 0), 0.28, 1e-12);
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.0011\n", 2, "length 1.0011, expected 1 within 0.001");
  expect_error("1 0 0 0 0 0 0 0.9989\n", 1, "length 0.9989");
  expect_error("1 0 0 0 0 0 0 0\n", 1, "length 0");
  expect_error("1 0 0 0 0 0 0 1e300\n", 1, "length 1e+300");
}

TEST(Tum, RepeatedLinesAreDroppedAndCounted) {
  const TumFile file =
      parse_tum("1 1 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n1.0 1.0,0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n", "a.tum");
  EXPECT_EQ(file.trajectory.size(), 2u);
  EXPECT_EQ(file.repeated_lines, 3u);
}

TEST(Tum, StampsMustIncrease) {
  expect_error("2 0 0 0 0 0 0 1\n# x\n1 0 0 0 0 0 0 1\n", 3, "1.000000000 comes after 2.000000000");
  expect_error("2 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n", 2, "a second time with another pose");
}

TEST(Tum, ErrorsNameFileLineAndExpectation) {
  expect_error("", 1, "no pose in this file");
  expect_error("# nothing\n\n", 1, "timestamp tx ty tz qx qy qz qw");
  expect_error("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n", 1, "Git LFS pointer");
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", 2, "7 columns, expected 8");
  expect_error("1 0 0 0 0 0 0 1 5\n", 1, "9 columns, expected 8");
  expect_error("1,,0 0 0 0 0 1\n", 1, "tx is ''");
  expect_error("1,0,0,0,0,0,0,1,\n", 1, "9 columns");
  expect_error("1 0 nan 0 0 0 0 1\n", 1, "ty is 'nan', expected a finite number");
  expect_error("1 0 0 -inf 0 0 0 1\n", 1, "tz is '-inf'");
  expect_error("1 0 0 1e400 0 0 0 1\n", 1, "tz is '1e400'");
  expect_error("1 0 0 0 0 0 0 1x\n", 1, "qw is '1x'");
  expect_error("1 0 0 0 0 +-0 0 1\n", 1, "qy is '+-0'");
  expect_error("timestamp tx ty tz qx qy qz qw\n", 1, "the time stamp is 'timestamp'");
  expect_error("nan 0 0 0 0 0 0 1\n", 1, "the time stamp is 'nan'");
  expect_error(std::string_view("\0\1\2\xff", 4), 1, "1 columns");
  expect_error(std::string("1 0 0 0 0 0 0 \x1b") + std::string(1000, 'x'), 1, "'?xxxx");
  EXPECT_LT(message_of(std::string("1 0 0 0 0 0 0 ") + std::string(1000, 'x')).size(), 200u);
}

TEST(Tum, ReadingBackGivesThePoses) {
  const fs::path path = fs::temp_directory_path() / ("tum_test-" + std::to_string(::getpid()));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Trajectory trajectory;
  for (std::int64_t k = 0; k < 200; ++k) {
    const double scale =
        std::pow(10.0, static_cast<double>(k % 14 - 7));  // from 1e-7 m to 1e6 m, angles beyond half a turn
    Vector6d xi;
    for (double& x : xi) {
      x = uniform(random);
    }
    xi.head<3>() *= 4.0;
    xi.tail<3>() *= scale;
    trajectory.push_back({{1724479779384729506 + 83'333'333 * k}, exp_se3(xi)});
  }
  write_tum(path, trajectory);
  const TumFile file = read_tum(path);
  fs::remove(path);
  ASSERT_EQ(file.trajectory.size(), trajectory.size());
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const Eigen::Isometry3d& written = trajectory[k].T_world_sensor;
    const std::string line = format_tum_line(trajectory[k], "a");
    EXPECT_NE(line[line.rfind(' ') + 1], '-') << "of q and -q the one with qw >= 0";
    EXPECT_EQ(file.trajectory[k].stamp, trajectory[k].stamp);
    EXPECT_EQ(file.trajectory[k].T_world_sensor.translation(), written.translation());
    EXPECT_LT((file.trajectory[k].T_world_sensor.linear() - written.linear()).norm(), 1e-14);
  }
}

TEST(Tum, WritesReadableText) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_EQ(format_tum_line({{0}, T}, "a"), "0.000000000 0 0 0 0 0 0 1\n");
  T.translation() << 0.1, -0.0, 1e-5;
  T.linear() = exp_so3({0.0, 0.0, std::numbers::pi});
  EXPECT_EQ(format_tum_line({{-500'000'000}, T}, "a").substr(0, 24), "-0.500000000 0.1 0 1e-05");
}

TEST(Tum, RefusesToWriteWhatCannotBeReadBack) {
  const StampedPose good{{0}, Eigen::Isometry3d::Identity()};
  StampedPose bad = good;
  bad.T_world_sensor.translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(format_tum_line(bad, "a"), DataError);
  bad = good;
  bad.T_world_sensor.linear()(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(format_tum_line(bad, "a"), DataError);
  bad.T_world_sensor.linear() = -Eigen::Matrix3d::Identity();
  EXPECT_THROW(format_tum_line(bad, "a"), DataError);
  EXPECT_THROW(format_tum({}, "a"), DataError);
  EXPECT_THROW(format_tum({good, good}, "a"), DataError);
  const fs::path path = fs::temp_directory_path() / ("tum_test-" + std::to_string(::getpid()));
  EXPECT_THROW(write_tum(path, {good, bad}), DataError);
  EXPECT_FALSE(fs::exists(path)) << "whole or not at all";
}

TEST(Tum, MissingFileIsAnError) { EXPECT_THROW(read_tum("/nonexistent/a.tum"), DataError); }

}  // namespace
}  // namespace dynamic_icp::formats
