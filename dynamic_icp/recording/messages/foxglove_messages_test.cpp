// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/messages/cloud_columns.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

#include "testing/message_faults.hpp"

namespace dynamic_icp::messages {
namespace {

using bags::Encoding;

// Foxglove's schemas in protobuf: tags are (field number << 3) + wire type.
std::string delimited(int number, const std::string& content) {
  return std::string(1, static_cast<char>(number << 3 | 2)) + static_cast<char>(content.size()) + content;
}

template <class Number>
std::string fixed(int number, Number value) {
  std::string bytes(1, static_cast<char>(number << 3 | (sizeof(Number) == 8 ? 1 : 5)));
  return bytes.append(reinterpret_cast<const char*>(&value), sizeof(Number));
}

std::string packed_field(const std::string& name, std::uint32_t offset, char type) {
  return delimited(1, name) + (offset == 0 ? "" : fixed(2, offset)) + std::string{'\x18', type};
}

/// 1500 s and 7 ns, frame "lidar", one point (1, -2, 3.5) with doppler 2 of 8 bytes and ring 300.
std::string protobuf_cloud(const std::string& pose) {
  std::string data(22, '\0');
  const float xyz[3] = {1.0F, -2.0F, 3.5F};
  const double doppler = 2.0;
  const std::uint16_t ring = 300;
  std::memcpy(data.data(), xyz, 12);
  std::memcpy(data.data() + 12, &doppler, 8);
  std::memcpy(data.data() + 20, &ring, 2);
  return delimited(1, std::string("\x08\xDC\x0B\x10\x07")) + delimited(2, "lidar") + pose +
         fixed(4, std::uint32_t{22}) + delimited(5, packed_field("x", 0, 7)) + delimited(5, packed_field("y", 4, 7)) +
         delimited(5, packed_field("z", 8, 7)) + delimited(5, packed_field("doppler", 12, 8)) +
         delimited(5, packed_field("ring", 20, 3)) + delimited(6, data);
}

void expect_foxglove_point(const PointCloud& cloud) {
  EXPECT_EQ(cloud.header.stamp.ns, 1'500'000'000'007);
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  const CloudColumns columns(cloud, "bag");
  EXPECT_EQ(columns.values("y"), std::vector<double>{-2.0});
  EXPECT_EQ(columns.values("z"), std::vector<double>{3.5});
  EXPECT_EQ(columns.values("doppler"), std::vector<double>{2.0});
  EXPECT_EQ(columns.values("ring"), std::vector<double>{300.0});
  EXPECT_EQ(columns.column("ring").type, formats::NpyType::kUint16);
}

TEST(Messages, FoxgloveInProtobuf) {
  const bags::Topic topic = topic_of("foxglove.PointCloud", Encoding::kProtobuf);
  const PointCloud plain = decode_cloud(topic, protobuf_cloud(""), "bag");
  expect_foxglove_point(plain);
  EXPECT_FALSE(plain.T_frame_cloud);
  // Position (0, 0, 2), orientation not written: no rotation.
  const PointCloud moved = decode_cloud(topic, protobuf_cloud(delimited(3, delimited(1, fixed(3, 2.0)))), "bag");
  expect_foxglove_point(moved);
  EXPECT_EQ(moved.T_frame_cloud->translation(), Eigen::Vector3d(0, 0, 2));
  EXPECT_TRUE(moved.T_frame_cloud->linear().isIdentity());
  EXPECT_EQ(header_in_front(topic, protobuf_cloud("").substr(0, 14))->frame_id, "lidar");
  EXPECT_FALSE(header_in_front(topic, protobuf_cloud("").substr(0, 13)));
  // Unknown fields of every wire type pass: 15 a varint, 13 four bytes, 14 eight, 12 bytes.
  expect_foxglove_point(decode_cloud(
      topic, std::string("\x78\xFF\x01") + fixed(13, 1.0F) + fixed(14, 1.0) + delimited(12, "any") + protobuf_cloud(""),
      "bag"));
  const std::string whole = protobuf_cloud("");
  std::size_t faults = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {  // an end between two fields may be the end of a message
    const std::string fault = fault_of([&] { decode_cloud(topic, whole.substr(0, size), "bag"); });
    faults += fault == "no error" ? 0U : 1U;
    EXPECT_TRUE(fault == "no error" || fault.starts_with("bag: ")) << fault;
  }
  EXPECT_GE(faults, whole.size() - 10);
  expect_part(fault_of([&] { decode_cloud(topic, "\x0B", "bag"); }), "is of wire type 3");
  expect_part(fault_of([&] { decode_cloud(topic, std::string("\x20\x16"), "bag"); }),
              "field 4 of a protobuf message, before its byte 2: is of wire type 0, expected 5");
  expect_part(fault_of([&] { decode_cloud(topic, std::string(11, '\xFF'), "bag"); }), "more than ten bytes");
}

TEST(Messages, FoxglovePosesInProtobuf) {
  const double half = std::sqrt(0.5);
  const std::string turn = fixed(3, half) + fixed(4, half);  // a quarter about z
  const std::string stamp = delimited(1, std::string("\x08\x05"));
  const StampedTransform pose =
      decode_pose(topic_of("foxglove.PoseInFrame", Encoding::kProtobuf),
                  stamp + delimited(2, "map") + delimited(3, delimited(1, fixed(1, 4.0)) + delimited(2, turn)), "bag");
  EXPECT_EQ(pose.header.stamp.ns, 5'000'000'000);
  EXPECT_TRUE((pose.T_parent_child * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 1, 0)));
  const std::string transform =
      stamp + delimited(2, "base") + delimited(3, "lidar") + delimited(4, fixed(2, 1.0)) + delimited(5, turn);
  const std::vector<StampedTransform> one =
      decode_transforms(topic_of("foxglove.FrameTransform", Encoding::kProtobuf), transform, "bag");
  const std::vector<StampedTransform> two = decode_transforms(topic_of("foxglove.FrameTransforms", Encoding::kProtobuf),
                                                              delimited(1, transform) + delimited(1, transform), "bag");
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[1].header.frame_id + ">" + two[1].child_frame_id, "base>lidar");
  EXPECT_TRUE((two[1].T_parent_child * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 2, 0)));
}

