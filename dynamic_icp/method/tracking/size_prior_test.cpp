// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/size_prior.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

struct MeanSize {
  const char* name;
  double length, width, height;
};

// As stated for KITTI, nuScenes, ONCE, Lyft and Waymo by those who made detectors for them, m. People are no such
// bodies.
constexpr std::array kPublished = {
    MeanSize{"KITTI car", 3.88, 1.63, 1.53},
    MeanSize{"KITTI van", 5.06, 1.90, 2.21},
    MeanSize{"KITTI truck", 10.1, 2.58, 3.25},
    MeanSize{"KITTI cyclist", 1.76, 0.60, 1.74},
    MeanSize{"nuScenes car", 4.63, 1.97, 1.74},
    MeanSize{"nuScenes truck", 6.93, 2.51, 2.84},
    MeanSize{"nuScenes bus", 11.2, 2.95, 3.47},
    MeanSize{"nuScenes trailer", 12.3, 2.9, 3.87},
    MeanSize{"nuScenes motorcycle", 2.11, 0.77, 1.47},
    MeanSize{"nuScenes bicycle", 1.70, 0.60, 1.28},
    MeanSize{"ONCE car", 4.38, 1.87, 1.59},
    MeanSize{"ONCE bus", 11.11, 2.88, 3.41},
    MeanSize{"ONCE truck", 7.52, 2.50, 2.62},
    MeanSize{"ONCE cyclist", 2.18, 0.79, 1.43},
    MeanSize{"Lyft car", 4.75, 1.92, 1.71},
    MeanSize{"Lyft truck", 10.24, 2.84, 3.44},
    MeanSize{"Lyft bus", 12.70, 2.92, 3.42},
    MeanSize{"Lyft emergency", 6.52, 2.42, 2.34},
    MeanSize{"Lyft other", 8.17, 2.75, 3.20},
    MeanSize{"Lyft motorcycle", 2.35, 0.96, 1.59},
    MeanSize{"Lyft bicycle", 1.76, 0.63, 1.44},
    MeanSize{"Waymo vehicle", 4.7, 2.1, 1.7},
    MeanSize{"Waymo cyclist", 1.78, 0.84, 1.78},
};

// As their makers state them, without mirrors, which the boxes of those data sets hold.
constexpr std::array kMakers = {
    MeanSize{"Volkswagen Polo", 4.05, 1.75, 1.46}, MeanSize{"Volkswagen Golf", 4.28, 1.79, 1.49},
    MeanSize{"Toyota Yaris", 3.94, 1.70, 1.51},    MeanSize{"Toyota Corolla", 4.63, 1.78, 1.44},
    MeanSize{"Toyota RAV4", 4.60, 1.86, 1.69},     MeanSize{"Ford Focus", 4.38, 1.83, 1.45},
    MeanSize{"Renault Clio", 4.05, 1.80, 1.44},    MeanSize{"Tesla Model 3", 4.69, 1.85, 1.44},
    MeanSize{"Tesla Model Y", 4.75, 1.92, 1.62},   MeanSize{"BMW 3", 4.71, 1.83, 1.44},
    MeanSize{"Fiat 500", 3.57, 1.63, 1.49},        MeanSize{"Volkswagen Transporter", 4.90, 1.90, 1.97},
    MeanSize{"Ford Transit", 5.53, 2.06, 2.53},    MeanSize{"Mercedes Sprinter", 5.93, 2.02, 2.64},
};

std::vector<MeanSize> road_users() {
  std::vector<MeanSize> all(kPublished.begin(), kPublished.end());
  all.insert(all.end(), kMakers.begin(), kMakers.end());
  return all;
}

TEST(SizePrior, LengthsOfRoadUsersLieOnItsCurve) {
  const std::vector<MeanSize> all = road_users();
  double sum = 0.0;
  double squares = 0.0;
  for (const MeanSize& size : all) {
    const Belief belief = typical_length(size.width, size.height);
    const double off = std::log(belief.mean / size.length);
    EXPECT_LT(std::abs(belief.mean - size.length), 2.0 * std::sqrt(belief.variance)) << size.name;
    sum += off;
    squares += off * off;
  }
  const auto count = static_cast<double>(all.size());
  EXPECT_LT(std::sqrt(squares / count), 0.1);
  EXPECT_LT(std::abs(sum / count), 0.02);
}

TEST(SizePrior, LengthsGrowWithTheHeightAsTheyClaim) {
  for (const double height : {0.5, 1.2, 1.8, 2.5, 3.5}) {
    const double step = 1e-5;
    const double difference =
        (typical_length(2.0, height + step).mean - typical_length(2.0, height - step).mean) / (2.0 * step);
    EXPECT_NEAR(length_per_height(2.0, height), difference, 1e-6) << height;
  }
}

