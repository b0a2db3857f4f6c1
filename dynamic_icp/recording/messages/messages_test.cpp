// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/messages.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

#include "testing/message_faults.hpp"
#include "testing/ros_bytes.hpp"

namespace dynamic_icp::messages {
namespace {

using bags::Encoding;
using ros::Wire;
using ros::Writer;

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t at = 0; at < hex.size(); at += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(at, 2)), nullptr, 16));
  }
  return bytes;
}

// One point (1, 2, -0.5, -3.25) at 1724479779.384729506 in frame "aeva": fields x, y, z, velocity; written by hand.
constexpr std::string_view kRos1Cloud =
    "070000002379c966a281ee16040000006165766101000000010000000400000001000000780000000007010000000100000079040000000701"
    "0000000100"
    "00007a0800000007010000000800000076656c6f636974790c0000000701000000001000000010000000100000000000803f00000040000000"
    "bf000050c001";
constexpr std::string_view kCdrCloud =
    "000100002379c966a281ee16050000006165766100000000010000000100000004000000020000007800000000000000070000000100000002"
    "0000007900000004000000070000000100000002"
    "0000007a0000000800000007000000010000000900000076656c6f63697479000000000c000000070000000100000000000000100000001000"
    "0000100000000000803f00000040000000bf000050c001";

void expect_the_one_point(const PointCloud& cloud) {
  EXPECT_EQ(cloud.header.stamp.ns, 1'724'479'779'384'729'506);
  EXPECT_EQ(cloud.header.frame_id, "aeva");
  EXPECT_EQ(cloud.width, 1U);
  const CloudColumns columns(cloud, "bag");
  EXPECT_EQ(columns.names(), (std::vector<std::string>{"x", "y", "z", "velocity"}));
  EXPECT_EQ(columns.values("x"), std::vector<double>{1.0});
  EXPECT_EQ(columns.values("y"), std::vector<double>{2.0});
  EXPECT_EQ(columns.values("z"), std::vector<double>{-0.5});
  EXPECT_EQ(columns.values("velocity"), std::vector<double>{-3.25});
}

TEST(Messages, CloudsWrittenByHand) {
  ASSERT_EQ(from_hex(kRos1Cloud).size(), 125U);
  ASSERT_EQ(from_hex(kCdrCloud).size(), 157U);
  expect_the_one_point(decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kRos1), from_hex(kRos1Cloud), "bag"));
  expect_the_one_point(decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kCdr), from_hex(kCdrCloud), "bag"));
  // The same bytes by the writer of these tests, which others rest on.
  const ros::Cloud cloud =
      ros::float_cloud(1'724'479'779'384'729'506, "aeva", {"x", "y", "z", "velocity"}, {{1.0F, 2.0F, -0.5F, -3.25F}});
  EXPECT_EQ(cloud.bytes(Wire::kRos1), from_hex(kRos1Cloud));
  EXPECT_EQ(cloud.bytes(Wire::kCdrLittle), from_hex(kCdrCloud));
  expect_the_one_point(
      decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kCdr), cloud.bytes(Wire::kCdrBig), "bag"));
}

TEST(Messages, AMessageCutAnywhereIsAnErrorThatNamesIt) {
  for (const auto& [hex, encoding] : {std::pair(kRos1Cloud, Encoding::kRos1), std::pair(kCdrCloud, Encoding::kCdr)}) {
    const std::string whole = from_hex(hex);
    const bags::Topic topic = topic_of("sensor_msgs/PointCloud2", encoding);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::string fault = fault_of([&] { decode_cloud(topic, whole.substr(0, size), "a.bag: /t, message 3"); });
      ASSERT_TRUE(fault.starts_with("a.bag: /t, message 3: ")) << size << ": " << fault;
    }
  }
}

