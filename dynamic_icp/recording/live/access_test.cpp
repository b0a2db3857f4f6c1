// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/access.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::live {
namespace {

TEST(Access, OnLoopbackOnlyLoopbackNamesAreOwn) {
  const Access access;
  for (const char* own : {"localhost:8765", "LocalHost:8765", "127.0.0.1:8765", "[::1]:8765"}) {
    EXPECT_TRUE(is_own_host(own, access)) << own;
  }
  for (const char* other : {"", "localhost", "localhost:80", "evil.example:8765", "127.0.0.1.evil.example:8765",
                            "localhost.evil.example:8765", "192.168.0.7:8765", "127.0.0.1:8765:8765", "[::1:8765",
                            "[::1]8765", "127.0.0.1:08765", "user@127.0.0.1:8765"}) {
    EXPECT_FALSE(is_own_host(other, access)) << other;
  }
}

TEST(Access, AnotherAddressIsOwnWhereItWasAskedFor) {
  Access access;
  access.address = "192.168.0.7";
  EXPECT_TRUE(is_own_host("192.168.0.7:8765", access));
  EXPECT_TRUE(is_own_host("localhost:8765", access));
  EXPECT_FALSE(is_own_host("192.168.0.8:8765", access));
  access.address = "0.0.0.0";
  EXPECT_TRUE(is_own_host("192.168.0.8:8765", access));
  EXPECT_TRUE(is_own_host("[fe80::1]:8765", access));
  EXPECT_FALSE(is_own_host("evil.example:8765", access)) << "a name can be pointed anywhere";
  access.address = "FE80::A";
  EXPECT_TRUE(is_own_host("[fe80::a]:8765", access)) << "browsers write small letters";
  access.address = "0.0.0.0";
  access.port = 80;
  EXPECT_TRUE(is_own_host("192.168.0.8", access)) << "browsers leave out the usual port";
}

TEST(Access, PagesFromElsewhereAreNotPermitted) {
  Access access;
  const char* host = "localhost:8765";
  EXPECT_TRUE(is_permitted_origin("", host, access)) << "no browser";
  EXPECT_TRUE(is_permitted_origin("http://localhost:8765", host, access));
  for (const char* other : {"null", "http://localhost:8766", "https://localhost:8765", "http://127.0.0.1:8765",
                            "https://app.foxglove.dev", "http://localhost:8765.evil.example", "file://"}) {
    EXPECT_FALSE(is_permitted_origin(other, host, access)) << other;
  }
  access.origins = {"https://app.foxglove.dev"};
  EXPECT_TRUE(is_permitted_origin("https://app.foxglove.dev", host, access));
  EXPECT_FALSE(is_permitted_origin("https://app.foxglove.dev.evil.example", host, access));
}

TEST(Access, WhatCannotBeMeantIsRefused) {
  EXPECT_NO_THROW(check(Access{}));
  using namespace std::string_literals;
  for (const std::string& address : {""s, "localhost"s, "1.2.3"s, "example.com"s, "127.0.0.1\0.evil"s}) {
    Access access;
    access.address = address;
    EXPECT_THROW(check(access), UsageError) << address;
  }
  for (const char* origin : {"", "*", "app.foxglove.dev", "https://", "https://app.foxglove.dev/", "https://*.dev"}) {
    Access access;
    access.origins = {origin};
    EXPECT_THROW(check(access), UsageError) << origin;
  }
}

}  // namespace
}  // namespace dynamic_icp::live
