// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/live_server.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/live/client.hpp"
#include "dynamic_icp/recording/live/low_priority.hpp"
#include "dynamic_icp/recording/live/visitor.hpp"

namespace dynamic_icp::live {
namespace {

using std::chrono::seconds;

constexpr seconds kFarewell_s{2};  ///< until the last client is disconnected at the end
constexpr seconds kRetryAccept_s{1};

/// Another one for every server.
std::string new_session() {
  return fmt::format("{}-{}", ::getpid(), std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

class LiveServer::Server {
 public:
  Server(ServerSettings settings, std::vector<Channel> channels)
      : settings_(std::move(settings)), channels_(std::move(channels)), acceptor_(io_), retry_(io_) {
    check(settings_.access);
    state_.info = server_info(settings_.name, new_session());
    state_.advertisement = advertisement(channels_);
    state_.channels = channels_.size();
    state_.request_time = settings_.request_time;
    state_.silence_time = settings_.silence_time;
    state_.latest.resize(channels_.size());
    state_.subscriptions = std::make_unique<std::atomic<int>[]>(channels_.size());
    listen();
    accept_next();
    thread_ = std::thread([this] {
      lower_own_priority();
      name_own_thread("live server");
      io_.run();
    });
  }

  ~Server() {
    io_.stop();
    thread_.join();
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const { return settings_.access.port; }
  [[nodiscard]] bool is_wanted(std::size_t channel) const { return state_.subscriptions[channel] > 0; }
  [[nodiscard]] std::size_t channels() const { return channels_.size(); }

  void take(Outgoing message) {
    const std::lock_guard lock(mutex_);
    inbox_.push(std::move(message));
    if (!std::exchange(is_posted_, true)) {
      net::post(io_, [this] { distribute(); });
    }
  }

  void end(const std::string& text) {
    net::post(io_, [this, text] {
      is_ending_ = true;
      Fault ignored;
      acceptor_.close(ignored);
      for (const std::shared_ptr<Client>& client : std::set(clients_)) {
        client->finish(text);
      }
      note_if_empty();
    });
    std::unique_lock lock(mutex_);
    empty_.wait_for(lock, kFarewell_s, [this] { return is_empty_; });
  }

 private:
  void listen() {
    Access& access = settings_.access;
    Fault fault;
    const tcp::endpoint endpoint(net::ip::make_address(access.address), access.port);
    const auto check_fault = [&] {
      if (fault) {
        throw DataError(fmt::format("no live view: cannot listen at {}: {}", authority(access.address, access.port),
                                    fault.message()));
      }
    };
    acceptor_.open(endpoint.protocol(), fault);
    check_fault();
    acceptor_.set_option(net::socket_base::reuse_address(true), fault);
    acceptor_.bind(endpoint, fault);
    check_fault();
    acceptor_.listen(net::socket_base::max_listen_connections, fault);
    check_fault();
    access.port = acceptor_.local_endpoint().port();
  }

  void accept_next() {
    acceptor_.async_accept([this](Fault fault, tcp::socket socket) {
      if (is_ending_ || fault == net::error::operation_aborted) {
        return;
      }
      if (fault) {  // no more files may be open: others may be closed soon
        retry_.expires_after(kRetryAccept_s);
        retry_.async_wait([this](Fault aborted) {
          if (!aborted) {
            accept_next();
          }
        });
        return;
      }
      if (connections_ < kMaxConnections) {
        ++connections_;
        socket.set_option(tcp::no_delay(true), fault);
        std::shared_ptr<void> connection(nullptr, [this](void*) { --connections_; });
        std::make_shared<Visitor>(std::move(socket), std::move(connection), settings_, [this](Visitor& visitor) {
          welcome(visitor);
        })->read();
      }
      accept_next();
    });
  }

  void welcome(Visitor& visitor) {
    const std::string_view subprotocol =
        chosen_subprotocol(as_view(visitor.request()[http::field::sec_websocket_protocol]));
    if (subprotocol.empty()) {
      visitor.answer(http::status::bad_request, "Expected the subprotocol foxglove.websocket.v1.\n");
    } else if (is_ending_ || clients_.size() >= kMaxClients) {
      visitor.answer(http::status::service_unavailable,
                     fmt::format("There are {} clients already, and no more are taken.\n", clients_.size()));
    } else {
      const auto client = std::make_shared<Client>(visitor.take_stream(), visitor.take_connection(), state_,
                                                   [this](const std::shared_ptr<Client>& gone) {
                                                     clients_.erase(gone);
                                                     note_if_empty();
                                                   });
      clients_.insert(client);
      client->accept(visitor.request(), subprotocol);
    }
  }

  void distribute() {
    while (std::optional<Outgoing> message = next()) {
      const bool is_time = message->channel >= channels_.size();
      for (const std::shared_ptr<Client>& client : std::set(clients_)) {
        is_time ? client->offer_time(*message) : client->offer(*message);
      }
      if (is_time) {
        state_.time = std::move(*message);
      } else if (channels_[message->channel].is_kept) {
        const std::size_t channel = message->channel;
        state_.latest[channel] = std::move(*message);
      }
    }
  }

  std::optional<Outgoing> next() {
    const std::lock_guard lock(mutex_);
    std::optional<Outgoing> message = inbox_.pop();
    is_posted_ = message.has_value();
    return message;
  }

  void note_if_empty() {
    if (is_ending_ && clients_.empty()) {
      const std::lock_guard lock(mutex_);
      is_empty_ = true;
      empty_.notify_all();
    }
  }

  ServerSettings settings_;
  std::vector<Channel> channels_;
  std::size_t connections_ = 0;
  ServerState state_;
  std::mutex mutex_;  ///< of the next three
  SendQueue inbox_;
  bool is_posted_ = false;
  bool is_empty_ = false;
  std::condition_variable empty_;
  bool is_ending_ = false;
  net::io_context io_{1};  // what waits there holds visitors and clients, which count themselves above when they go
  tcp::acceptor acceptor_;
  net::steady_timer retry_;
  std::set<std::shared_ptr<Client>> clients_;
  std::thread thread_;
};

LiveServer::LiveServer(ServerSettings settings, std::vector<Channel> channels)
    : server_(std::make_unique<Server>(std::move(settings), std::move(channels))) {}

LiveServer::~LiveServer() = default;

std::uint16_t LiveServer::port() const { return server_->port(); }

bool LiveServer::is_wanted(std::size_t channel) const { return server_->is_wanted(channel); }

void LiveServer::publish(std::size_t channel, Stamp stamp, std::string bytes) {
  server_->take({channel, 0, stamp, std::make_shared<const std::string>(std::move(bytes))});
}

void LiveServer::tell_time(Stamp stamp) {
  server_->take({server_->channels(), 0, stamp, std::make_shared<const std::string>(time_message(stamp))});
}

void LiveServer::end(const std::string& text) { server_->end(text); }

}  // namespace dynamic_icp::live