TEST(Messages, LengthsAreCheckedBeforeAnythingIsTaken) {
  std::string cloud = from_hex(kRos1Cloud);
  cloud.replace(20, 4, "\xFF\xFF\xFF\x7F");  // height: as such no error before the points are wanted
  const PointCloud tall = decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kRos1), cloud, "bag");
  expect_part(fault_of([&] { CloudColumns(tall, "bag"); }),
              "bag: 16 bytes of data for 2147483647 x 1 points of 16 bytes");
  cloud = from_hex(kRos1Cloud);
  cloud.replace(28, 4, "\xFF\xFF\xFF\xFF");
  expect_part(fault_of([&] { decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kRos1), cloud, "bag"); }),
              "4294967295 fields at byte 32, but 93 bytes are left");
  expect_part(fault_of([&] {
                decode_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kRos1), from_hex(kRos1Cloud) + "more",
                             "bag");
              }),
              "4 bytes are left behind its last field");
}

TEST(Messages, RepresentationsOfCdrThatAreNotPlainAreRefusedByName) {
  std::string cloud = from_hex(kCdrCloud);
  cloud[1] = '\3';
  const bags::Topic topic = topic_of("sensor_msgs/PointCloud2", Encoding::kCdr);
  expect_part(fault_of([&] { decode_cloud(topic, cloud, "bag"); }), "PL_CDR_LE");
  cloud[1] = '\x40';
  expect_part(fault_of([&] { decode_cloud(topic, cloud, "bag"); }), "00 40, expected plain CDR");
  cloud[1] = '\7';  // CDR2_LE: a message without numbers of 8 bytes is the same
  expect_the_one_point(decode_cloud(topic, cloud, "bag"));
}