TEST(SizePrior, WidthsOfRoadUsersLieOnItsCurve) {
  for (const MeanSize& size : kPublished) {
    EXPECT_NEAR(typical_width(size.length).mean / size.width, 1.0, 0.25) << size.name;
  }
}

TEST(SizePrior, WhatIsCutOffReachesAnywhereUpToTheHighest) {
  const Belief height = height_beyond(2.8);
  EXPECT_DOUBLE_EQ(height.mean, 3.4);
  EXPECT_DOUBLE_EQ(height.variance, 1.2 * 1.2 / 12.0) << "of what is even between";
  EXPECT_DOUBLE_EQ(height_beyond(4.5).mean, 4.5);
  EXPECT_DOUBLE_EQ(height_beyond(4.5).variance, 0.0);
}

TEST(SizePrior, LargerBodiesAreLongerAndWider) {
  EXPECT_LT(typical_length(1.5, 1.5).mean, typical_length(1.8, 1.5).mean);
  EXPECT_LT(typical_length(1.8, 1.5).mean, typical_length(1.8, 2.2).mean);
  EXPECT_LT(typical_width(2.0).mean, typical_width(4.0).mean);
  EXPECT_LE(typical_width(30.0).mean, 2.55) << "what roads allow";
  EXPECT_LT(typical_width_by_height(1.4).mean, typical_width_by_height(2.5).mean);
  EXPECT_LE(typical_width_by_height(5.0).mean, 2.55);
}

/// The mean square of the difference from the mode of a Gaussian that is cut off below `least`, by summing it up.
double mean_square_about_mode(const Belief& belief, double least) {
  const double sigma = std::sqrt(belief.variance);
  const double mode = std::max(belief.mean, least);
  const double end = mode + 12.0 * sigma;
  constexpr int kSteps = 400000;
  const double step = (end - least) / kSteps;
  double weights = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = least + (i + 0.5) * step;
    // Relative to the density at the mode: far out nothing of it would be left.
    const double weight = std::exp(
        -0.5 * ((x - belief.mean) * (x - belief.mean) - (mode - belief.mean) * (mode - belief.mean)) / belief.variance);
    weights += weight;
    squares += weight * (x - mode) * (x - mode);
  }
  return squares / weights;
}

TEST(SizePrior, WhatIsAtLeastSoLongIsACutOffGaussian) {
  const Belief belief{4.5, 0.45};
  const double sigma = std::sqrt(belief.variance);
  for (const double sigmas : {-5.0, -2.0, -1.0, -0.2, 0.0, 0.2, 1.0, 2.0, 4.0}) {
    const double least = belief.mean + sigmas * sigma;
    const Belief result = at_least(belief, least);
    EXPECT_EQ(result.mean, std::max(belief.mean, least)) << "the most likely value, " << sigmas << " sigma";
    const double expected = mean_square_about_mode(belief, least);
    EXPECT_NEAR(result.variance, expected, 1e-3 * expected) << sigmas << " sigma";
  }
}

TEST(SizePrior, FarBeyondTheBeliefOnlyTheBoundIsLeft) {
  const Belief belief{4.5, 0.45};
  const double sigma = std::sqrt(belief.variance);
  for (const double sigmas : {5.5, 8.0, 20.0}) {
    const double least = belief.mean + sigmas * sigma;
    const Belief result = at_least(belief, least);
    EXPECT_EQ(result.mean, least);
    const double expected = mean_square_about_mode(belief, least);
    EXPECT_NEAR(result.variance, expected, 0.1 * expected) << sigmas << " sigma";
  }
}

TEST(SizePrior, FarBelowTheBeliefTheBoundSaysNothing) {
  const Belief belief{4.5, 0.45};
  const Belief result = at_least(belief, 0.5);
  EXPECT_EQ(result.mean, belief.mean);
  EXPECT_NEAR(result.variance, belief.variance, 1e-6);
}

TEST(SizePrior, OnlySmallAndSlowBodiesAreLikePeople) {
  EXPECT_TRUE(is_person_sized(0.8, 1.8));
  EXPECT_FALSE(is_person_sized(0.8, 3.0)) << "a strip of a lorry";
  EXPECT_FALSE(is_person_sized(1.8, 1.8)) << "a bicycle";
  EXPECT_FALSE(is_person_sized(4.0, 1.5)) << "a car in a jam";
  EXPECT_TRUE(is_walking_speed(1.5));
  EXPECT_FALSE(is_walking_speed(7.0)) << "a part of something faster";
}

TEST(SizePrior, LorriesAreLongAndHigh) {
  EXPECT_TRUE(is_lorry_sized(7.4, 3.6)) << "a trailer";
  EXPECT_FALSE(is_lorry_sized(5.6, 2.4)) << "a van";
  EXPECT_FALSE(is_lorry_sized(2.4, 3.6)) << "a cab alone";
}

}  // namespace
}  // namespace dynamic_icp::tracking
