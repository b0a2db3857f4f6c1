// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dynamic_icp::formats {

/// The text of some bytes: RFC 4648, the usual alphabet, with '=' at the end.
std::string base64(std::string_view bytes);

/// The bytes that a text of base64 (RFC 4648, the usual alphabet, with or without '=' at the end) stands for; nothing
/// for other texts.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace dynamic_icp::formats