TEST(Messages, NumbersOfEightBytesAreAlignedToFourInXcdr2) {
  // Header of 4 + 4 + 4 + 2 bytes, so that the first double lies at 16 or 24.
  Writer writer(Wire::kCdrLittle);
  writer.header(5'000'000'000, "w").pose(Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
  std::string aligned_to_8 = writer.bytes();
  const bags::Topic topic = topic_of("geometry_msgs/PoseStamped", Encoding::kCdr);
  ASSERT_EQ(aligned_to_8.size(), 4U + 16U + 7U * 8U);
  EXPECT_EQ(decode_pose(topic, aligned_to_8, "bag").T_parent_child.translation(), Eigen::Vector3d(1, 2, 3));
  writer = Writer(Wire::kCdrLittle);
  writer.header(5'000'000'000, "frame_7").pose(Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
  aligned_to_8 = writer.bytes();  // 12 + 8 bytes, then 4 of padding
  ASSERT_EQ(aligned_to_8.size(), 4U + 24U + 7U * 8U);
  EXPECT_EQ(decode_pose(topic, aligned_to_8, "bag").T_parent_child.translation(), Eigen::Vector3d(1, 2, 3));
  std::string aligned_to_4 = aligned_to_8;
  aligned_to_4.erase(4 + 20, 4);
  aligned_to_4[1] = '\7';
  EXPECT_EQ(decode_pose(topic, aligned_to_4, "bag").T_parent_child.translation(), Eigen::Vector3d(1, 2, 3));
}

class OfEachWire : public ::testing::TestWithParam<Wire> {};
INSTANTIATE_TEST_SUITE_P(Messages, OfEachWire, ::testing::Values(Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig));

const Eigen::Isometry3d kPose =
    Eigen::Translation3d(1.5, -2.0, 0.25) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized());

TEST_P(OfEachWire, Poses) {
  const Wire wire = GetParam();
  Writer stamped(wire);
  stamped.header(1'500'000'001, "/map").pose(kPose);
  const StampedTransform pose = decode_pose(topic_of("geometry_msgs/PoseStamped", wire), stamped.bytes(), "bag");
  EXPECT_EQ(pose.header.stamp.ns, 1'500'000'001);
  EXPECT_EQ(pose.header.frame_id, "map");
  EXPECT_EQ(pose.child_frame_id, "");
  EXPECT_TRUE(pose.T_parent_child.isApprox(kPose, 1e-15));

  Writer covariance(wire);
  covariance.header(2, "map").pose(kPose).doubles(36, 0.1);
  EXPECT_TRUE(decode_pose(topic_of("geometry_msgs/PoseWithCovarianceStamped", wire), covariance.bytes(), "bag")
                  .T_parent_child.isApprox(kPose, 1e-15));

  Writer transform(wire);
  transform.header(3, "odom").text("/base_link").pose(kPose);
  EXPECT_EQ(decode_pose(topic_of("geometry_msgs/TransformStamped", wire), transform.bytes(), "bag").child_frame_id,
            "base_link");

  Writer odometry(wire);
  odometry.header(4, "odom").text("base_link").pose(kPose).doubles(36, 1.0).doubles(6, 2.0).doubles(36, 3.0);
  const StampedTransform odom = decode_pose(topic_of("nav_msgs/Odometry", wire), odometry.bytes(), "bag");
  EXPECT_EQ(odom.header.frame_id + ">" + odom.child_frame_id, "odom>base_link");
  EXPECT_TRUE(odom.T_parent_child.isApprox(kPose, 1e-15));
}

TEST_P(OfEachWire, TransformsAndImu) {
  const Wire wire = GetParam();
  Writer two(wire);
  two.put(std::uint32_t{2}).header(1, "a").text("b").pose(kPose).header(2, "b").text("long_name").pose(kPose.inverse());
  const std::vector<StampedTransform> transforms =
      decode_transforms(topic_of("tf2_msgs/TFMessage", wire), two.bytes(), "bag");
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[1].child_frame_id, "long_name");
  EXPECT_EQ(transforms[1].header.stamp.ns, 2);
  EXPECT_TRUE(transforms[1].T_parent_child.isApprox(kPose.inverse(), 1e-15));

  const auto imu_bytes = [&](double variance, double w) {
    Writer writer(wire);
    writer.header(9, "imu").doubles(3, 0.0).put(w).put(variance).doubles(8);
    writer.put(0.1).put(0.2).put(0.3).doubles(9).put(9.0).put(-1.0).put(0.5).doubles(9);
    return writer.bytes();
  };
  const bags::Topic topic = topic_of("sensor_msgs/Imu", wire);
  const Imu imu = decode_imu(topic, imu_bytes(0.01, 1.0), "bag");
  EXPECT_EQ(imu.angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(imu.linear_acceleration, Eigen::Vector3d(9.0, -1.0, 0.5));
  ASSERT_TRUE(imu.orientation);
  EXPECT_EQ(imu.orientation->w(), 1.0);
  EXPECT_FALSE(decode_imu(topic, imu_bytes(-1.0, 1.0), "bag").orientation);  // the message says so
  EXPECT_FALSE(decode_imu(topic, imu_bytes(0.01, 0.0), "bag").orientation);  // four zeros
}

TEST_P(OfEachWire, WhatIsNoRotationOrNotFiniteIsAnError) {
  const Wire wire = GetParam();
  Writer zeros(wire);
  zeros.header(1, "map").doubles(7, 0.0);
  expect_part(fault_of([&] { decode_pose(topic_of("geometry_msgs/PoseStamped", wire), zeros.bytes(), "bag"); }),
              "bag: pose is position (0, 0, 0), quaternion x, y, z, w (0, 0, 0, 0)");
  Writer nan(wire);
  nan.header(1, "imu").doubles(4, 0.5).doubles(9).doubles(2).put(std::nan("")).doubles(9).doubles(3).doubles(9);
  expect_part(fault_of([&] { decode_imu(topic_of("sensor_msgs/Imu", wire), nan.bytes(), "bag"); }),
              "bag: angular_velocity is (0, 0, nan)");
}

TEST_P(OfEachWire, TheOldCloudOfChannels) {
  const Wire wire = GetParam();
  Writer writer(wire);
  writer.header(1'000'000'000, "radar").put(std::uint32_t{2});
  for (const float coordinate : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) {
    writer.put(coordinate);
  }
  writer.put(std::uint32_t{2});
  writer.text("Doppler").put(std::uint32_t{2}).put(-1.5F).put(2.5F);
  writer.text("Power").put(std::uint32_t{2}).put(10.0F).put(20.0F);
  const CloudColumns columns(decode_cloud(topic_of("sensor_msgs/PointCloud", wire), writer.bytes(), "bag"), "bag");
  EXPECT_EQ(columns.names(), (std::vector<std::string>{"x", "y", "z", "Doppler", "Power"}));
  EXPECT_EQ(columns.values("y"), (std::vector<double>{2, 5}));
  EXPECT_EQ(columns.values("Doppler"), (std::vector<double>{-1.5, 2.5}));
}

TEST_P(OfEachWire, ReturnsOfARadar) {
  const Wire wire = GetParam();
  const double quarter = 0.5 * std::numbers::pi;
  Writer writer(wire);
  writer.header(5'000'000'000, "radar").put(std::uint32_t{3});
  for (const double number :
       {10.0, 0.0, 0.0, -3.5, 20.0, 20.0, quarter, 0.0, 1.5, 21.0, 4.0, 0.0, quarter, 0.25, 22.0}) {
    writer.put(static_cast<float>(number));
  }
  const bags::Topic topic = topic_of("radar_msgs/RadarScan", wire);
  const CloudColumns columns(decode_cloud(topic, writer.bytes(), "bag"), "bag");
  EXPECT_EQ(columns.cloud().header.stamp.ns, 5'000'000'000);
  const double expected[][3] = {{10, 0, 0}, {0, 20, 0}, {0, 0, 4}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(columns.values("x").at(i), expected[i][0], 1e-5);
    EXPECT_NEAR(columns.values("y").at(i), expected[i][1], 1e-5);
    EXPECT_NEAR(columns.values("z").at(i), expected[i][2], 1e-5);
  }
  EXPECT_EQ(columns.values("doppler_velocity"), (std::vector<double>{-3.5, 1.5, 0.25}));
  EXPECT_EQ(columns.values("amplitude"), (std::vector<double>{20, 21, 22}));
  expect_part(fault_of([&] { decode_cloud(topic, writer.bytes().substr(0, writer.bytes().size() - 1), "bag"); }),
              "bag: ");
}

TEST_P(OfEachWire, TheHeaderIsInTheFront) {
  const Wire wire = GetParam();
  const std::string cloud = ros::float_cloud(77, "lidar", {"x", "y", "z", "v"}, {100, {1, 2, 3, 4}}).bytes(wire);
  const bags::Topic topic = topic_of("sensor_msgs/PointCloud2", wire);
  const std::optional<Header> header = header_in_front(topic, std::string_view(cloud).substr(0, 40));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->stamp.ns, 77);
  EXPECT_EQ(header->frame_id, "lidar");
  EXPECT_FALSE(header_in_front(topic, std::string_view(cloud).substr(0, 17)));
}

TEST(Messages, StampsOfRos1AreUnsignedThoseOfRos2Signed) {
  const auto stamp = [](Wire wire) {
    Writer writer(wire);
    writer.header(std::int64_t{0xFFFFFFFF} * 1'000'000'000, "f").pose(kPose);
    return decode_pose(topic_of("geometry_msgs/PoseStamped", wire), writer.bytes(), "bag").header.stamp.ns;
  };
  EXPECT_EQ(stamp(Wire::kRos1), std::int64_t{4'294'967'295} * 1'000'000'000);
  EXPECT_EQ(stamp(Wire::kCdrLittle), -1'000'000'000);
}

TEST(Messages, AreReadInTheEncodingsThatTheirTypesHave) {
  EXPECT_TRUE(is_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kCdr)));
  EXPECT_FALSE(is_cloud(topic_of("sensor_msgs/PointCloud2", Encoding::kProtobuf)));
  EXPECT_FALSE(is_cloud(topic_of("foxglove.PointCloud", Encoding::kCdr)));
  EXPECT_TRUE(is_pose(topic_of("nav_msgs/Odometry", Encoding::kCdr)));
  EXPECT_TRUE(is_transforms(topic_of("tf/tfMessage", Encoding::kRos1)));
  EXPECT_TRUE(is_imu(topic_of("sensor_msgs/Imu", Encoding::kRos1)));
  EXPECT_FALSE(is_imu(topic_of("sensor_msgs/Image", Encoding::kRos1)));
  expect_part(fault_of([] { decode_cloud(topic_of("sensor_msgs/Image", Encoding::kCdr), "", "bag"); }),
              "sensor_msgs/Image of encoding 'by hand' is not read as a cloud of points");
}

}  // namespace
}  // namespace dynamic_icp::messages
