// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/ply_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace dynamic_icp::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "values of little-endian files are copied as they are");

struct TypeNames {
  NpyType type;
  std::string_view before;  ///< PLY named sizes
  std::string_view sized;
};

constexpr std::array<TypeNames, 8> kTypes = {{{NpyType::kInt8, "char", "int8"},
                                              {NpyType::kUint8, "uchar", "uint8"},
                                              {NpyType::kInt16, "short", "int16"},
                                              {NpyType::kUint16, "ushort", "uint16"},
                                              {NpyType::kInt32, "int", "int32"},
                                              {NpyType::kUint32, "uint", "uint32"},
                                              {NpyType::kFloat32, "float", "float32"},
                                              {NpyType::kFloat64, "double", "float64"}}};

}  // namespace

std::optional<NpyType> ply_type_of(std::string_view name) {
  const auto* const found = std::find_if(
      kTypes.begin(), kTypes.end(), [&](const TypeNames& type) { return type.before == name || type.sized == name; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

std::string_view ply_name(NpyType type) {
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeNames& names) { return names.type == type; });
  return found == kTypes.end() ? "" : found->before;
}

void load_numbers(NpyType type, const char* first, std::size_t record_bytes, bool big_endian,
                  std::span<double> numbers) {
  with_type(type, [&](auto zero) {
    std::array<char, sizeof(zero)> bytes;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::memcpy(bytes.data(), first + i * record_bytes, bytes.size());
      if (big_endian) {
        std::reverse(bytes.begin(), bytes.end());
      }
      numbers[i] = static_cast<double>(std::bit_cast<decltype(zero)>(bytes));
    }
  });
}

}  // namespace dynamic_icp::formats
