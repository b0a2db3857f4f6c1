// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What Foxglove's own client makes of it is tested in tests/interop.
#include "dynamic_icp/recording/live/live_server.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/live/socket_client.hpp"

namespace dynamic_icp::live {
namespace {

using nlohmann::json;

ServerSettings on_free_port() {
  ServerSettings settings;
  settings.access.port = 0;
  settings.name = "test";
  settings.page = "<!DOCTYPE html><title>live</title>";
  return settings;
}

class LiveServerTest : public ::testing::Test {
 protected:
  /// Channels 0 and 1; the last message of the second is not kept.
  static std::vector<Channel> channels() {
    return {{"/a", "foxglove.PosesInFrame", "schema a"}, {"/b", "foxglove.PointCloud", "schema b", false}};
  }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

  /// Opens the stream and reads what every client is told first.
  void greet(SocketClient& client) const {
    ASSERT_TRUE(client.open(port()).starts_with("HTTP/1.1 101 "));
    EXPECT_EQ(json::parse(client.read_text())["op"], "serverInfo");
    EXPECT_EQ(json::parse(client.read_text())["op"], "advertise");
  }
  void subscribe(SocketClient& client, unsigned id, unsigned channel) const {
    const json request = {{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}};
    client.send_frame(SocketClient::kText, request.dump());
  }
  void wait_until_wanted(std::size_t channel, bool wanted = true) const {
    for (int k = 0; k < 1000 && server_.is_wanted(channel) != wanted; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_EQ(server_.is_wanted(channel), wanted);
  }
  /// The answer to a request that is no upgrade.
  [[nodiscard]] std::string answer(const std::string& request) const {
    SocketClient client(port());
    client.send(request);
    return client.read_all().value_or("no answer");
  }
  [[nodiscard]] std::string own_host() const { return "Host: 127.0.0.1:" + std::to_string(port()) + "\r\n"; }

  LiveServer server_{on_free_port(), channels()};
};

TEST_F(LiveServerTest, GreetsAClient) {
  SocketClient client(port());
  const std::string head = client.open(port());
  EXPECT_TRUE(head.starts_with("HTTP/1.1 101 ")) << head;
  EXPECT_NE(head.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos) << "RFC 6455, 1.3";
  EXPECT_NE(head.find("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"), std::string::npos) << head;
  const json info = json::parse(client.read_text());
  EXPECT_EQ(info["name"], "test");
  EXPECT_EQ(info["capabilities"], json::array({"time"}));
  const json advertised = json::parse(client.read_text())["channels"];
  ASSERT_EQ(advertised.size(), 2U);
  EXPECT_EQ(advertised[1]["id"], 1);
  EXPECT_EQ(advertised[1]["topic"], "/b");
  EXPECT_EQ(advertised[1]["schemaName"], "foxglove.PointCloud");
  EXPECT_EQ(advertised[0]["schema"], "c2NoZW1hIGE=");
}

TEST_F(LiveServerTest, SendsWhatIsSubscribedToUnderTheClientsNumber) {
  SocketClient client(port());
  greet(client);
  EXPECT_FALSE(server_.is_wanted(1));
  subscribe(client, 77, 1);
  wait_until_wanted(1);
  EXPECT_FALSE(server_.is_wanted(0));
  server_.publish(0, Stamp{1}, "nobody wants it");
  server_.publish(1, Stamp{0x0102030405060708}, std::string("by\0tes", 6));
  EXPECT_EQ(client.read_message(), std::string("\x01\x4d\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01"
                                               "by\0tes",
                                               19));
}

TEST_F(LiveServerTest, WhoComesLateIsSentTheLastMessageOfAChannelThatIsKept) {
  server_.publish(0, Stamp{1}, "old");
  server_.publish(0, Stamp{2}, "last");
  server_.publish(1, Stamp{3}, "not kept");
  SocketClient client(port());
  greet(client);
  subscribe(client, 1, 1);
  subscribe(client, 2, 0);
  EXPECT_TRUE(client.read_message().ends_with("last"));
}

TEST_F(LiveServerTest, ASubscriptionEndsWithItsClientOrBefore) {
  SocketClient stays(port());
  greet(stays);
  subscribe(stays, 5, 0);
  wait_until_wanted(0);
  stays.send_frame(SocketClient::kText, R"({"op": "unsubscribe", "subscriptionIds": [5]})");
  wait_until_wanted(0, false);
  {
    SocketClient leaves(port());
    greet(leaves);
    subscribe(leaves, 5, 1);
    wait_until_wanted(1);
  }
  wait_until_wanted(1, false);
}

TEST_F(LiveServerTest, TellsTheTimeAndAnswersPings) {
  SocketClient client(port());
  greet(client);
  client.send_frame(SocketClient::kPing, "are you there");
  const auto pong = client.read_frame();
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->opcode, SocketClient::kPong);
  EXPECT_EQ(pong->bytes, "are you there");
  server_.tell_time(Stamp{0x0102});
  const auto time = client.read_frame();
  ASSERT_TRUE(time);
  EXPECT_EQ(time->bytes, std::string("\x02\x02\x01\0\0\0\0\0\0", 9));
}

TEST_F(LiveServerTest, WhoComesLateIsToldTheTimeBeforeTheLastMessage) {
  server_.publish(0, Stamp{1}, "old");
  server_.tell_time(Stamp{1});
  server_.publish(0, Stamp{0x0304}, "last");
  server_.tell_time(Stamp{0x0304});
  SocketClient client(port());
  greet(client);
  subscribe(client, 1, 0);
  const auto time = client.read_frame();
  ASSERT_TRUE(time);
  EXPECT_EQ(time->bytes, std::string("\x02\x04\x03\0\0\0\0\0\0", 9));
  EXPECT_TRUE(client.read_message().ends_with("last"));
}

TEST_F(LiveServerTest, MessagesInPiecesAreRead) {
  SocketClient client(port());
  greet(client);
  client.send_frame(SocketClient::kText, R"({"op": "subscribe", "subscri)", false);
  client.send_frame(SocketClient::kPing, "between");  // RFC 6455, 5.4
  client.send_frame(SocketClient::kContinuation, R"(ptions": [{"id": 1, "cha)", false);
  client.send_frame(SocketClient::kContinuation, R"(nnelId": 1}]})");
  wait_until_wanted(1);
}

TEST_F(LiveServerTest, WhatIsWrongWithARequestIsSaid) {
  SocketClient client(port());
  greet(client);
  for (const char* request :
       {"no json", R"({"op": "subscribe"})", R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 9}]})",
        R"({"op": "unsubscribe", "subscriptionIds": [1]})", R"({"op": "advertise", "channels": []})"}) {
    client.send_frame(SocketClient::kText, request);
    const json said = json::parse(client.read_text());
    EXPECT_EQ(said["op"], "status") << request;
    EXPECT_EQ(said["level"], 2) << request;
  }
}

