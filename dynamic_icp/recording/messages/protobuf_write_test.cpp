// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Against the bytes of https://protobuf.dev/programming-guides/encoding.
#include "dynamic_icp/recording/messages/protobuf_write.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::messages {
namespace {

TEST(ProtobufWrite, TheExamplesOfTheSpecification) {
  ProtobufWriter number;
  number.add_varint(1, 150);
  EXPECT_EQ(number.bytes(), "\x08\x96\x01");
  ProtobufWriter text;
  text.add_bytes(2, "testing");
  EXPECT_EQ(text.bytes(), "\x12\x07testing");
  ProtobufWriter nested;
  nested.add_message(3, number);
  EXPECT_EQ(nested.bytes(), "\x1a\x03\x08\x96\x01");
}

TEST(ProtobufWrite, NumbersOfEveryKind) {
  ProtobufWriter negative;
  negative.add_int(1, -2);
  EXPECT_EQ(negative.bytes(), "\x08\xfe\xff\xff\xff\xff\xff\xff\xff\xff\x01");
  ProtobufWriter fixed;
  fixed.add_fixed32(4, 0x04030201);
  EXPECT_EQ(fixed.bytes(), "\x25\x01\x02\x03\x04");
  ProtobufWriter real;
  real.add_double(1, 1.0);
  EXPECT_EQ(real.bytes(), std::string("\x09\0\0\0\0\0\0\xf0\x3f", 9));
  ProtobufWriter packed;
  const double values[] = {1.0, 0.0};
  packed.add_doubles(6, values, 2);
  EXPECT_EQ(packed.bytes(), std::string("\x32\x10\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\0\0", 18));
  ProtobufWriter far;
  far.add_varint(16, 1);
  EXPECT_EQ(far.bytes(), "\x80\x01\x01");
}

TEST(ProtobufWrite, DefaultsTakeNoBytesButNegativeZeroAndNaNDo) {
  ProtobufWriter writer;
  writer.add_varint(1, 0);
  writer.add_fixed32(2, 0);
  writer.add_double(3, 0.0);
  writer.add_bytes(4, "");
  writer.add_doubles(5, nullptr, 0);
  EXPECT_EQ(writer.bytes(), "");
  writer.add_double(1, -0.0);
  EXPECT_EQ(writer.bytes(), std::string("\x09\0\0\0\0\0\0\0\x80", 9));
  ProtobufWriter not_a_number;
  not_a_number.add_double(1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(not_a_number.bytes().size(), 9U);
  ProtobufWriter present;
  present.add_present_varint(2, 0);
  present.add_repeated_bytes(1, "");
  EXPECT_EQ(present.bytes(), std::string("\x10\0\x0a\0", 4));
}

}  // namespace
}  // namespace dynamic_icp::messages
