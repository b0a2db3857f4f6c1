// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"

#include "testing/ros_bytes.hpp"

// For tests of what the bytes of messages say.
namespace dynamic_icp::messages {

inline bags::Topic topic_of(const std::string& type, bags::Encoding encoding) {
  return {"/topic", type, encoding, "by hand", "", 1};
}

inline bags::Topic topic_of(const std::string& type, ros::Wire wire) {
  return topic_of(type, wire == ros::Wire::kRos1 ? bags::Encoding::kRos1 : bags::Encoding::kCdr);
}

/// What a call that must fail says.
template <class Call>
std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

inline void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace dynamic_icp::messages
