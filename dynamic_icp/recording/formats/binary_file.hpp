// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace dynamic_icp::formats {

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

/// Writes bytes, or a text, to a new file of an output folder (output_folder.hpp): not synchronised one by one, because
/// the folder only counts once it is committed. Throws DataError naming file and reason.
void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);
inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  write_bytes(path, std::as_bytes(std::span(bytes)));
}

/// Writes numbers one after the other, little-endian.
template <class Number>
void write_values(const std::filesystem::path& path, std::span<const Number> values) {
  static_assert(std::is_arithmetic_v<Number>);
  write_bytes(path, std::as_bytes(values));
}

/// Appends the bytes of a number, little-endian and without padding.
template <class Number>
void append_value(std::string& bytes, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(Number));
}

/// The little-endian number that begins at `offset`, which need not be aligned. The bytes must be there.
template <class Number>
Number value_at(std::string_view bytes, std::size_t offset) {
  static_assert(std::is_arithmetic_v<Number>);
  Number value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(Number));
  return value;
}

/// Makes a folder and those above it. Throws DataError naming folder and reason.
void make_folder(const std::filesystem::path& path);

}  // namespace dynamic_icp::formats
