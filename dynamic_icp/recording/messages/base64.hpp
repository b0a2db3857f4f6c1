// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dynamic_icp::messages {

/// The bytes that a text of base64 (RFC 4648, the usual alphabet, with or without '=' at the end) stands for; nothing
/// for other texts.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace dynamic_icp::messages
