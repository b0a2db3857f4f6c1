// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/visitor.hpp"

#include <string_view>
#include <utility>

namespace dynamic_icp::live {
namespace {

constexpr std::size_t kMaxHeaderBytes = 8192;  // of a request

// What the page may do: show itself, and listen to the server that it came from.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

Visitor::Visitor(tcp::socket&& socket, std::shared_ptr<void> connection, const ServerSettings& settings,
                 WhenUpgrade when_upgrade)
    : stream_(std::move(socket)),
      connection_(std::move(connection)),
      settings_(settings),
      when_upgrade_(std::move(when_upgrade)),
      buffer_(kMaxHeaderBytes) {
  parser_.header_limit(kMaxHeaderBytes);
}

void Visitor::read() {
  stream_.expires_after(settings_.request_time);
  http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](Fault fault, std::size_t) {
    if (!fault) {
      self->handle();
    }
  });
}

void Visitor::answer(http::status code, std::string body, const char* type) {
  response_ = http::response<http::string_body>(code, parser_.get().version());
  response_.set(http::field::content_type, type);
  response_.set(http::field::cache_control, "no-store");
  response_.set("Content-Security-Policy", kPagePolicy);
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.keep_alive(false);
  response_.content_length(body.size());
  if (parser_.get().method() != http::verb::head) {
    response_.body() = std::move(body);
  }
  stream_.expires_after(settings_.request_time);
  http::async_write(stream_, response_, [self = shared_from_this()](Fault, std::size_t) {
    Fault ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

void Visitor::handle() {
  const HttpRequest& request = parser_.get();
  const std::string_view host = as_view(request[http::field::host]);
  if (!is_own_host(host, settings_.access)) {
    answer(http::status::forbidden, "This server answers to its own address only.\n");
  } else if (websocket::is_upgrade(request)) {
    if (!is_permitted_origin(as_view(request[http::field::origin]), host, settings_.access)) {
      answer(http::status::forbidden, "Pages from elsewhere may not read this stream unless they are permitted.\n");
    } else {
      when_upgrade_(*this);
    }
  } else if (request.method() != http::verb::get && request.method() != http::verb::head) {
    answer(http::status::method_not_allowed, "There is only a page to get.\n");
  } else if (request.target() != "/") {
    answer(http::status::not_found, "There is only one page here: /\n");
  } else if (settings_.page.empty()) {
    answer(http::status::not_found, "This program was built without its page; Foxglove can connect all the same.\n");
  } else {
    answer(http::status::ok, settings_.page, "text/html; charset=utf-8");
  }
}

}  // namespace dynamic_icp::live
