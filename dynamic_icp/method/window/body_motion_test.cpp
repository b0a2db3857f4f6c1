// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/body_motion.hpp"

#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr double kBodyNoiseShare = 0.2;
constexpr double kBodyPeriod_s = 0.1;
constexpr double kBodyNoise_m = 0.01;

/// Points on the rear, the side and the roof of a box of 4 m x 2 m x 1.5 m whose centre is the origin.
class Box {
 public:
  explicit Box(unsigned seed) : random_(seed) {}

  std::vector<Eigen::Vector3d> rear(int count) {
    return points(count, [&] { return Eigen::Vector3d(-2.0, uniform(1.0), uniform(0.75)); });
  }
  std::vector<Eigen::Vector3d> side(int count) {
    return points(count, [&] { return Eigen::Vector3d(uniform(2.0), -1.0, uniform(0.75)); });
  }
  std::vector<Eigen::Vector3d> whole() {
    std::vector<Eigen::Vector3d> all = rear(250);
    for (const Eigen::Vector3d& point : side(350)) {
      all.push_back(point);
    }
    for (const Eigen::Vector3d& point :
         points(200, [&] { return Eigen::Vector3d(uniform(2.0), uniform(1.0), 0.75); })) {
      all.push_back(point);
    }
    return all;
  }

 private:
  double uniform(double half) { return std::uniform_real_distribution<double>(-half, half)(random_); }

  template <typename Draw>
  std::vector<Eigen::Vector3d> points(int count, const Draw& draw) {
    std::normal_distribution<double> noise(0.0, kBodyNoise_m);
    std::vector<Eigen::Vector3d> result;
    for (int k = 0; k < count; ++k) {
      result.push_back(draw() + Eigen::Vector3d(noise(random_), noise(random_), noise(random_)));
    }
    return result;
  }

  std::mt19937 random_;
};

/// At a time, as it moves evenly from (20, 3, 0.5) m.
SeenBody at(double time_s, const Eigen::Vector3d& velocity, const Eigen::Vector3d& omega,
            const std::vector<Eigen::Vector3d>& of_box) {
  SeenBody body;
  body.id = 7;
  body.time_s = time_s;
  body.centre = Eigen::Vector3d(20.0, 3.0, 0.5) + time_s * velocity;
  body.velocity = velocity;
  body.omega = omega;
  for (const Eigen::Vector3d& point : of_box) {
    body.points.push_back(body.centre + exp_so3(time_s * omega) * point);
  }
  return body;
}

/// It is believed to move otherwise, by [omega; velocity].
std::vector<SeenBody> with_wrong_belief(std::vector<SeenBody> scans, const Vector6d& difference) {
  for (SeenBody& body : scans) {
    body.omega -= difference.head<3>();
    body.velocity -= difference.tail<3>();
  }
  return scans;
}

BodyMotion seen_in(const std::vector<SeenBody>& scans) {
  BodyPath path;
  for (auto body = scans.rbegin(); body != scans.rend(); ++body) {
    path.push_back(&*body);
  }
  return motion_by_surfaces(path, kBodyNoiseShare, Workers(1));
}

Vector6d difference() {
  Vector6d d;
  d << 0.01, -0.02, 0.05, 0.1, -0.15, 0.05;
  return d;
}

TEST(BodyMotion, IsSeenByThreeFacesWhateverIsBelieved) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Box box(seed);
    std::vector<SeenBody> scans;
    for (int k = 0; k <= 6; ++k) {
      scans.push_back(at(k * kBodyPeriod_s, {1.5, 0.2, 0.0}, {0.0, 0.0, 0.1}, box.whole()));
    }
    const BodyMotion motion = seen_in(with_wrong_belief(scans, difference()));
    const Vector6d found = motion.A.ldlt().solve(motion.b);
    EXPECT_LT((found - difference()).head<3>().norm(), 0.03) << "seed " << seed << ": " << found.transpose();
    EXPECT_LT((found - difference()).tail<3>().norm(), 0.03) << "seed " << seed << ": " << found.transpose();
    EXPECT_GT(motion.points, 400U);
  }
}

TEST(BodyMotion, AlongASideIsNotSeen) {
  Box box(3);
  std::vector<SeenBody> scans;
  for (int k = 0; k <= 6; ++k) {
    scans.push_back(at(k * kBodyPeriod_s, {1.5, 0.0, 0.0}, Eigen::Vector3d::Zero(), box.side(600)));
  }
  Vector6d belief = Vector6d::Zero();
  belief[3] = 0.4;   // along
  belief[4] = -0.2;  // across
  const BodyMotion motion = seen_in(with_wrong_belief(scans, belief));
  Matrix6d prior = Matrix6d::Zero();
  prior.diagonal() << Eigen::Vector3d::Constant(25.0), Eigen::Vector3d::Constant(1.0);
  const Matrix6d covariance = (motion.A + prior).inverse();
  const Vector6d found = covariance * motion.b;
  EXPECT_GT(std::sqrt(covariance(3, 3)), 0.9) << "of a prior of 1 m/s";
  EXPECT_LT(std::sqrt(covariance(4, 4)), 0.05);
  EXPECT_NEAR(found[4], belief[4], 0.03);
}

TEST(BodyMotion, FollowsABeliefThatChanges) {
  Box box(4);
  const Eigen::Vector3d velocity(1.0, 0.0, 0.0);
  std::vector<SeenBody> scans;
  for (int k = 0; k <= 6; ++k) {
    SeenBody body = at(k * kBodyPeriod_s, velocity, Eigen::Vector3d::Zero(), box.whole());
    body.velocity.x() += k < 3 ? 0.3 : 0.0;  // by the trapezoidal rule 0.3 (2 + 1 / 2) / 6 in the mean
    scans.push_back(body);
  }
  const BodyMotion motion = seen_in(scans);
  const Vector6d found = motion.A.ldlt().solve(motion.b);
  EXPECT_NEAR(found[3], -0.125, 0.02) << found.transpose();
}

TEST(BodyMotion, OfPointsThatAreNotOnItsSurfacesIsUnknown) {
  Box box(5);
  std::vector<SeenBody> scans;
  scans.push_back(at(0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), box.rear(300)));
  scans.push_back(at(kBodyPeriod_s, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), box.rear(300)));
  for (Eigen::Vector3d& point : scans.back().points) {
    point.x() -= 5.0;
  }
  const BodyMotion motion = seen_in(scans);
  EXPECT_EQ(motion.points, 0U);
  EXPECT_TRUE(motion.A.allFinite());
  EXPECT_LT(motion.b.norm(), 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::window
