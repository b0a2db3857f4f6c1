// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/client.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/live/live_server.hpp"

namespace dynamic_icp::live {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kBetweenComplaints_s{2};      // that a client is too slow
constexpr std::size_t kMaxTextsWaiting = 32;    // for a client that does not read
constexpr std::size_t kMaxSubscriptions = 256;  // of one client
constexpr std::size_t kMaxReasonBytes = 120;    // of a closing frame: 123
constexpr std::size_t kMaxQuotedBytes = 40;     // of what a client sent

}  // namespace

Client::Client(beast::tcp_stream&& stream, std::shared_ptr<void> connection, ServerState& server, WhenGone when_gone)
    : stream_(std::move(stream)),
      connection_(std::move(connection)),
      server_(server),
      when_gone_(std::move(when_gone)) {}

void Client::accept(const HttpRequest& request, std::string_view subprotocol) {
  beast::get_lowest_layer(stream_).expires_never();  // the timeouts below take its place
  stream_.set_option(websocket::stream_base::timeout{
      .handshake_timeout = server_.request_time, .idle_timeout = server_.silence_time, .keep_alive_pings = true});
  stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
    response.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
  }));
  stream_.read_message_max(LiveServer::kMaxRequestBytes);
  stream_.auto_fragment(false);
  stream_.control_callback([this](websocket::frame_type, beast::string_view) { count_request(); });
  stream_.async_accept(request, [self = shared_from_this()](Fault fault) {
    if (fault || self->is_over_) {
      self->leave();
      return;
    }
    self->is_open_ = true;
    self->tell(self->server_.info);
    self->tell(self->server_.advertisement);
    if (self->server_.time.bytes) {
      self->offer_time(self->server_.time);
    }
    self->read_next();
  });
}

void Client::offer(const Outgoing& message) {
  for (const auto& [id, channel] : subscriptions_) {
    if (channel == message.channel) {
      queue_.push({channel, id, message.stamp, message.bytes});
    }
  }
  complain_if_slow();
  write_next();
}

void Client::offer_time(const Outgoing& message) {
  if (is_open_) {
    queue_.push(message);
    write_next();
  }
}

void Client::finish(const std::string& text) {
  is_finishing_ = true;
  farewell_ = text.substr(0, kMaxReasonBytes);
  if (is_open_) {
    tell(status(StatusLevel::kInfo, text, "end"));
  } else {
    close_socket();
  }
}

void Client::read_next() {
  stream_.async_read(incoming_, [self = shared_from_this()](Fault fault, std::size_t) {
    if (fault || self->is_over_) {
      self->leave();
      return;
    }
    if (self->count_request()) {
      self->handle();
    }
    self->incoming_.clear();
    self->read_next();  // where the socket is closed by now, this leaves
  });
}

/// Whether it may be answered: no client needs to say much.
bool Client::count_request() {
  const auto now = steady_clock::now();
  if (now - second_began_ > seconds(1)) {
    second_began_ = now;
    requests_ = 0;
  }
  if (++requests_ <= LiveServer::kMaxRequestsPerSecond) {
    return true;
  }
  close_socket();
  return false;
}

void Client::handle() {
  if (stream_.got_binary()) {
    complain("this server takes no data");
    return;
  }
  Request request;
  try {
    request = parse_request({static_cast<const char*>(incoming_.data().data()), incoming_.size()});
  } catch (const std::invalid_argument& error) {
    complain(error.what());
    return;
  }
  if (request.operation != "subscribe" && request.operation != "unsubscribe") {
    complain(
        fmt::format("'{}' means nothing here: this server only sends", request.operation.substr(0, kMaxQuotedBytes)));
    return;
  }
  for (const Subscription& wanted : request.subscriptions) {
    begin(wanted);
  }
  for (const std::uint32_t id : request.ended) {
    end(id);
  }
  write_next();
}

void Client::begin(const Subscription& wanted) {
  if (wanted.channel >= server_.channels) {
    complain(fmt::format("there is no channel {}", wanted.channel));
  } else if (subscriptions_.size() >= kMaxSubscriptions || !subscriptions_.emplace(wanted.id, wanted.channel).second) {
    complain(fmt::format("subscription {} is there already, or there are too many", wanted.id));
  } else {
    ++server_.subscriptions[wanted.channel];
    if (const Outgoing& last = server_.latest[wanted.channel]; last.bytes) {
      queue_.push({last.channel, wanted.id, last.stamp, last.bytes});
    }
  }
}

void Client::end(std::uint32_t id) {
  const auto found = subscriptions_.find(id);
  if (found == subscriptions_.end()) {
    complain(fmt::format("there is no subscription {}", id));
    return;
  }
  --server_.subscriptions[found->second];
  queue_.end(id);
  subscriptions_.erase(found);
}

/// Says what is wrong with a request; disconnects whoever sends too many of them.
void Client::complain(const std::string& text) {
  if (++faults_ > LiveServer::kMaxFaults) {
    close_socket();
    return;
  }
  tell(status(StatusLevel::kError, text, "request"));
}

void Client::complain_if_slow() {
  left_out_ += queue_.take_left_out();
  const auto now = steady_clock::now();
  if (left_out_ > 0 && now - complained_ > kBetweenComplaints_s) {
    complained_ = now;
    tell(status(StatusLevel::kWarning,
                fmt::format("this client reads too slowly: {} messages were left out", std::exchange(left_out_, 0)),
                "slow"));
  }
}

void Client::tell(std::string text) {
  if (texts_.size() >= kMaxTextsWaiting) {
    close_socket();
    return;
  }
  texts_.push_back(std::move(text));
  write_next();
}

void Client::write_next() {
  if (is_writing_ || !is_open_ || is_over_) {
    return;
  }
  if (!texts_.empty()) {
    text_ = std::move(texts_.front());
    texts_.pop_front();
    stream_.text(true);
    write({net::const_buffer(text_.data(), text_.size()), net::const_buffer()});
  } else if (std::optional<Outgoing> message = queue_.pop()) {
    message_ = std::move(*message);
    head_ = message_head(message_.subscription, message_.stamp);
    const bool is_time = message_.channel >= server_.channels;
    stream_.binary(true);
    write({net::const_buffer(head_.data(), is_time ? 0 : head_.size()),
           net::const_buffer(message_.bytes->data(), message_.bytes->size())});
  } else if (is_finishing_) {
    is_over_ = true;
    stream_.async_close({websocket::close_code::normal, farewell_}, [self = shared_from_this()](Fault) {
      self->close_socket();  // what still reads leaves
    });
  }
}

void Client::write(const std::array<net::const_buffer, 2>& bytes) {
  is_writing_ = true;
  stream_.async_write(bytes, [self = shared_from_this()](Fault fault, std::size_t) {
    self->is_writing_ = false;
    if (fault) {
      self->close_socket();
    } else {
      self->write_next();
    }
  });
}

/// Whatever is under way ends with an error.
void Client::close_socket() {
  is_over_ = true;
  Fault ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
}

void Client::leave() {
  is_over_ = true;
  for (const auto& [id, channel] : std::exchange(subscriptions_, {})) {
    --server_.subscriptions[channel];
  }
  when_gone_(shared_from_this());
}

}  // namespace dynamic_icp::live
