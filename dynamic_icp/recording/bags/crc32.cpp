// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/crc32.hpp"

#include <zlib.h>

namespace dynamic_icp::bags {

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  const auto* const first = reinterpret_cast<const Bytef*>(bytes.data());
  return bytes.empty() ? before : static_cast<std::uint32_t>(::crc32_z(before, first, bytes.size()));
}

}  // namespace dynamic_icp::bags
