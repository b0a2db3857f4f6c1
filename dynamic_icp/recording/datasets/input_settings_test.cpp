// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/input_settings.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

using Texts = std::vector<std::pair<std::string, std::string>>;

TEST(InputSettings, NothingSaidIsNoText) { EXPECT_EQ(texts({}), Texts{}); }

TEST(InputSettings, WhatWasSaidComesBackFromItsTexts) {
  const Texts said = {{"field.doppler", "v_r"},
                      {"field.x", "px"},
                      {"lidar.1", "front"},
                      {"lidar.2", "rear"},
                      {"topic.1", "/lidar/left"},
                      {"topic.2", "/lidar/right"},
                      {"truth-topic", "odom>base_link"},
                      {"period", "0.05"},
                      {"doppler-sign", "towards"},
                      {"doppler-kind", "compensated"},
                      {"doppler-scale", "0.001"},
                      {"point-scale", "0.1"},
                      {"time-scale", "0.8333333333333334"},
                      {"columns", "doppler,x,y,z"}};
  InputSettings settings;
  for (const auto& [name, text] : said) {
    set(settings, name, text);
  }
  EXPECT_EQ(settings.open.fields.at("x"), "px");
  EXPECT_EQ(settings.open.sensors, (std::vector<std::string>{"front", "rear"}));
  EXPECT_EQ(settings.open.period_s, 0.05);
  EXPECT_EQ(settings.correction.doppler_sign, DopplerSign::kTowards);
  EXPECT_EQ(settings.correction.doppler_kind, DopplerKind::kCompensated);
  EXPECT_EQ(settings.correction.time_scale, 0.8333333333333334);
  EXPECT_EQ(settings.correction.columns, (std::array{1, 2, 3, 0})) << "x is the second of the stored columns";
  EXPECT_EQ(texts(settings), said);
}

TEST(InputSettings, TheUsualSignCountsAsSaid) {
  InputSettings settings;
  set(settings, "doppler-sign", "away");
  EXPECT_EQ(settings.correction.doppler_sign, DopplerSign::kAway);
  EXPECT_EQ(texts(settings), (Texts{{"doppler-sign", "away"}}));
}

TEST(InputSettings, WrongTextsAreNamed) {
  const Texts wrong = {{"period", "0"},
                       {"period", "nan"},
                       {"period", "ten"},
                       {"doppler-sign", "up"},
                       {"doppler-kind", "raw"},
                       {"doppler-scale", "0"},
                       {"doppler-scale", "-1"},
                       {"point-scale", "inf"},
                       {"time-scale", "1e30"},
                       {"columns", "x,y,z"},
                       {"columns", "x,y,z,colour"},
                       {"columns", "x,y,z,_,_"},
                       {"columns", "x,y,z,doppler,"},
                       {"dtype", "float"},
                       {"columns", "x,x,z,doppler"},
                       {"columns", "x,y,z,doppler,x"},
                       {"columns", "azimuth_deg,elevation_rad,range,doppler"},
                       {"columns", "azimuth_deg,y,range,doppler"},
                       {"columns", "azimuth_deg,elevation_deg,range,range,doppler"},
                       {"columns", "azimuth,elevation,range,doppler"},
                       {"colour", "red"}};
  for (const auto& [name, text] : wrong) {
    InputSettings settings;
    try {
      set(settings, name, text);
      FAIL() << name << " " << text;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

// Four names in another order change what was read; others say what there is to read.
TEST(InputSettings, ColumnsAreAnOrderOrARecord) {
  InputSettings settings;
  set(settings, "columns", "x,y,doppler,z");
  EXPECT_EQ(settings.correction.columns, (std::array<int, 4>{0, 1, 3, 2}));
  EXPECT_TRUE(settings.open.columns.empty());
  set(settings, "columns", "X,y,z,_,Doppler");
  set(settings, "dtype", "float64");
  set(settings, "field.Points", "cloud");
  EXPECT_FALSE(settings.correction.columns);
  EXPECT_EQ(settings.open.columns, (std::vector<std::string>{"x", "y", "z", "_", "doppler"}));
  EXPECT_EQ(settings.open.fields.at("points"), "cloud");
  EXPECT_EQ(texts(settings), (Texts{{"field.points", "cloud"}, {"columns", "x,y,z,_,doppler"}, {"dtype", "float64"}}));
}

TEST(InputSettings, ColumnsMayBeSpherical) {
  InputSettings settings;
  set(settings, "columns", "range,azimuth_deg,elevation_deg,doppler");
  EXPECT_EQ(settings.correction.coordinates, Coordinates::kSphericalDegrees);
  EXPECT_EQ(settings.correction.columns, (std::array<int, 4>{1, 2, 0, 3}));
  EXPECT_EQ(texts(settings), (Texts{{"columns", "range,azimuth_deg,elevation_deg,doppler"}}));
  set(settings, "columns", "azimuth_rad,elevation_rad,range,_,doppler");
  EXPECT_EQ(settings.correction.coordinates, Coordinates::kSphericalRadians);
  EXPECT_EQ(settings.open.columns, (std::vector<std::string>{"x", "y", "z", "_", "doppler"}));
  EXPECT_EQ(texts(settings), (Texts{{"columns", "azimuth_rad,elevation_rad,range,_,doppler"}}));
  set(settings, "columns", "x,y,z,range,doppler");
  EXPECT_FALSE(settings.correction.coordinates) << "the range beside x, y and z is a column like others";
  const Correction fix{.columns = std::array<int, 4>{2, 0, 1, 3}, .coordinates = Coordinates::kSphericalDegrees};
  EXPECT_EQ(texts_of_fix(fix, {}), (Texts{{"columns", "elevation_deg,range,azimuth_deg,doppler"}}));
  settings = {};
  set(settings, "columns", "x,y,z,_,doppler");
  EXPECT_EQ(texts_of_fix(fix, settings), (Texts{{"columns", "elevation_deg,range,azimuth_deg,_,doppler"}}));
}

// What the diagnosis finds of a record of more numbers is said of all of them.
TEST(InputSettings, ColumnsThatChangePlacesKeepTheirRecord) {
  InputSettings settings;
  set(settings, "columns", "x,y,z,_,vr,intensity");
  apply({.columns = std::array<int, 4>{3, 0, 2, 1}}, settings);  // x is where the Doppler was read, y where x was, ...
  EXPECT_EQ(texts(settings), (Texts{{"columns", "y,doppler,z,_,x,intensity"}}));
}

TEST(InputSettings, AFixIsSaidOfTheRecordThatWasStated) {
  InputSettings settings;
  set(settings, "columns", "x,y,z,_,vr,intensity");
  set(settings, "period", "0.2");
  Correction fix{.columns = std::array<int, 4>{3, 0, 2, 1}};
  EXPECT_EQ(texts_of_fix(fix, settings), (Texts{{"columns", "y,doppler,z,_,x,intensity"}}));
  EXPECT_EQ(texts_of_fix(fix, {}), (Texts{{"columns", "y,doppler,z,x"}}));
  fix = {.doppler_sign = DopplerSign::kTowards};
  EXPECT_EQ(texts_of_fix(fix, settings), (Texts{{"doppler-sign", "towards"}}));
}

}  // namespace
}  // namespace dynamic_icp::datasets
