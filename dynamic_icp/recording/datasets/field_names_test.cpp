// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/field_names.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

using Names = std::vector<std::string>;
using Wanted = std::map<std::string, std::string>;

FieldMap map(const Names& names, const Wanted& wanted = {}) { return map_fields(names, wanted, "scan.pcd"); }

std::string message(const Names& names, const Wanted& wanted = {}) {
  try {
    map(names, wanted);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FieldNames, ObviousNamesGoWithoutSaying) {
  const FieldMap fields = map({"z", "y", "x", "intensity", "time_offset_ns", "doppler"});
  EXPECT_EQ(fields.point[0], (FieldColumn{"x", 0, true}));
  EXPECT_EQ(fields.point[2], (FieldColumn{"z", 0, true}));
  EXPECT_EQ(fields.doppler.array, "doppler");
  EXPECT_EQ(fields.time->array, "time_offset_ns");
  EXPECT_FALSE(fields.line_of_sight);
  EXPECT_TRUE(fields.assumptions.empty()) << fields.assumptions[0];
}

TEST(FieldNames, ArraysOfVectors) {
  const FieldMap fields = map({"points", "doppler", "los", "time_offsets"});
  EXPECT_EQ(fields.point[1], (FieldColumn{"points", 1, false}));
  EXPECT_EQ((*fields.line_of_sight)[2], (FieldColumn{"los", 2, false}));
  EXPECT_EQ(fields.time->array, "time_offsets");
  EXPECT_EQ(map({"xyz", "v"}).point[0].array, "xyz");
  EXPECT_EQ((*map({"x", "y", "z", "v", "los_x", "los_y", "los_z"}).line_of_sight)[1].array, "los_y");
}

TEST(FieldNames, TheFirstOfTheListIsTakenAndTold) {
  // In the order of the list, not of the file.
  const FieldMap fields = map({"x", "y", "z", "vr", "Radial_Velocity", "vel"});
  EXPECT_EQ(fields.doppler.array, "Radial_Velocity");
  ASSERT_EQ(fields.assumptions.size(), 1u);
  EXPECT_EQ(fields.assumptions[0], "using column 'Radial_Velocity' as doppler; there is also: vel, vr");
  EXPECT_EQ(map({"X", "Y", "Z", "VELOCITY"}).doppler.array, "VELOCITY");
  EXPECT_EQ(map({"x", "y", "z", "v", "v_r"}).doppler.array, "v_r");
}

TEST(FieldNames, WhatOnlyLooksLikeDopplerIsNotTaken) {
  const std::string text = message({"x", "y", "z", "v_r_compensated", "vx", "velocity0", "intensity", "h"});
  EXPECT_NE(text.find("scan.pcd: no column of Doppler velocities"), std::string::npos) << text;
  EXPECT_NE(text.find("there are: x, y, z, v_r_compensated, vx, velocity0, intensity, h"), std::string::npos) << text;
}

TEST(FieldNames, MissingCoordinatesAreNamed) {
  EXPECT_NE(message({"x", "z", "doppler"}).find("no column for y"), std::string::npos);
  EXPECT_NE(message({}).find("no column for x"), std::string::npos);
}

TEST(FieldNames, TheUserGoesFirst) {
  const FieldMap fields =
      map({"x", "y", "z", "doppler", "h", "stamp"}, {{"doppler", "h"}, {"time", "stamp"}, {"x", "y"}, {"y", "X"}});
  EXPECT_EQ(fields.doppler.array, "h");
  EXPECT_EQ(fields.time->array, "stamp");
  EXPECT_EQ(fields.point[0].array, "y");
  EXPECT_EQ(fields.point[1].array, "x");
  EXPECT_TRUE(fields.assumptions.empty());
  EXPECT_EQ(map({"points"}, {{"doppler", "points[3]"}}).doppler, (FieldColumn{"points", 3, false}));
  EXPECT_EQ((*map({"points", "v", "rays"}, {{"los", "rays"}}).line_of_sight)[1].array, "rays");
}

TEST(FieldNames, WrongWishesAreErrors) {
  EXPECT_THROW(map({"x", "y", "z", "v"}, {{"dopler", "v"}}), UsageError);
  const std::string text = message({"x", "y", "z", "v"}, {{"doppler", "speed"}});
  EXPECT_NE(text.find("no column 'speed' for doppler; there are: x, y, z, v"), std::string::npos) << text;
  EXPECT_NE(message({"points", "v"}, {{"doppler", "points[x]"}}).find("'points[x]'"), std::string::npos);
  EXPECT_NE(message({"points", "v"}, {{"doppler", "pints[0]"}}).find("'pints[0]'"), std::string::npos);
}

TEST(FieldNames, WhatElseIsSaidOfAPoint) {
  using formats::Channel;
  const auto channels = [](const Names& more, const Wanted& wanted = {}) {
    Names names = {"x", "y", "z", "doppler"};
    names.insert(names.end(), more.begin(), more.end());
    return map(names, wanted).channels;
  };
  EXPECT_TRUE(channels({}).empty());
  using Columns = std::vector<ChannelColumn>;
  EXPECT_EQ(channels({"beam_id", "LINE_INDEX", "RCS", "reflectivity", "face", "echo", "lidar"}),
            (Columns{{Channel::kSensor, "lidar"},
                     {Channel::kLine, "LINE_INDEX"},
                     {Channel::kFace, "face"},
                     {Channel::kIntensity, "reflectivity"},
                     {Channel::kReturnNumber, "echo"}}))
      << "in the order of the list";
  EXPECT_EQ(channels({"drop_reason", "is_valid", "in_ambiguity_region", "scan_offset"}),
            (Columns{{Channel::kValid, "is_valid"},
                     {Channel::kInvalid, "in_ambiguity_region"},
                     {Channel::kInvalid, "drop_reason"},
                     {Channel::kInvalid, "scan_offset"}}))
      << "all flags";
  EXPECT_EQ(channels({"intensity", "rcs"}, {{"doppler", "intensity"}}), (Columns{{Channel::kIntensity, "rcs"}}))
      << "not what is something else already";
  EXPECT_FALSE(map({"x", "y", "z", "doppler", "ring"}).uses("ring")) << "it stays a column of the recording";
}

TEST(FieldNames, OfDriversOfFmcwSensors) {
  EXPECT_EQ(map({"x", "y", "z", "range_rate"}).doppler.array, "range_rate");
  EXPECT_EQ(map({"x", "y", "z", "v_doppler_mps", "v_r"}).doppler.array, "v_doppler_mps");
  EXPECT_EQ(map({"x", "y", "z", "v", "timestamp_nsecs", "nanosecs_since_frame"}).time->array, "nanosecs_since_frame");
}

TEST(FieldNames, SphericalCoordinatesInPlaceOfXYZ) {
  const auto columns = [](const FieldMap& fields) {
    return std::array{fields.point[0].array, fields.point[1].array, fields.point[2].array};
  };
  const FieldMap bare = map({"range", "azimuth", "elevation", "v"});
  EXPECT_EQ(columns(bare), (std::array<std::string, 3>{"azimuth", "elevation", "range"}));
  ASSERT_TRUE(bare.spherical);
  EXPECT_FALSE(bare.spherical->unit);
  EXPECT_TRUE(bare.uses("elevation") && bare.uses("range"));
  const FieldMap degrees = map({"v", "Az_Deg", "el", "distance"});
  EXPECT_EQ(columns(degrees), (std::array<std::string, 3>{"Az_Deg", "el", "distance"}));
  EXPECT_EQ(degrees.spherical->unit, AngleUnit::kDegrees) << "of one is of both";
  EXPECT_EQ(map({"azimuth_rad", "polar_rad", "r", "v"}).spherical->from_zenith, true);
  EXPECT_TRUE(map({"phi", "theta", "r", "v"}).spherical->is_theta_phi);
  EXPECT_EQ(map({"phi", "theta", "r", "v"}).point[0].array, "theta") << "the numbers tell which is which";
  EXPECT_FALSE(map({"x", "y", "z", "azimuth", "elevation", "range", "v"}).spherical) << "these go first";
  EXPECT_NE(message({"azimuth", "range", "v"}).find("no column for x"), std::string::npos) << "an elevation is missing";
  EXPECT_NE(message({"azimuth_deg", "elevation_rad", "range", "v"}).find("in different units"), std::string::npos);
}

TEST(FieldNames, TheUserSaysWhichAnglesAreMeant) {
  const Names names = {"a", "b", "c", "x", "y", "z", "theta", "phi", "range", "v"};
  const FieldMap stated = map(names, {{"azimuth_deg", "a"}, {"elevation_deg", "b"}, {"range", "c"}});
  EXPECT_EQ(stated.point[0].array, "a");
  EXPECT_EQ(stated.point[2].array, "c");
  EXPECT_EQ(stated.spherical->unit, AngleUnit::kDegrees);
  const FieldMap polar = map(names, {{"azimuth_rad", "phi"}, {"polar_rad", "theta"}});
  EXPECT_EQ(polar.point[1].array, "theta");
  EXPECT_EQ(polar.point[2].array, "range");
  EXPECT_TRUE(polar.spherical->from_zenith);
  EXPECT_FALSE(polar.spherical->is_theta_phi);
  EXPECT_EQ(polar.spherical->unit, AngleUnit::kRadians);
  EXPECT_NE(message({"a", "range", "v"}, {{"azimuth_deg", "a"}}).find("expected columns of azimuth, elevation"),
            std::string::npos);
  EXPECT_THROW(map(names, {{"azimuth", "a"}}), UsageError) << "without a unit";
}

TEST(FieldNames, KnowsWhatIsUsed) {
  const FieldMap fields = map({"points", "doppler", "los", "t", "line"});
  EXPECT_TRUE(fields.uses("points") && fields.uses("doppler") && fields.uses("los") && fields.uses("t"));
  EXPECT_FALSE(fields.uses("line"));
}

}  // namespace
}  // namespace dynamic_icp::datasets
