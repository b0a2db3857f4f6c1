// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/half_floats.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::formats {
namespace {

/// As IEEE 754 defines binary16: a sign, five bits of exponent, ten of fraction.
float by_definition(unsigned bits) {
  const float sign = (bits & 0x8000U) != 0 ? -1.0F : 1.0F;
  const int exponent = static_cast<int>(bits >> 10U & 0x1FU);
  const auto fraction = static_cast<float>(bits & 0x3FFU);
  if (exponent == 31) {
    return fraction == 0.0F ? sign * INFINITY : NAN;
  }
  return exponent == 0 ? sign * std::ldexp(fraction, -24) : sign * std::ldexp(1024.0F + fraction, exponent - 25);
}

TEST(HalfFloats, EveryNumberIsTheOneThatIeee754Defines) {
  std::string halves;
  for (unsigned bits = 0; bits <= 0xFFFFU; ++bits) {
    append_value(halves, static_cast<std::uint16_t>(bits));
  }
  const std::string floats = widened_halves(halves);
  ASSERT_EQ(floats.size(), 0x10000U * sizeof(float));
  for (unsigned bits = 0; bits <= 0xFFFFU; ++bits) {
    const auto value = value_at<float>(floats, bits * sizeof(float));
    const float expected = by_definition(bits);
    EXPECT_TRUE(std::isnan(expected) ? std::isnan(value)
                                     : value == expected && std::signbit(value) == std::signbit(expected))
        << bits << ": " << value << ", expected " << expected;
  }
}

TEST(HalfFloats, AnOddByteIsLeftOut) {
  EXPECT_EQ(widened_halves(""), "");
  EXPECT_EQ(widened_halves("x"), "");
  EXPECT_EQ(widened_halves(std::string("\x80\xc2\x01", 3)), std::string("\x00\x00\x50\xc0", 4)) << "-3.25";
}

}  // namespace
}  // namespace dynamic_icp::formats
