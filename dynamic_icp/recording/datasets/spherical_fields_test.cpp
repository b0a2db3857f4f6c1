// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/spherical_fields.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/recording/datasets/unclear_input.hpp"

namespace dynamic_icp::datasets {
namespace {

using Eigen::Vector3d;
using Names = std::array<std::string, 3>;
using Settings = UnclearInput::Settings;

const double kPi = std::acos(-1.0);

/// What is proposed, the likeliest first; empty: all is clear.
std::vector<Settings> proposals(SphericalFields fields, Names names, const std::vector<Vector3d>& points) {
  try {
    settle(fields, names, points, "scan.csv");
  } catch (const UnclearInput& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("scan.csv: ")) << error.what();
    std::vector<Settings> all = {error.proposal()};
    all.insert(all.end(), error.others().begin(), error.others().end());
    return all;
  }
  return {};
}

// Against rotations of the x axis: up by the elevation, then to the left by the azimuth.
TEST(SphericalFields, MakeThePointsThatRotationsMake) {
  const double azimuth = 0.7;
  const double elevation = -0.2;
  const Vector3d expected = Eigen::AngleAxisd(azimuth, Vector3d::UnitZ()) *
                            (Eigen::AngleAxisd(-elevation, Vector3d::UnitY()) * Vector3d(30.0, 0.0, 0.0));
  const double degree = kPi / 180.0;
  std::vector<Vector3d> radians = {{azimuth, elevation, 30.0}};
  make_cartesian(radians, {.unit = AngleUnit::kRadians});
  EXPECT_TRUE(radians[0].isApprox(expected, 1e-14)) << radians[0].transpose();
  std::vector<Vector3d> degrees = {{azimuth / degree, elevation / degree, 30.0}};
  make_cartesian(degrees, {.unit = AngleUnit::kDegrees});
  EXPECT_TRUE(degrees[0].isApprox(expected, 1e-14)) << degrees[0].transpose();
  std::vector<Vector3d> polar = {{azimuth, kPi / 2.0 - elevation, 30.0}};
  make_cartesian(polar, {.unit = AngleUnit::kRadians, .from_zenith = true});
  EXPECT_TRUE(polar[0].isApprox(expected, 1e-14)) << polar[0].transpose();
}

TEST(SphericalFields, AnglesBeyondATurnInRadiansAreDegrees) {
  Names names = {"az", "el", "r"};
  SphericalFields fields;
  const std::string said = settle(fields, names, {{-60.0, 9.0, 20.0}, {NAN, INFINITY, NAN}}, "scan.csv");
  EXPECT_EQ(fields.unit, AngleUnit::kDegrees);
  EXPECT_NE(said.find("'az', 'el' and 'r'"), std::string::npos) << said;
  EXPECT_NE(said.find("up to 60, are degrees"), std::string::npos) << said;
}

TEST(SphericalFields, OtherAnglesAreAskedFor) {
  const std::vector<Settings> either = {{{"field.azimuth_rad", "az"}, {"field.elevation_rad", "el"}},
                                        {{"field.azimuth_deg", "az"}, {"field.elevation_deg", "el"}}};
  const Names names = {"az", "el", "r"};
  EXPECT_EQ(proposals({}, names, {{-1.0, 0.1, 20.0}, {2.0 * kPi, -0.1, 5.0}}), either);
  EXPECT_EQ(proposals({}, names, {}), either);
  EXPECT_TRUE(proposals({.unit = AngleUnit::kDegrees}, names, {{-1.0, 0.1, 20.0}}).empty()) << "the name says it";
  const std::vector<Settings> from_z = {{{"field.azimuth_rad", "az"}, {"field.polar_rad", "el"}},
                                        {{"field.azimuth_deg", "az"}, {"field.polar_deg", "el"}}};
  EXPECT_EQ(proposals({.from_zenith = true}, names, {{-1.0, 1.5, 20.0}}), from_z);
}

TEST(SphericalFields, OfThetaAndPhiTheNumbersTellTheAzimuth) {
  struct Case {
    std::vector<Vector3d> points;
    bool is_theta;
    bool from_zenith;
  };
  const Case cases[] = {{{{80.0, -60.0, 9.0}, {100.0, 60.0, 9.0}}, false, true},  // ISO 80000-2
                        {{{-60.0, -9.0, 9.0}, {60.0, 9.0, 9.0}}, true, false},    // of many radars
                        {{{-9.0, 0.0, 9.0}, {9.0, 359.0, 9.0}}, false, false},
                        {{{10.0, 75.0, 9.0}, {350.0, 95.0, 9.0}}, true, true}};
  for (const Case& one : cases) {
    SphericalFields fields{.is_theta_phi = true};
    Names names = {"theta", "phi", "range"};
    settle(fields, names, one.points, "scan.csv");
    EXPECT_EQ(names[0], one.is_theta ? "theta" : "phi");
    EXPECT_EQ(fields.from_zenith, one.from_zenith);
    EXPECT_EQ(fields.unit, AngleUnit::kDegrees);
  }
}

TEST(SphericalFields, ThetaAndPhiThatMayBeEitherAreAskedFor) {
  const std::vector<Settings> any = {{{"field.azimuth_deg", "phi"}, {"field.polar_deg", "theta"}},
                                     {{"field.azimuth_deg", "phi"}, {"field.elevation_deg", "theta"}},
                                     {{"field.azimuth_deg", "theta"}, {"field.elevation_deg", "phi"}}};
  const SphericalFields fields{.is_theta_phi = true};
  const Names names = {"theta", "phi", "range"};
  EXPECT_EQ(proposals(fields, names, {{-30.0, -30.0, 9.0}, {30.0, 30.0, 9.0}}), any) << "as wide as high";
  EXPECT_EQ(proposals(fields, names, {{0.0, -60.0, 9.0}, {20.0, 60.0, 9.0}}), any) << "up from the horizon, or down";
}

}  // namespace
}  // namespace dynamic_icp::datasets
