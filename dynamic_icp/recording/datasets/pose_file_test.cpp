// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/pose_file.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

using PoseFiles = RecordingByHand;

constexpr const char* kKitti =
    "1 0 0 0 0 1 0 0 0 0 1 0\n"
    "0 -1 0 4 1 0 0 5 0 0 1 6\n";

constexpr const char* kEuroc =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],v_RS_R_x [m s^-1]\n"
    "1403636580838555648,4,5,6,0.5,0.5,0.5,0.5,9\n"
    "1403636580843555328,4.5,5,6,1,0,0,0,9\n";

TEST_F(PoseFiles, KittiIsAMatrixALine) {
  const PoseFile file = read_pose_file(write("poses.txt", kKitti));
  EXPECT_FALSE(file.has_stamps);
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_TRUE(file.poses[0].T_world_sensor.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(file.poses[1].T_world_sensor * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(4, 6, 6)) << "a quarter turn left";
}

TEST_F(PoseFiles, KittiTakesItsTimesFromTheFileBesideIt) {
  const auto path = write("poses.txt", kKitti);
  write("times.txt", "0.000000e+00\n1.037514e-01\n");
  const PoseFile file = read_pose_file(path);
  EXPECT_TRUE(file.has_stamps);
  EXPECT_EQ(file.poses[0].stamp, Stamp{0});
  EXPECT_EQ(file.poses[1].stamp, Stamp{103'751'400});
  write("times.txt", "0\n0.1\n0.2\n");
  EXPECT_FALSE(read_pose_file(path).has_stamps) << "of other poses";
  write("times.txt", "0.1\n0.1\n");
  expect_within(fault_of([&] { read_pose_file(path); }), "times.txt: line 2: expected one time in seconds, later");
  write("times.txt", "0\nsoon\n");
  expect_within(fault_of([&] { read_pose_file(path); }), "times.txt: line 2");
}

TEST_F(PoseFiles, PosesWithoutTimesAreThoseOfTheScansOneForOne) {
  const auto path = write("poses.txt", kKitti);
  const formats::Trajectory truth = read_truth(path, {Stamp{7}, Stamp{9}});
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[1].stamp, Stamp{9});
  EXPECT_EQ(truth[1].T_world_sensor.translation(), Eigen::Vector3d(4, 5, 6));
  expect_within(fault_of([&] {
                  read_truth(path, {Stamp{7}, Stamp{8}, Stamp{9}});
                }),
                "2 poses without times for 3 scans");
}

TEST_F(PoseFiles, EurocIsToldByItsHeader) {
  const PoseFile file = read_pose_file(write("data.csv", kEuroc));
  EXPECT_TRUE(file.has_stamps);
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[0].stamp, Stamp{1'403'636'580'838'555'648});
  EXPECT_EQ(file.poses[0].T_world_sensor.translation(), Eigen::Vector3d(4, 5, 6));
  const Eigen::Vector3d turned = file.poses[0].T_world_sensor.linear() * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((turned - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12) << "w, x, y, z: x goes to y";
}

TEST_F(PoseFiles, TheUnitOfTimesIsThatOfTheirName) {
  const std::pair<const char*, const char*> times[] = {
      {"timestamp", "1700000000.25"},  {"time", "1700000000250"},    {"time_ms", "1700000000250"},
      {"time_us", "1700000000250000"}, {"t", "1700000000250000000"}, {"timestamp_ns", "1700000000250000000"}};
  for (const auto& [name, text] : times) {
    const std::string header = std::string("qw,qx,qy,qz,") + name + ",z,y,x\n";
    const PoseFile file = read_pose_file(write("a.csv", header + "1,0,0,0," + text + ",3,2,1\n"));
    ASSERT_EQ(file.poses.size(), 1U);
    EXPECT_EQ(file.poses[0].stamp, Stamp{1'700'000'000'250'000'000}) << name;
    EXPECT_EQ(file.poses[0].T_world_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  }
  const PoseFile soon = read_pose_file(write("a.csv", "time_ms,x,y,z,qx,qy,qz,qw\n250,1,2,3,0,0,0,1\n"));
  EXPECT_EQ(soon.poses[0].stamp, Stamp{250'000'000}) << "small numbers too";
}

TEST_F(PoseFiles, WhatIsNoPoseIsNamed) {
  const auto fault = [&](const std::string& content) {
    const auto path = write("p.txt", content);
    return fault_of([&] { read_pose_file(path); });
  };
  expect_within(fault("1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n"), "p.txt: line 2");
  expect_within(fault("1 0 0 0 0 1 0 0 0 0 -1 0\n"), "p.txt: line 1");  // a mirror
  expect_within(fault("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1\n"), "p.txt: line 2");
  expect_within(fault("time,x,y,z\n0,1,2,3\n"), "has no column for qx among time, x, y, z");
  expect_within(fault("time,x,y,z,qx,qy,qz,qw\nnow,1,2,3,0,0,0,1\n"), "p.txt: line 2: the time is 'now'");
  expect_within(fault("time,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n2,1,2,3\n"), "line 3: 4 columns, expected 8");
  expect_within(fault("time,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,2\n"), "p.txt: line 2");
  expect_within(fault("time,x,y,z,qx,qy,qz,qw\n"), "p.txt");
  EXPECT_EQ(fault("# timestamp tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0 1\n"), "no error");
}

}  // namespace
}  // namespace dynamic_icp::datasets
