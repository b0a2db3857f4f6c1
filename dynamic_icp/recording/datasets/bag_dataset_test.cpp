// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_dataset.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_imu.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/bag_truth.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"

#include "testing/fake_bag.hpp"

namespace dynamic_icp::datasets {
namespace {

using bags::FakeBag;
using ros::Wire;

constexpr const char* kCloud = "sensor_msgs/PointCloud2";
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kBegin_ns = 1'700'000'000 * kSecond_ns;
const std::vector<std::string> kXyzv = {"x", "y", "z", "velocity"};

std::int64_t at(double seconds) { return kBegin_ns + static_cast<std::int64_t>(std::llround(seconds * 1e9)); }

std::shared_ptr<FakeBag> new_bag() { return std::make_shared<FakeBag>(); }

/// A cloud recorded 7 ms after its stamp.
void add_cloud(FakeBag& bag, const std::string& topic, double seconds, const std::string& frame,
               const std::vector<std::vector<float>>& points, const std::vector<std::string>& fields = kXyzv) {
  bag.add(topic, kCloud, at(seconds + 0.007), ros::float_cloud(at(seconds), frame, fields, points).bytes(Wire::kRos1));
}

std::unique_ptr<Dataset> open(const std::shared_ptr<FakeBag>& bag, const OpenOptions& options = {}) {
  return open_bag_dataset(bag, "drive.bag", options);
}

template <class Error>
std::string fault_of_bag(const std::shared_ptr<FakeBag>& bag, const OpenOptions& options = {}) {
  try {
    open(bag, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

using Topics = std::vector<std::vector<std::string>>;

/// The topics that are proposed, the likeliest first.
Topics proposals_for(const std::shared_ptr<FakeBag>& bag) {
  try {
    open(bag);
  } catch (const UnclearInput& error) {
    std::vector<UnclearInput::Settings> proposals = {error.proposal()};
    proposals.insert(proposals.end(), error.others().begin(), error.others().end());
    Topics topics;
    for (const UnclearInput::Settings& proposal : proposals) {
      topics.emplace_back();
      for (const auto& [name, topic] : proposal) {
        EXPECT_EQ(name, "topic.");
        topics.back().push_back(topic);
      }
    }
    return topics;
  }
  return {};
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

std::string said(const Dataset& dataset) {
  std::string all;
  for (const std::string& assumption : dataset.assumptions()) {
    all += assumption + "\n";
  }
  return all;
}

TEST(BagDataset, TheOnlyCloudWithDopplerByTheStampsOfItsHeaders) {
  const auto bag = new_bag();
  for (int i = 0; i < 3; ++i) {
    add_cloud(*bag, "/camera/depth", 0.1 * i, "camera", {{1, 2, 3}}, {"x", "y", "z"});
    add_cloud(*bag, "/lidar", 0.1 * i, "lidar", {{10, 2, 3, -4.5F}, {20, 5, 6, 1.5F}});
    bag->add("/image", "sensor_msgs/Image", at(0.1 * i), "not looked at");
  }
  const std::unique_ptr<Dataset> dataset = open(bag);
  EXPECT_EQ(dataset->format(), "rosbag");
  ASSERT_EQ(dataset->size(), 3U);
  EXPECT_EQ(dataset->stamp(1).ns, at(0.1));
  const RawScan scan = dataset->scan(1);
  EXPECT_EQ(scan.stamp.ns, at(0.1));
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.points[1], Eigen::Vector3d(20, 5, 6));
  EXPECT_EQ(scan.doppler, (std::vector<double>{-4.5, 1.5}));
  EXPECT_TRUE(scan.times.empty());
  EXPECT_TRUE(scan.mountings.empty());
  EXPECT_EQ(dataset->scan_file(2), "fake.bag");
  EXPECT_FALSE(dataset->T_vehicle_sensor());
  EXPECT_TRUE(dataset->ground_truth().empty());
  expect_part(said(*dataset), "topic '/lidar' is taken: of 2 clouds of points it alone has a Doppler");
}

TEST(BagDataset, TimesChannelsAndOtherColumnsAsInFiles) {
  const auto bag = new_bag();
  ros::Cloud cloud =
      ros::float_cloud(at(0.0), "lidar", {"x", "y", "z", "v_r", "snr"}, {{1, 2, 3, 4, 0.5F}, {5, 6, 7, 8, 1.5F}});
  cloud.fields.push_back({"ring", 20, 4});
  cloud.fields.push_back({"time_offset_ns", 22, 6});
  cloud.point_step = 28;
  cloud.row_step = 56;
  std::string data;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto ring = static_cast<std::uint16_t>(7 + i);
    const auto time_ns = static_cast<std::uint32_t>(250'000 * i);
    data += cloud.data.substr(20 * i, 20);
    data.append(reinterpret_cast<const char*>(&ring), 2);
    data.append(reinterpret_cast<const char*>(&time_ns), 4);
    data.append(2, '\xFF');
  }
  cloud.data = data;
  bag->add("/points", "sensor_msgs/PointCloud2", at(0.0), cloud.bytes(Wire::kCdrLittle), bags::Encoding::kCdr);
  const std::unique_ptr<Dataset> dataset = open(bag);
  const RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.doppler, (std::vector<double>{4, 8}));
  EXPECT_EQ(scan.times, (std::vector<double>{0.0, 250'000 * 1e-9}));
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{7, 8}));
  const std::vector<PointColumn> columns = dataset->columns(0);
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_EQ(columns[0].name, "snr");
  EXPECT_EQ(columns[0].values, (std::vector<double>{0.5, 1.5}));
  EXPECT_TRUE(columns[1].is_integer);
  // A column of the user goes first.
  EXPECT_EQ(open(bag, {.fields = {{"doppler", "snr"}}})->scan(0).doppler, (std::vector<double>{0.5, 1.5}));
}

TEST(BagDataset, WithoutOneAnswerTheTopicsAreListedWithTheOption) {
  const auto none = new_bag();
  none->add("/imu", "sensor_msgs/Imu", at(0.0), "");
  expect_part(fault_of_bag<DataError>(none), "drive.bag: holds no clouds of points");
  expect_part(fault_of_bag<DataError>(none), "\n  /imu: sensor_msgs/Imu, 1 message");

  const auto without = new_bag();
  add_cloud(*without, "/points", 0.0, "lidar", {{1, 2, 3, 4}}, {"x", "y", "z", "intensity"});
  expect_part(fault_of_bag<DataError>(without), "drive.bag: /points: no column of Doppler velocities");
  expect_part(fault_of_bag<DataError>(without), "there are: x, y, z, intensity");
  EXPECT_EQ(open(without, {.fields = {{"doppler", "intensity"}}})->size(), 1U);
  add_cloud(*without, "/other", 0.1, "lidar", {{1, 2, 3}}, {"x", "y", "z"});
  expect_part(fault_of_bag<UnclearInput>(without), "name topic and field of one:\n  /points: ");
  expect_part(fault_of_bag<DataError>(without), "\n  /other: sensor_msgs/PointCloud2, 1 message; x, y, z (float32)");

  const auto several = new_bag();
  for (int i = 0; i < 2; ++i) {
    add_cloud(*several, "/left", 0.1 * i, "left", {{1, 2, 3, 4}});
    add_cloud(*several, "/right", 0.1 * i, "right", {{1, 2, 3, 4}});
  }
  expect_part(fault_of_bag<UnclearInput>(several), "holds several clouds of points with Doppler");
  expect_part(fault_of_bag<DataError>(several), "/right: sensor_msgs/PointCloud2, 2 messages at 10.0 Hz");
  expect_part(fault_of_bag<DataError>(several), "several make a rig where /tf_static has the transforms");
  EXPECT_EQ(proposals_for(several), (Topics{{"/left"}, {"/right"}}));
  EXPECT_EQ(open(several, {.topics = {"/right"}})->size(), 2U);
  EXPECT_EQ(open(several, {.topics = {"right"}})->size(), 2U);
  expect_part(fault_of_bag<UsageError>(several, {.topics = {"/up"}}),
              "no topic '/up'; topics of clouds: /left, /right");
  expect_part(fault_of_bag<UsageError>(several, {.topics = {"/left", "left"}}), "for the second time");
  expect_part(fault_of_bag<UsageError>(several, {.sensors = {"left"}}),
              "chosen by their topics, not by name; sensor 'left'");
}

TEST(BagDataset, ZerosInHeadersGiveWayToTheTimesOfRecording) {
  const auto bag = new_bag();
  for (int i = 0; i < 3; ++i) {
    bag->add("/radar", kCloud, at(0.1 * i), ros::float_cloud(0, "", kXyzv, {{1, 2, 3, 4}}).bytes(Wire::kRos1));
  }
  const std::unique_ptr<Dataset> dataset = open(bag);
  ASSERT_EQ(dataset->size(), 3U);
  EXPECT_EQ(dataset->stamp(2).ns, at(0.2));
  EXPECT_EQ(dataset->scan(2).stamp.ns, at(0.2));
  expect_part(said(*dataset), "the timestamps in its headers are 0: the times of recording are taken");
}

TEST(BagDataset, WhatIsBehindADamagedMessageIsLeftOut) {
  const auto bag = new_bag();
  for (int i = 0; i < 5; ++i) {
    add_cloud(*bag, "/lidar", 0.1 * i, "lidar", {{1, 2, 3, 4}});
  }
  bag->message(3).resize(9);
  const std::unique_ptr<Dataset> dataset = open(bag);
  EXPECT_EQ(dataset->size(), 3U);
  expect_part(said(*dataset), "fake.bag: /lidar, message 3");
  expect_part(said(*dataset), "this message and the 1 behind it are left out");
  bag->message(1).resize(60);  // whole enough for a stamp: an error of that scan
  EXPECT_THROW((void)open(bag)->scan(1), DataError);
  bag->message(0).resize(3);
  expect_part(fault_of_bag<DataError>(bag),
              "/lidar: sensor_msgs/PointCloud2, 5 messages at 10.0 Hz; fake.bag: /lidar, message 0");
}

TEST(BagDataset, CompensatedByTheNameOfTheTopic) {
  const auto bag = new_bag();
  add_cloud(*bag, "/aeva/point_cloud_compensated", 0.0, "aeva", {{1, 2, 3, 4}});
  const std::unique_ptr<Dataset> dataset = open(bag);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_EQ(dataset->scan(0).doppler_kind, DopplerKind::kCompensated);
  expect_part(said(*dataset), "compensated, by the name of topic");
}

const Eigen::Isometry3d kLeftOnRoof =
    Eigen::Translation3d(1.0, 0.5, 0.2) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
const Eigen::Isometry3d kRightOnRoof =
    Eigen::Translation3d(1.0, -0.5, 0.2) * Eigen::AngleAxisd(-0.7, Eigen::Vector3d(0.1, 0.2, 1).normalized());

/// Two sensors, the second 20 ms later; at the third scan the second has none.
std::shared_ptr<FakeBag> rig_bag() {
  auto bag = new_bag();
  bag->add_transforms("/tf_static", at(-1.0),
                      {{"base_link", "left", kLeftOnRoof}, {"base_link", "right", kRightOnRoof}});
  for (int i = 0; i < 4; ++i) {
    add_cloud(*bag, "/left", 0.1 * i, "left", {{10.0F + static_cast<float>(i), 1, 2, -3}, {0, 0, 0, 0}});
    if (i != 2) {
      add_cloud(*bag, "/right", 0.1 * i + 0.02, "/right", {{5, 1, 2, 1.0F + static_cast<float>(i)}});
    }
  }
  return bag;
}

TEST(BagDataset, SeveralTopicsAreARig) {
  const auto bag = rig_bag();
  const std::unique_ptr<Dataset> dataset = open(bag, {.topics = {"/left", "/right"}});
  ASSERT_EQ(dataset->size(), 4U);
  EXPECT_EQ(dataset->stamp(1).ns, at(0.1));
  EXPECT_TRUE(dataset->T_vehicle_sensor()->isApprox(kLeftOnRoof));
  const RawScan scan = dataset->scan(1);
  ASSERT_EQ(scan.points.size(), 3U);
  EXPECT_EQ(scan.channels.sensor, (std::vector<std::uint8_t>{0, 0, 1}));
  EXPECT_EQ(scan.doppler, (std::vector<double>{-3, 0, 2}));
  ASSERT_EQ(scan.mountings.size(), 2U);
  EXPECT_TRUE(scan.mountings[0].isApprox(Eigen::Isometry3d::Identity()));
  const Eigen::Isometry3d T_left_right = kLeftOnRoof.inverse() * kRightOnRoof;
  EXPECT_TRUE(scan.mountings[1].isApprox(T_left_right));
  EXPECT_TRUE(scan.points[0].isApprox(Eigen::Vector3d(11, 1, 2)));
  EXPECT_TRUE(scan.points[2].isApprox(T_left_right * Eigen::Vector3d(5, 1, 2)));
  // Lines of sight are those of each sensor; none leads to a sensor's own origin.
  EXPECT_TRUE(scan.directions[2].isApprox(T_left_right.linear() * Eigen::Vector3d(5, 1, 2).normalized()));
  EXPECT_TRUE(scan.directions[1].isZero());
  EXPECT_TRUE(scan.times.empty());
  const std::vector<PointColumn> columns = dataset->columns(1);
  ASSERT_EQ(columns.size(), 1U);
  EXPECT_EQ(columns[0].name, "sensor") << "what is converted says which of them measured a point";
  EXPECT_EQ(columns[0].values, (std::vector<double>{0, 0, 1}));
  EXPECT_TRUE(columns[0].is_integer);
  EXPECT_EQ(dataset->scan(2).points.size(), 2U);
  expect_part(said(*dataset), "topic '/right': 1 of 4 scans have no cloud of it within half a period");
  expect_part(said(*dataset), "the mounting is that of frame 'left' on 'base_link'");
}

TEST(BagDataset, ARigIsProposedWhereItsMountingsAreKnown) {
  const auto bag = rig_bag();
  expect_part(fault_of_bag<UnclearInput>(bag), "name the topics of all as a rig, or that of one:\n  /left: ");
  EXPECT_EQ(proposals_for(bag), (Topics{{"/left", "/right"}, {"/left"}, {"/right"}}));
  add_cloud(*bag, "/left/filtered", 0.0, "left", {{1, 2, 3, 4}});
  EXPECT_EQ(proposals_for(bag), (Topics{{"/left"}, {"/right"}, {"/left/filtered"}})) << "two of one sensor are no rig";
}

TEST(BagDataset, TimesOfARigAreAfterTheStampOfItsFirstSensor) {
  const auto bag = new_bag();
  bag->add_transforms("/tf_static", at(-1.0), {{"left", "right", kRightOnRoof}});
  const std::vector<std::string> fields = {"x", "y", "z", "velocity", "time_offset_s"};
  for (int i = 0; i < 2; ++i) {
    add_cloud(*bag, "/left", 0.1 * i, "left", {{1, 2, 3, 4, 0.25F}}, fields);
    add_cloud(*bag, "/right", 0.1 * i - 0.03125, "right", {{1, 2, 3, 4, 0.5F}}, fields);
  }
  const RawScan scan = open(bag, {.topics = {"/left", "/right"}})->scan(1);
  ASSERT_EQ(scan.times.size(), 2U);
  EXPECT_EQ(scan.times[0], 0.25);
  EXPECT_NEAR(scan.times[1], 0.5 - 0.03125, 1e-12);
}

TEST(BagDataset, ARigWithoutMountingsSaysWhatIsMissing) {
  const auto bag = new_bag();
  bag->add_transforms("/tf_static", at(-1.0), {{"base_link", "left", kLeftOnRoof}});
  for (int i = 0; i < 2; ++i) {
    add_cloud(*bag, "/left", 0.1 * i, "left", {{1, 2, 3, 4}});
    add_cloud(*bag, "/right", 0.1 * i, "right", {{1, 2, 3, 4}});
    add_cloud(*bag, "/again", 0.1 * i, "left", {{1, 2, 3, 4}});
  }
  const std::string missing = fault_of_bag<DataError>(bag, {.topics = {"/left", "/right"}});
  expect_part(missing, "where topic '/right' (frame 'right') is seen from '/left' (frame 'left') is not known");
  expect_part(missing, "there are: base_link>left");
  expect_part(fault_of_bag<DataError>(bag, {.topics = {"/left", "/again"}}), "are in one frame, 'left'");
}

/// A drive along x with odometry of base_link, poses of "gt", and transforms.
std::shared_ptr<FakeBag> bag_with_poses() {
  auto bag = rig_bag();
  for (int i = 0; i < 5; ++i) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(0.1 * i, 0, 0));
    bag->add("/odom", "nav_msgs/Odometry", at(0.1 * i),
             ros::Writer(Wire::kRos1).header(at(0.1 * i), "odom").text("base_link").pose(pose).doubles(78).bytes());
    bag->add_transforms("/tf", at(0.1 * i), {{"odom", "base_link", pose}, {"base_link", "wheel", pose}});
  }
  return bag;
}

TEST(BagDataset, NoGroundTruthIsMadeOfAnOdometryUnasked) {
  const std::unique_ptr<Dataset> dataset = open(bag_with_poses(), {.topics = {"/left"}});
  EXPECT_TRUE(dataset->ground_truth().empty());
  expect_part(said(*dataset), "name one of the topics of poses as truth-topic for that: /odom");
}

TEST(BagDataset, PosesOfATopicAreMovedToTheSensor) {
  for (const char* truth : {"/odom", "odom>base_link"}) {
    const std::unique_ptr<Dataset> dataset = open(bag_with_poses(), {.topics = {"/left"}, .truth_topic = truth});
    ASSERT_EQ(dataset->ground_truth().size(), 5U) << truth;
    EXPECT_EQ(dataset->ground_truth()[2].stamp.ns, at(0.2));
    EXPECT_TRUE(dataset->ground_truth()[2].T_world_sensor.isApprox(Eigen::Translation3d(0.2, 0, 0) * kLeftOnRoof));
    EXPECT_EQ(dataset->ground_truth_file(), "fake.bag");
  }
}

TEST(BagDataset, TopicsThatCallThemselvesGroundTruthAreTaken) {
  auto bag = bag_with_poses();
  for (int i = 0; i < 2; ++i) {
    bag->add("/vehicle/gt_pose", "geometry_msgs/PoseStamped", at(0.3 * i),
             ros::Writer(Wire::kRos1)
                 .header(at(0.3 * i), "map")
                 .pose(Eigen::Isometry3d(Eigen::Translation3d(i, 0, 0)))
                 .bytes());
  }
  const std::unique_ptr<Dataset> dataset = open(bag, {.topics = {"/left"}});
  ASSERT_EQ(dataset->ground_truth().size(), 2U);
  EXPECT_EQ(dataset->ground_truth()[1].T_world_sensor.translation().x(), 1.0);
  expect_part(said(*dataset), "ground truth is taken from topic '/vehicle/gt_pose', by its name");
  expect_part(said(*dataset), "its messages name no frame that moves");
  bag->add("/ground_truth", "geometry_msgs/PoseStamped", at(0.3), "");
  expect_part(said(*open(bag, {.topics = {"/left"}})), "several topics are called so");

  EXPECT_TRUE(is_named_ground_truth("/GroundTruth/pose"));
  EXPECT_TRUE(is_named_ground_truth("/base/ground_truth_odom"));
  EXPECT_TRUE(is_named_ground_truth("/gt"));
  EXPECT_FALSE(is_named_ground_truth("/length"));
  EXPECT_FALSE(is_named_ground_truth("/odom"));
}

TEST(BagDataset, GroundTruthThatIsNotThereIsNamed) {
  const auto bag = bag_with_poses();
  const auto fault = [&](const char* truth) {
    return fault_of_bag<UsageError>(bag, {.topics = {"/left"}, .truth_topic = truth});
  };
  expect_part(fault("/pose"), "truth-topic is '/pose', but there is no such topic; topics of poses: /odom");
  expect_part(fault("/left"), "truth-topic is '/left', which is of sensor_msgs/PointCloud2, not of poses");
  expect_part(fault("map>base_link"), "there are: base_link>wheel, odom>base_link");
  const auto late = new_bag();
  add_cloud(*late, "/lidar", 0.0, "lidar", {{1, 2, 3, 4}});
  late->add("/pose", "geometry_msgs/PoseStamped", at(50.0),
            ros::Writer(Wire::kRos1).header(at(50.0), "map").pose(Eigen::Isometry3d::Identity()).bytes());
  expect_part(fault_of_bag<DataError>(late, {.truth_topic = "/pose"}), "are of another time than the scans");
}

TEST(BagDataset, ImuByTopic) {
  const auto bag = new_bag();
  for (int i = 0; i < 3; ++i) {
    ros::Writer imu(Wire::kRos1);
    imu.header(at(0.005 * i - 340'000.0), "imu").doubles(3).put(1.0).doubles(9);
    imu.doubles(2).put(0.5).doubles(9).doubles(2).put(9.81).doubles(9);
    bag->add("/imu", "sensor_msgs/Imu", at(0.005 * i), imu.bytes());
  }
  const ImuRecording imu = read_imu(*bag);
  EXPECT_EQ(imu.topic, "/imu");
  ASSERT_EQ(imu.measurements.size(), 3U);
  EXPECT_EQ(imu.measurements[2].header.stamp.ns, at(0.01));  // the headers are of another clock
  EXPECT_EQ(imu.measurements[2].angular_velocity.z(), 0.5);
  EXPECT_EQ(imu.assumptions.size(), 1U);
  EXPECT_THROW((void)read_imu(*bag, "/other"), UsageError);
}

TEST(BagTopics, TypesCountsRatesAndFields) {
  const auto bag = rig_bag();
  const BagSummary summary = summarize_bag(*bag, "drive.bag");
  ASSERT_EQ(summary.topics.size(), 3U);
  EXPECT_EQ(topic_line(summary.topics[0]), "/tf_static: tf2_msgs/TFMessage, 1 message");
  EXPECT_EQ(topic_line(summary.topics[1]),
            "/left: sensor_msgs/PointCloud2, 4 messages at 10.0 Hz; x, y, z, velocity (float32)");
}

}  // namespace
}  // namespace dynamic_icp::datasets
