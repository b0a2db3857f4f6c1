// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/child_text.hpp"

#include <csignal>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::speed {
namespace {

std::string message_of(const std::function<std::string()>& work) {
  try {
    text_of_child(work);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ChildText, HandsBackLongTextsWhole) {
  const std::string text(300000, 'x');  // more than a pipe holds
  EXPECT_EQ(text_of_child([&] { return text; }), text);
}

TEST(ChildText, LeavesTheParentAsItWas) {
  int value = 1;
  text_of_child([&] {
    value = 2;
    return std::string();
  });
  EXPECT_EQ(value, 1);
}

TEST(ChildText, ErrorsKeepTheirKindAndMessage) {
  EXPECT_EQ(message_of([]() -> std::string { throw DataError("no such scan"); }), "no such scan");
  EXPECT_THROW(text_of_child([]() -> std::string { throw UsageError("no such preset"); }), UsageError);
  EXPECT_NE(message_of([]() -> std::string {
              ::raise(SIGKILL);
              return {};
            }).find("137"),
            std::string::npos);
}

TEST(ChildText, ProgramsAreHeard) {
  EXPECT_EQ(output_of_program("/bin/echo", "two words"), "two words\n");
  EXPECT_THROW(output_of_program("/bin/false", ""), DataError);
  EXPECT_THROW(output_of_program("/nowhere/at/all", ""), DataError);
}

}  // namespace
}  // namespace dynamic_icp::speed
