// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/crc32.hpp"

#include <array>
#include <cstddef>
#include <cstring>

namespace dynamic_icp::bags {
namespace {

// Eight bytes at a time: table k is what a byte becomes with k zero bytes behind it.
constexpr std::size_t kCrcTables = 8;

constexpr std::array<std::array<std::uint32_t, 256>, kCrcTables> crc_tables() {
  std::array<std::array<std::uint32_t, 256>, kCrcTables> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < kCrcTables; ++k) {
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[k - 1][byte];
      tables[k][byte] = (crc >> 8U) ^ tables[0][crc & 0xFFU];
    }
  }
  return tables;
}

constexpr auto kCrcTable = crc_tables();

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  for (; bytes.size() >= kCrcTables; bytes.remove_prefix(kCrcTables)) {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::memcpy(&low, bytes.data(), sizeof low);
    std::memcpy(&high, bytes.data() + sizeof low, sizeof high);
    low ^= crc;
    crc = kCrcTable[7][low & 0xFFU] ^ kCrcTable[6][(low >> 8U) & 0xFFU] ^ kCrcTable[5][(low >> 16U) & 0xFFU] ^
          kCrcTable[4][low >> 24U] ^ kCrcTable[3][high & 0xFFU] ^ kCrcTable[2][(high >> 8U) & 0xFFU] ^
          kCrcTable[1][(high >> 16U) & 0xFFU] ^ kCrcTable[0][high >> 24U];
  }
  for (const char byte : bytes) {
    crc = (crc >> 8U) ^ kCrcTable[0][(crc ^ static_cast<unsigned char>(byte)) & 0xFFU];
  }
  return ~crc;
}

}  // namespace dynamic_icp::bags
