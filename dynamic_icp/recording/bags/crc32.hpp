// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace dynamic_icp::bags {

/// CRC-32 as in zip archives and MCAP (reflected polynomial 0xEDB88320). `before`: of the bytes in front of these.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace dynamic_icp::bags
