// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/object_details.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::report {
namespace {

using runs::ObjectRow;

/// Straight ahead at 20 m, driving to the left; each axis known as well as its number says.
ObjectRow crossing_car() {
  ObjectRow car{.id = 4, .velocity = {0.0, 10.0, 0.0}, .centroid = {20.0, 0.0, 0.0}, .extent = {2.0, 4.0, 1.5}};
  car.track = ObjectRow::Track{.age_scans = 7,
                               .tangential_observed = true,
                               .velocity_covariance = Eigen::Vector3d(0.01, 0.25, 0.04).asDiagonal(),
                               .centre_covariance = Eigen::Vector3d(0.04, 0.09, 0.01).asDiagonal(),
                               .faces = {"seen", "hidden", "unknown", "seen", "seen", "something new"}};
  return car;
}

TEST(ObjectDetails, SigmasAreThoseAlongTheDirectionsOfTheObject) {
  const ObjectSigmas sigma = object_sigmas(crossing_car());
  EXPECT_DOUBLE_EQ(sigma.speed_mps, 0.5) << "of the velocity, which goes along y";
  EXPECT_NEAR(sigma.heading_deg, 0.1 / 10.0 * 180.0 / 3.14159265358979, 1e-9) << "0.1 m/s across 10 m/s";
  EXPECT_DOUBLE_EQ(sigma.radial_mps, 0.1) << "it is seen along x";
  EXPECT_DOUBLE_EQ(sigma.tangential_mps, 0.5);
  EXPECT_DOUBLE_EQ(sigma.centre_m, 0.3);
}

TEST(ObjectDetails, TurnedWithTheObjectTheyStayTheSame) {
  ObjectRow car = crossing_car();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  car.velocity = R * car.velocity;
  car.centroid = R * car.centroid;
  car.track->velocity_covariance = R * car.track->velocity_covariance * R.transpose();
  car.track->centre_covariance = R * car.track->centre_covariance * R.transpose();
  const ObjectSigmas sigma = object_sigmas(car);
  EXPECT_NEAR(sigma.speed_mps, 0.5, 1e-12);
  EXPECT_NEAR(sigma.radial_mps, 0.1, 1e-12);
  EXPECT_NEAR(sigma.tangential_mps, 0.5, 1e-12);
  EXPECT_NEAR(sigma.centre_m, 0.3, 1e-12);
}

TEST(ObjectDetails, NothingIsKnownOfTheDirectionOfWhatDoesNotMove) {
  ObjectRow car = crossing_car();
  car.velocity = {0.0, 1e-6, 0.0};
  EXPECT_DOUBLE_EQ(object_sigmas(car).heading_deg, 180.0);
  car.velocity.setZero();
  EXPECT_TRUE(std::isnan(object_sigmas(car).heading_deg));
  EXPECT_TRUE(std::isnan(object_sigmas(car).speed_mps));
  car.track->velocity_covariance.setConstant(NAN);
  car.track->centre_covariance.setConstant(NAN);
  EXPECT_TRUE(std::isnan(object_sigmas(car).radial_mps));
  EXPECT_TRUE(std::isnan(object_sigmas(car).centre_m));
}

TEST(ObjectDetails, HaveAnEntryForEachObjectOfAFrame) {
  runs::RunFiles run;
  ObjectRow untracked = crossing_car();
  untracked.track.reset();
  run.objects = {{untracked}, {}};
  EXPECT_TRUE(object_details(run).is_null()) << "no object is tracked";
  run.objects = {{crossing_car(), untracked}, {}};
  EXPECT_EQ(object_details(run), Json::parse(R"([[[7,true,"shussu",0.5,0.573,0.1,0.5,0.3],null],[]])"));
}

}  // namespace
}  // namespace dynamic_icp::report
