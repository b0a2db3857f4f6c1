// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What clients make of it is tested with one of Foxglove's in tests/interop.
#include "dynamic_icp/recording/live/protocol.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace dynamic_icp::live {
namespace {

TEST(Protocol, TheFirstSubprotocolThatIsKnownIsChosen) {
  EXPECT_EQ(chosen_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen_subprotocol("chat, foxglove.sdk.v1 ,foxglove.websocket.v1"), "foxglove.sdk.v1");
  for (const char* other : {"", ",", " , ", "foxglove.websocket.v2", "foxglove.websocket.v1x", "Foxglove.Sdk.V1"}) {
    EXPECT_EQ(chosen_subprotocol(other), "") << other;
  }
}

TEST(Protocol, RequestsAreRead) {
  const Request begun = parse_request(
      R"({"op": "subscribe", "subscriptions": [{"id": 4294967295, "channelId": 0}, {"id": 0, "channelId": 3}]})");
  EXPECT_EQ(begun.operation, "subscribe");
  ASSERT_EQ(begun.subscriptions.size(), 2u);
  EXPECT_EQ(begun.subscriptions[0].id, 4294967295U);
  EXPECT_EQ(begun.subscriptions[1].channel, 3u);
  EXPECT_EQ(parse_request(R"({"op": "unsubscribe", "subscriptionIds": [7, 9]})").ended,
            (std::vector<std::uint32_t>{7, 9}));
  EXPECT_EQ(parse_request(R"({"op": "getParameters", "parameterNames": 5})").operation, "getParameters");
}

TEST(Protocol, WhatIsNoRequestIsRefused) {
  for (const char* text :
       {"", "x", "[]", "null", R"({"op": 5})", R"({"op": "subscribe"})", R"({"op": "subscribe", "subscriptions": {}})",
        R"({"op": "subscribe", "subscriptions": [1]})", R"({"op": "subscribe", "subscriptions": [{"id": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 4294967296, "channelId": 0}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1.5, "channelId": 0}]})",
        R"({"op": "unsubscribe", "subscriptionIds": ["1"]})", "{\"op\": \"\xFF\"}"}) {
    EXPECT_THROW((void)parse_request(text), std::invalid_argument) << text;
  }
  EXPECT_THROW((void)parse_request(std::string(60'000, '[')), std::invalid_argument);
}

TEST(Protocol, HeadsAreLittleEndian) {
  const MessageHead head = message_head(0x04030201, Stamp{0x0807060504030201});
  EXPECT_EQ(std::string(head.data(), head.size()), std::string("\x01\x01\x02\x03\x04\x01\x02\x03\x04\x05\x06\x07\x08"));
  EXPECT_EQ(time_message(Stamp{0x0807060504030201}), "\x02\x01\x02\x03\x04\x05\x06\x07\x08");
}

TEST(Protocol, TextsThatAreNotUtf8AreSentAllTheSame) {
  EXPECT_NE(status(StatusLevel::kInfo, "caf\xE9", "id").find("caf"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::live
