// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/base64.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::formats {
namespace {

TEST(Base64, ExamplesOfTheStandard) {  // RFC 4648, section 10
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"},
                                                          {"\xFB\xFF\xBF", "+/+/"}};
  for (const auto& [bytes, text] : examples) {
    EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(bytes_of_base64(text), bytes);
  }
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
}  // namespace dynamic_icp::formats
