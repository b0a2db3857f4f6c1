// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace dynamic_icp::formats {

// For tests: takes archives apart by the published layout of zip files, without the code under test.

/// The little-endian number at `offset`; throws std::out_of_range beyond the end.
template <class Number>
Number number_in(const std::string& bytes, std::size_t offset) {
  const std::string part = bytes.substr(offset, sizeof(Number));
  Number value{};
  std::memcpy(&value, part.size() == sizeof(Number) ? part.data() : throw std::out_of_range("number"), sizeof(Number));
  return value;
}

/// CRC-32 with the polynomial of zip archives, bit by bit.
inline std::uint32_t crc32_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) {
      crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

/// Where the entries of the central directory begin.
inline std::vector<std::size_t> central_entries(const std::string& archive) {
  const std::size_t end = archive.rfind(std::string("PK\x05\x06"));
  std::vector<std::size_t> entries;
  std::size_t at = number_in<std::uint32_t>(archive, end + 16);
  for (int i = 0; i < number_in<std::uint16_t>(archive, end + 10); ++i) {
    if (archive.substr(at, 4) != "PK\x01\x02") {
      throw std::out_of_range("central directory");
    }
    entries.push_back(at);
    at += 46U + number_in<std::uint16_t>(archive, at + 28) + number_in<std::uint16_t>(archive, at + 30) +
          number_in<std::uint16_t>(archive, at + 32);
  }
  return entries;
}

/// Names and contents of an archive whose members are stored, not compressed. Throws std::runtime_error when one is not
/// or does not have the checksum it should have.
inline std::vector<std::pair<std::string, std::string>> stored_members(const std::string& archive) {
  std::vector<std::pair<std::string, std::string>> members;
  for (const std::size_t at : central_entries(archive)) {
    const std::string name = archive.substr(at + 46, number_in<std::uint16_t>(archive, at + 28));
    const std::size_t local = number_in<std::uint32_t>(archive, at + 42);
    const std::size_t begin =
        local + 30U + number_in<std::uint16_t>(archive, local + 26) + number_in<std::uint16_t>(archive, local + 28);
    const std::string content = archive.substr(begin, number_in<std::uint32_t>(archive, at + 24));
    if (archive.substr(local, 4) != "PK\x03\x04" || number_in<std::uint16_t>(archive, at + 10) != 0 ||
        number_in<std::uint32_t>(archive, at + 16) != crc32_of(content)) {
      throw std::runtime_error(name);
    }
    members.emplace_back(name, content);
  }
  return members;
}

/// The numbers of an array of NPY version 1.0 whose header holds `described`, e.g. "'<f4', 'fortran_order': False".
template <class Number>
std::vector<Number> numbers_of(const std::string& npy, const std::string& described) {
  const std::size_t begin = 10U + number_in<std::uint16_t>(npy, 8);
  if (npy.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8) || npy.substr(0, begin).find(described) == npy.npos) {
    throw std::runtime_error(npy.substr(0, begin));
  }
  std::vector<Number> values((npy.size() - begin) / sizeof(Number));
  std::memcpy(values.data(), npy.data() + begin, values.size() * sizeof(Number));
  return values;
}

}  // namespace dynamic_icp::formats
