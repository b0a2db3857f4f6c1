// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Bytes by hand; that protobufjs decodes all of it by our descriptions is tested in tests/interop.
#include "dynamic_icp/recording/messages/foxglove_encode.hpp"

#include <bit>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/messages/foxglove_schemas.hpp"

namespace dynamic_icp::messages {
namespace {

using formats::NamedArray;
using formats::npy_array;

std::string double_bytes(double value) {
  std::string bytes;
  formats::append_value(bytes, value);
  return bytes;
}

template <class Number>
NamedArray column_of(const char* name, const std::vector<Number>& values) {
  return {name, npy_array<Number>({values.size()}, std::span<const Number>(values))};
}

TEST(FoxgloveEncode, APoseByHand) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 2.5, 0.0);
  // timestamp {seconds: 300, nanos: 7}, frame_id "w", pose {position {y}, orientation {w}}
  const std::string expected = std::string("\x0a\x05\x08\xac\x02\x10\x07", 7) + "\x12\x01w" + "\x1a\x16" +
                               "\x0a\x09\x11" + double_bytes(2.5) + "\x12\x09\x21" + double_bytes(1.0);
  EXPECT_EQ(encode_pose({Stamp{300'000'000'007}, "w"}, pose), expected);
}

TEST(FoxgloveEncode, TimesBefore1970HaveNanosecondsFromZeroOn) {
  // -1 ns: seconds -1, nanos 999999999
  const std::string bytes = encode_poses({Stamp{-1}, ""}, {});
  EXPECT_EQ(bytes, std::string("\x0a\x11\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01\x10\xff\x93\xeb\xdc\x03", 19));
}

TEST(FoxgloveEncode, ACloudIsPackedPointByPoint) {
  const NamedArray columns[] = {column_of<float>("x", {1.0F, 2.0F}), column_of<std::uint8_t>("ring", {3, 4}),
                                column_of<std::int64_t>("t", {-5, 1LL << 40U}),
                                column_of<std::int32_t>("label", {-1, 7})};
  const PointCloud cloud = cloud_of_columns({Stamp{0}, "sensor"}, columns);
  EXPECT_EQ(cloud.point_step, 4U + 1U + 8U + 4U);
  EXPECT_EQ(cloud.width, 2U);
  std::string expected;
  for (const std::size_t row : {0U, 1U}) {
    formats::append_value(expected, row == 0 ? 1.0F : 2.0F);
    formats::append_value(expected, static_cast<std::uint8_t>(3 + row));
    formats::append_value(expected, row == 0 ? -5.0 : 1099511627776.0);
    formats::append_value(expected, row == 0 ? std::int32_t{-1} : std::int32_t{7});
  }
  EXPECT_EQ(cloud.data, expected);
  const std::string bytes = encode_cloud(cloud);
  // fields {name: "t", offset: 5, type: FLOAT64}
  EXPECT_NE(bytes.find(std::string("\x2a\x0a\x0a\x01t\x15\x05\0\0\0\x18\x08", 12)), std::string::npos);
  EXPECT_NE(bytes.find(std::string("\x25\x11\0\0\0", 5)), std::string::npos);  // point_stride
  EXPECT_TRUE(bytes.ends_with(std::string("\x32\x22") + expected));
}

TEST(FoxgloveEncode, RefusesColumnsThatDoNotBelongTogether) {
  const NamedArray uneven[] = {column_of<float>("x", {1.0F, 2.0F}), column_of<float>("y", {1.0F})};
  EXPECT_THROW(cloud_of_columns({}, uneven), std::invalid_argument);
  PointCloud cloud;
  cloud.fields.push_back({"t", FieldType::kUint64, 0, 1});
  EXPECT_THROW(encode_cloud(cloud), std::invalid_argument);
}

TEST(FoxgloveEncode, WhatIsNotKnownOfVelocitiesIsFaint) {
  SceneObject object;
  object.id = "3";
  object.velocity = Eigen::Vector3d(0.0, 5.0, 0.0);
  const std::string known = encode_scene({}, {&object, 1}, 0.15);
  object.is_velocity_known = false;
  const std::string doubtful = encode_scene({}, {&object, 1}, 0.15);
  EXPECT_NE(known.find(double_bytes(0.95)), std::string::npos);
  EXPECT_EQ(doubtful.find(double_bytes(0.95)), std::string::npos);
  object.velocity.setZero();
  EXPECT_LT(encode_scene({}, {&object, 1}, 0.15).size(), known.size()) << "what stands has no arrow";
}

TEST(FoxgloveSchemas, HoldWhatAMessageIsMadeOf) {
  const std::string scene = protobuf_schema("foxglove.SceneUpdate");
  for (const char* file : {"google/protobuf/timestamp.proto", "google/protobuf/duration.proto", "foxglove/Color.proto",
                           "foxglove/TextPrimitive.proto", "foxglove/SceneUpdate.proto"}) {
    EXPECT_NE(scene.find(file), std::string::npos) << file;
  }
  EXPECT_EQ(protobuf_schema("foxglove.PointCloud").find("SceneEntity"), std::string::npos);
  EXPECT_THROW(protobuf_schema("foxglove.Nothing"), std::out_of_range);
}

}  // namespace
}  // namespace dynamic_icp::messages
