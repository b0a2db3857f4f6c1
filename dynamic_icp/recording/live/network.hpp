// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

// What visitor, client and server share of Boost.Asio and Boost.Beast.
namespace dynamic_icp::live {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using net::ip::tcp;
using Fault = boost::system::error_code;
using HttpRequest = http::request<http::empty_body>;

inline std::string_view as_view(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace dynamic_icp::live
