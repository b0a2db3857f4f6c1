// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_fit.hpp"

#include <map>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::mapping {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A floor seen with noise: nothing holds a sensor along it.
Scan noisy_floor(unsigned seed, std::size_t points) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-16.0, 16.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  RawScan raw;
  for (std::size_t i = 0; i < points; ++i) {
    raw.points.emplace_back(along(random), along(random), -0.7 + noise(random));
  }
  raw.doppler.assign(points, 0.0);
  return Scan::from_raw(raw);
}

PlaneMap map_of(const Scan& scan, const Workers& workers) {
  PlaneMap map({});
  map.add(scan.points(), Vector3d::Zero(), workers);
  return map;
}

// What the points say of the position along the floor is nothing but the noise of the fitted normals.
TEST(PlaneFit, KnowsHowMuchInformationIsTheNoiseOfNormals) {
  const Workers workers(2);
  const PlaneNoise noise;
  const PlaneWeights weights;
  double seeming = 0.0;
  double by_noise = 0.0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const PlaneMap map = map_of(noisy_floor(seed, 10000), workers);
    const Scan scan = noisy_floor(100 + seed, 10000);
    PlaneFit fit(scan, map, workers);
    fit.associate(Isometry3d::Identity(), {}, 1);
    ASSERT_GT(fit.on_planes(), 9000u);
    const Eigen::Matrix3d position = fit.linearise(noise, weights).H.block<3, 3>(3, 3);
    seeming += position(0, 0) + position(1, 1);
    EXPECT_GT(position(2, 2), 100.0 * position(0, 0)) << "the height is held";
    const Eigen::Matrix3d stated = fit.position_information_of_noise(noise, weights);
    by_noise += stated(0, 0) + stated(1, 1);
  }
  EXPECT_NEAR(seeming / by_noise, 1.0, 0.15);
}

TEST(PlaneFit, PatchMeansAreThoseOfTheDistancesOnEachPatch) {
  const Workers workers(2);
  const PlaneMap map = map_of(noisy_floor(7, 10000), workers);
  const Scan scan = noisy_floor(8, 2500);
  Isometry3d T_map_sensor = Isometry3d::Identity();
  T_map_sensor.translation() = Vector3d(0.3, -0.2, 0.05);
  PlaneFit fit(scan, map, workers);
  fit.associate(T_map_sensor, {}, 1);

  struct OnPatch {
    std::vector<Vector3d> points;
    Plane plane;
  };
  std::map<std::uint32_t, OnPatch> patches;
  for (const Vector3d& point : scan.points()) {
    const Vector3d in_map = T_map_sensor * point;
    if (const Patch* const patch = map.find(in_map)) {
      patches[patch->id].points.push_back(in_map);
      patches[patch->id].plane = patch->plane;
    }
  }
  std::erase_if(patches, [](const auto& entry) { return entry.second.points.size() < 5; });
  const std::vector<PatchMean> means = fit.patch_means();
  ASSERT_EQ(means.size(), patches.size());
  ASSERT_GT(means.size(), 100u);
  std::size_t k = 0;
  for (const auto& [id, patch] : patches) {
    const auto count = static_cast<double>(patch.points.size());
    double distance = 0.0;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& point : patch.points) {
      distance += patch.plane.distance(point) / count;
      middle += point / count;
    }
    EXPECT_NEAR(means[k].squared_mean, distance * distance, 1e-12) << id;
    EXPECT_NEAR(means[k].explained, patch.plane.variance / count + patch.plane.height_variance(middle), 1e-12) << id;
    ++k;
  }
}

TEST(PlaneFit, PatchMeansScatterAsTheyExplain) {
  const Workers workers(2);
  double ratio = 0.0;
  std::size_t count = 0;
  for (unsigned seed = 11; seed <= 13; ++seed) {
    const PlaneMap map = map_of(noisy_floor(seed, 10000), workers);
    const Scan scan = noisy_floor(100 + seed, 10000);
    PlaneFit fit(scan, map, workers);
    fit.associate(Isometry3d::Identity(), {}, 1);
    for (const PatchMean& mean : fit.patch_means()) {
      ratio += mean.squared_mean / mean.explained;
      ++count;
    }
  }
  ASSERT_GT(count, 500u);
  EXPECT_NEAR(ratio / static_cast<double>(count), 1.0, 0.15);
}

}  // namespace
}  // namespace dynamic_icp::mapping