TEST_F(LiveServerTest, GivesBrowsersItsPageAndNothingElse) {
  const std::string page = answer("GET / HTTP/1.1\r\n" + own_host() + "\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 ")) << page;
  EXPECT_TRUE(page.ends_with("<!DOCTYPE html><title>live</title>")) << page;
  for (const char* line : {"Content-Type: text/html; charset=utf-8", "Content-Security-Policy: default-src 'none'",
                           "X-Content-Type-Options: nosniff", "Connection: close"}) {
    EXPECT_NE(page.find(line), std::string::npos) << line << "\n" << page;
  }
  EXPECT_TRUE(answer("HEAD / HTTP/1.1\r\n" + own_host() + "\r\n").ends_with("\r\n\r\n"));
  EXPECT_TRUE(answer("GET /etc/passwd HTTP/1.1\r\n" + own_host() + "\r\n").starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(answer("DELETE / HTTP/1.1\r\n" + own_host() + "\r\n").starts_with("HTTP/1.1 405 "));
}

TEST_F(LiveServerTest, OtherHostsAndPagesFromElsewhereAreRefused) {
  const std::string number = std::to_string(port());
  for (const std::string& host :
       {"evil.example:" + number, std::string("localhost"), "127.0.0.1.evil.example:" + number}) {
    EXPECT_TRUE(answer("GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n").starts_with("HTTP/1.1 403 ")) << host;
  }
  EXPECT_TRUE(answer("GET / HTTP/1.0\r\n\r\n").starts_with("HTTP/1.1 403 ") ||
              answer("GET / HTTP/1.0\r\n\r\n").starts_with("HTTP/1.0 403 "));
  for (const std::string& origin :
       {std::string("https://evil.example"), std::string("null"), "http://127.0.0.1:" + number}) {
    SocketClient client(port());
    EXPECT_TRUE(client.open(port(), "Origin: " + origin + "\r\n").starts_with("HTTP/1.1 403 ")) << origin;
  }
  SocketClient own(port());
  EXPECT_TRUE(own.open(port(), "Origin: http://localhost:" + number + "\r\n").starts_with("HTTP/1.1 101 "));
}

TEST_F(LiveServerTest, ClientsOfAnotherProtocolAreRefused) {
  for (const char* subprotocol : {"chat", "foxglove.websocket.v9"}) {
    SocketClient client(port());
    client.send(SocketClient::upgrade(port(), "", subprotocol));
    EXPECT_TRUE(client.read_head().starts_with("HTTP/1.1 400 ")) << subprotocol;
  }
}

TEST_F(LiveServerTest, APortThatIsTakenIsNamed) {
  ServerSettings settings = on_free_port();
  settings.access.port = port();
  try {
    const LiveServer second(settings, {});
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()),
              "no live view: cannot listen at 127.0.0.1:" + std::to_string(port()) + ": Address already in use");
  }
}

TEST_F(LiveServerTest, TheEndIsToldAndComesBehindAllMessages) {
  SocketClient client(port());
  greet(client);
  subscribe(client, 1, 0);
  wait_until_wanted(0);
  server_.publish(0, Stamp{1}, "last words");
  std::thread end([this] { server_.end("the run has ended"); });
  EXPECT_TRUE(client.read_message().ends_with("last words"));
  EXPECT_TRUE(client.is_closed_by_server());
  EXPECT_EQ(client.close_code(), 1000);
  client.vanish();
  end.join();
}

}  // namespace
}  // namespace dynamic_icp::live
