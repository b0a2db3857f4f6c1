// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dynamic_icp::formats {

/// Unpacks a stream of the LZF compression, which compressed PCD files hold, to exactly `unpacked_bytes` bytes.
/// `origin` stands for the file in messages.
///
/// Throws DataError naming the byte of the stream when it ends early, refers to what is before its beginning, or gives
/// fewer or more bytes; and before memory is taken when it is too short to hold so many.
std::string unpack_lzf(std::string_view packed, std::size_t unpacked_bytes, std::string_view origin);

}  // namespace dynamic_icp::formats
