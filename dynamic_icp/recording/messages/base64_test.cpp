// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/base64.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::messages {
namespace {

TEST(Base64, ExamplesOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(bytes_of_base64(""), "");
  EXPECT_EQ(bytes_of_base64("Zg=="), "f");
  EXPECT_EQ(bytes_of_base64("Zm8="), "fo");
  EXPECT_EQ(bytes_of_base64("Zm9v"), "foo");
  EXPECT_EQ(bytes_of_base64("Zm9vYg=="), "foob");
  EXPECT_EQ(bytes_of_base64("Zm9vYmE="), "fooba");
  EXPECT_EQ(bytes_of_base64("Zm9vYmFy"), "foobar");
  EXPECT_EQ(bytes_of_base64("+/+/"), "\xFB\xFF\xBF");
}

TEST(Base64, WithoutPaddingAndDamaged) {
  EXPECT_EQ(bytes_of_base64("Zm8"), "fo");
  EXPECT_EQ(bytes_of_base64("Zg"), "f");
  EXPECT_FALSE(bytes_of_base64("Z"));
  EXPECT_FALSE(bytes_of_base64("Z==="));
  EXPECT_FALSE(bytes_of_base64("===="));
  EXPECT_FALSE(bytes_of_base64("Zm9v\n"));
  EXPECT_FALSE(bytes_of_base64("Zm=v"));
}

}  // namespace
}  // namespace dynamic_icp::messages