TEST(Messages, FoxgloveInJson) {
  // The data above in base64, by a table written out by hand: 22 bytes, two '=' at the end.
  const std::string text = R"({"timestamp": {"sec": 1500, "nsec": 7}, "frame_id": "lidar",
    "pose": {"position": {"x": 0, "y": 0, "z": 2}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}},
    "point_stride": 22, "fields": [{"name": "x", "offset": 0, "type": 7}, {"name": "y", "offset": 4, "type": 7},
    {"name": "z", "offset": 8, "type": "FLOAT32"}, {"name": "doppler", "offset": 12, "type": 8},
    {"name": "ring", "offset": 20, "type": 3}], "data": "AACAPwAAAMAAAGBAAAAAAAAAAEAsAQ=="})";
  const bags::Topic topic = topic_of("foxglove.PointCloud", Encoding::kJson);
  const PointCloud cloud = decode_cloud(topic, text, "bag");
  expect_foxglove_point(cloud);
  EXPECT_EQ(cloud.T_frame_cloud->translation().z(), 2.0);
  EXPECT_FALSE(header_in_front(topic, text));
  const auto fault = [&](std::string_view part, std::string_view other) {
    std::string changed = text;
    changed.replace(changed.find(part), part.size(), other);
    return fault_of([&] { decode_cloud(topic, changed, "bag"); });
  };
  expect_part(fault("AACA", "AA!A"), "bag: JSON: data is of type string, expected a text of base64");
  expect_part(fault("AACA", ""), "bag: 19 bytes of data are no multiple of point_stride, 22 bytes");
  expect_part(fault("\"point_stride\": 22", "\"stride\": 22"), "point_stride is missing, expected a whole number");
  expect_part(fault("\"type\": 8", "\"type\": 9"), "field 'doppler' is of type 9, expected 1 to 8");
  expect_part(fault("\"z\": 2", "\"z\": \"two\""), "pose.position.z is of type string, expected a number");
  expect_part(fault("\"offset\": 12", "\"offset\": -1"), "offset is of type number, expected a whole number");
  expect_part(fault("{\"timestamp\"", "[\"timestamp\""), "bag: is no JSON");

  const std::vector<StampedTransform> transforms = decode_transforms(
      topic_of("foxglove.FrameTransforms", Encoding::kJson),
      R"({"transforms": [{"timestamp": {"sec": 1, "nsec": 2}, "parent_frame_id": "a", "child_frame_id": "b",
          "translation": {"x": 1, "y": 2, "z": 3}, "rotation": {"x": 0, "y": 0, "z": 0, "w": 1}}]})",
      "bag");
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].T_parent_child.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(decode_pose(topic_of("foxglove.PoseInFrame", Encoding::kJson),
                        R"({"timestamp": {"sec": 1, "nsec": 0}, "frame_id": "map", "pose": {"position":
                            {"x": 1, "y": 2, "z": 3}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}})",
                        "bag")
                .T_parent_child.translation()
                .y(),
            2.0);
}

}  // namespace
}  // namespace dynamic_icp::messages
