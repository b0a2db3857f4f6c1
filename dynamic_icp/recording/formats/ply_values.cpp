// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/ply_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace dynamic_icp::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "values of little-endian files are copied as they are");

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames = {{{"char", PlyType::kInt8},
                                                  {"int8", PlyType::kInt8},
                                                  {"uchar", PlyType::kUint8},
                                                  {"uint8", PlyType::kUint8},
                                                  {"short", PlyType::kInt16},
                                                  {"int16", PlyType::kInt16},
                                                  {"ushort", PlyType::kUint16},
                                                  {"uint16", PlyType::kUint16},
                                                  {"int", PlyType::kInt32},
                                                  {"int32", PlyType::kInt32},
                                                  {"uint", PlyType::kUint32},
                                                  {"uint32", PlyType::kUint32},
                                                  {"float", PlyType::kFloat32},
                                                  {"float32", PlyType::kFloat32},
                                                  {"double", PlyType::kFloat64},
                                                  {"float64", PlyType::kFloat64}}};

template <class Number>
constexpr PlyTypeTraits traits_of() {
  using Range = std::numeric_limits<Number>;
  return {sizeof(Number), static_cast<double>(Range::lowest()), static_cast<double>(Range::max()), Range::is_integer};
}

/// In the order of PlyType.
constexpr std::array<PlyTypeTraits, 8> kTraits = {
    traits_of<std::int8_t>(),  traits_of<std::uint8_t>(),  traits_of<std::int16_t>(), traits_of<std::uint16_t>(),
    traits_of<std::int32_t>(), traits_of<std::uint32_t>(), traits_of<float>(),        traits_of<double>()};

template <class Number>
double load(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return static_cast<double>(number);
}

template <class Number>
void load_column_of(PlyColumn& column, const char* first, std::size_t record_bytes, bool big_endian) {
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    std::array<char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), first + i * record_bytes, sizeof(Number));
    if (big_endian) {
      std::reverse(bytes.begin(), bytes.end());
    }
    column.values[i] = load<Number>(bytes.data());
  }
}

}  // namespace

const PlyTypeTraits& traits(PlyType type) { return kTraits[static_cast<std::size_t>(type)]; }

std::optional<PlyType> ply_type_of(std::string_view name) {
  const auto* const found =
      std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](const TypeName& type) { return type.name == name; });
  return found == kTypeNames.end() ? std::nullopt : std::optional(found->type);
}

double load_number(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::kInt8:
      return load<std::int8_t>(bytes);
    case PlyType::kUint8:
      return load<std::uint8_t>(bytes);
    case PlyType::kInt16:
      return load<std::int16_t>(bytes);
    case PlyType::kUint16:
      return load<std::uint16_t>(bytes);
    case PlyType::kInt32:
      return load<std::int32_t>(bytes);
    case PlyType::kUint32:
      return load<std::uint32_t>(bytes);
    case PlyType::kFloat32:
      return load<float>(bytes);
    default:
      return load<double>(bytes);
  }
}

void load_column(PlyColumn& column, const char* first, std::size_t record_bytes, bool big_endian) {
  switch (column.type) {
    case PlyType::kInt8:
      return load_column_of<std::int8_t>(column, first, record_bytes, big_endian);
    case PlyType::kUint8:
      return load_column_of<std::uint8_t>(column, first, record_bytes, big_endian);
    case PlyType::kInt16:
      return load_column_of<std::int16_t>(column, first, record_bytes, big_endian);
    case PlyType::kUint16:
      return load_column_of<std::uint16_t>(column, first, record_bytes, big_endian);
    case PlyType::kInt32:
      return load_column_of<std::int32_t>(column, first, record_bytes, big_endian);
    case PlyType::kUint32:
      return load_column_of<std::uint32_t>(column, first, record_bytes, big_endian);
    case PlyType::kFloat32:
      return load_column_of<float>(column, first, record_bytes, big_endian);
    case PlyType::kFloat64:
      return load_column_of<double>(column, first, record_bytes, big_endian);
  }
}

}  // namespace dynamic_icp::formats
