// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Clients that are slow, gone, wrong or mean: each costs itself its connection, and nobody else anything.
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/live/live_server.hpp"
#include "dynamic_icp/recording/live/socket_client.hpp"

namespace dynamic_icp::live {
namespace {

using Opcode = SocketClient::Opcode;

constexpr const char* kSubscribe = R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 0}]})";

class LiveServerAbuse : public ::testing::Test {
 protected:
  static ServerSettings settings(std::chrono::milliseconds patience = std::chrono::seconds(60)) {
    ServerSettings settings;
    settings.access.port = 0;
    settings.request_time = patience;
    settings.silence_time = patience;
    return settings;
  }
  void start(std::chrono::milliseconds patience) {
    server_ = std::make_unique<LiveServer>(settings(patience), std::vector<Channel>{{"/a", "a", ""}});
  }
  void SetUp() override { start(std::chrono::seconds(60)); }
  /// A well-behaved client still gets what is published.
  void expect_service() {
    SocketClient client(server_->port());
    ASSERT_TRUE(client.open(server_->port()).starts_with("HTTP/1.1 101 "));
    server_->publish(0, Stamp{1}, "for all");
    client.send_frame(Opcode::kText, kSubscribe);
    EXPECT_TRUE(client.read_message().ends_with("for all"));
  }
  [[nodiscard]] std::unique_ptr<SocketClient> subscriber(int receive_bytes = 0) const {
    auto client = std::make_unique<SocketClient>(server_->port(), receive_bytes);
    EXPECT_TRUE(client->open(server_->port()).starts_with("HTTP/1.1 101 "));
    client->send_frame(Opcode::kText, kSubscribe);
    return client;
  }
  void wait_until_wanted() const {
    for (int k = 0; k < 1000 && !server_->is_wanted(0); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  std::unique_ptr<LiveServer> server_;
};

TEST_F(LiveServerAbuse, FramesThatAreNotAllowedEndTheConnection) {
  struct Case {
    const char* what;
    std::function<void(SocketClient&)> send;
    int code;
  };
  const Case cases[] = {
      {"without a mask", [](SocketClient& c) { c.send_frame(Opcode::kText, kSubscribe, true, false); }, 1002},
      {"of a kind that is not defined", [](SocketClient& c) { c.send_frame(static_cast<Opcode>(5), "x"); }, 1002},
      {"a continuation of nothing", [](SocketClient& c) { c.send_frame(Opcode::kContinuation, "x"); }, 1002},
      {"a text within a text",
       [](SocketClient& c) {
         c.send_frame(Opcode::kText, "x", false);
         c.send_frame(Opcode::kText, "y");
       },
       1002},
      {"a ping in pieces", [](SocketClient& c) { c.send_frame(Opcode::kPing, "x", false); }, 1002},
      {"a ping that is too long", [](SocketClient& c) { c.send_frame(Opcode::kPing, std::string(126, 'x')); }, 1002},
      {"a text that is no UTF-8", [](SocketClient& c) { c.send_frame(Opcode::kText, "\xFF\xFE"); }, 1007},
      {"too long", [](SocketClient& c) { c.send_frame(Opcode::kText, std::string(70'000, ' ')); }, 1009},
      {"too long in pieces",
       [](SocketClient& c) {
         for (int k = 0; k < 8; ++k) {
           c.send_frame(k == 0 ? Opcode::kText : Opcode::kContinuation, std::string(10'000, ' '), false);
         }
       },
       1009},
      {"that says to be 2^62 bytes",
       [](SocketClient& c) { c.send(std::string_view("\x81\xFF\x40\0\0\0\0\0\0\0mask", 14)); }, 1009},
      {"a good-bye", [](SocketClient& c) { c.send_frame(Opcode::kClose, "\x03\xE8"); }, 1000},
      {"a good-bye that is no code", [](SocketClient& c) { c.send_frame(Opcode::kClose, "\x03"); }, 1002},
  };
  for (const Case& wrong : cases) {
    const auto client = subscriber();
    wrong.send(*client);
    EXPECT_TRUE(client->is_closed_by_server()) << wrong.what;
    EXPECT_EQ(client->close_code(), wrong.code) << wrong.what;
  }
  expect_service();
}

TEST_F(LiveServerAbuse, TooManyRequestsOrFaultsEndTheConnection) {
  const auto eager = subscriber();
  for (std::size_t k = 0; k <= 2 * LiveServer::kMaxRequestsPerSecond; ++k) {
    eager->send_frame(Opcode::kPing, "");
  }
  EXPECT_TRUE(eager->is_closed_by_server());
  const auto wrong = subscriber();
  for (std::size_t k = 0; k <= LiveServer::kMaxFaults; ++k) {
    wrong->send_frame(Opcode::kText, "{}");
  }
  EXPECT_TRUE(wrong->is_closed_by_server());
  expect_service();
}

TEST_F(LiveServerAbuse, RequestsThatAreNoHttpEndTheConnection) {
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\0\x01", 6), "GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n",
        std::string("GET / HTTP/1.1\r\nContent-Length: 99999999999999\r\n\r\nbody"), std::string("\r\n\r\n\r\n")}) {
    SocketClient client(server_->port());
    client.send(bytes);
    const std::optional<std::string> answer = client.read_all();
    ASSERT_TRUE(answer) << bytes.substr(0, 40);
    EXPECT_EQ(answer->find("HTTP/1.1 200"), std::string::npos) << bytes.substr(0, 40);
  }
  expect_service();
}

TEST_F(LiveServerAbuse, WhoSaysNothingOrTooSlowlyIsDisconnected) {
  start(std::chrono::milliseconds(300));
  SocketClient silent(server_->port());
  SocketClient halting(server_->port());
  halting.send("GET / HT");
  EXPECT_TRUE(silent.read_all());
  EXPECT_TRUE(halting.read_all());
  const auto deaf = subscriber();  // answers no ping
  EXPECT_TRUE(deaf->is_closed_by_server());
}

TEST_F(LiveServerAbuse, AClientThatNeverReadsMissesMessagesAndNobodyElseDoes) {
  const auto deaf = subscriber(4096);
  const auto awake = subscriber();
  wait_until_wanted();
  const std::string bytes(400'000, 'x');
  for (std::int64_t k = 1; k <= 200; ++k) {  // 80 MB: more than all buffers together
    server_->publish(0, Stamp{k}, bytes);
    const std::string message = awake->read_message();
    ASSERT_EQ(message.size(), 13 + bytes.size());
    ASSERT_EQ(static_cast<unsigned char>(message[5]), k) << "none is left out";
  }
  // It wakes up: what it gets are whole messages in their order, the newest at the end, and it is told what it missed.
  std::int64_t last = 0;
  std::size_t messages = 0;
  bool was_told = false;
  while (last < 200) {
    const std::optional<SocketClient::Frame> frame = deaf->read_frame();
    ASSERT_TRUE(frame);
    if (frame->opcode == Opcode::kText) {
      was_told = was_told || frame->bytes.find("too slowly") != std::string::npos;
    } else {
      ASSERT_EQ(frame->bytes.size(), 13 + bytes.size());
      const std::int64_t number = static_cast<unsigned char>(frame->bytes[5]);
      ASSERT_GT(number, last);
      last = number;
      ++messages;
    }
  }
  EXPECT_LT(messages, 100U);
  EXPECT_TRUE(was_told);
}

TEST_F(LiveServerAbuse, ClientsThatVanishAreForgotten) {
  const std::string bytes(2'000'000, 'x');
  for (int k = 0; k < 100; ++k) {  // more than may be connected at once
    const auto client = subscriber();
    server_->publish(0, Stamp{k}, bytes);
    if (k % 2 == 0) {
      static_cast<void>(client->read_frame());
    }
    client->vanish();  // in the middle of a message
  }
  for (int k = 0; k < 1000 && server_->is_wanted(0); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_FALSE(server_->is_wanted(0));
  expect_service();
}

TEST_F(LiveServerAbuse, MoreClientsThanItTakesAreTold) {
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t k = 0; k < LiveServer::kMaxClients; ++k) {
    clients.push_back(subscriber());
  }
  SocketClient late(server_->port());
  EXPECT_TRUE(late.open(server_->port()).starts_with("HTTP/1.1 503 "));
  clients.pop_back();
  bool is_taken = false;
  for (int k = 0; k < 100 && !is_taken; ++k) {
    SocketClient next(server_->port());
    is_taken = next.open(server_->port()).starts_with("HTTP/1.1 101 ");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(is_taken);
}

TEST_F(LiveServerAbuse, TheEndDoesNotWaitForThoseWhoDoNotRead) {
  const auto deaf = subscriber(4096);
  wait_until_wanted();
  for (int k = 0; k < 40; ++k) {
    server_->publish(0, Stamp{k}, std::string(400'000, 'x'));
  }
  server_->end("the run has ended");
  server_.reset();
  EXPECT_TRUE(deaf->is_closed_by_server());
}

}  // namespace
}  // namespace dynamic_icp::live
