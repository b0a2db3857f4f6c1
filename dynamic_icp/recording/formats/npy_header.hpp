// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::formats {

/// The types of numbers in NPY files; those of PCD and PLY are among them.
enum class NpyType : std::uint8_t {
  kFloat32,
  kFloat64,
  kInt8,
  kInt16,
  kInt32,
  kInt64,
  kUint8,
  kUint16,
  kUint32,
  kUint64
};

/// NumPy's code for the type, e.g. "f4": its kind and the number of bytes.
std::string_view code_of(NpyType type);

/// The type of that code; nothing for other texts.
std::optional<NpyType> type_of_code(std::string_view code);

/// The bytes of one number.
std::size_t size_of(NpyType type);

constexpr bool is_float(NpyType type) { return type == NpyType::kFloat32 || type == NpyType::kFloat64; }

/// Calls `use` with a zero of the type's numbers.
template <class Use>
auto with_type(NpyType type, const Use& use) {
  switch (type) {
    case NpyType::kFloat32:
      return use(float{});
    case NpyType::kFloat64:
      return use(double{});
    case NpyType::kInt8:
      return use(std::int8_t{});
    case NpyType::kInt16:
      return use(std::int16_t{});
    case NpyType::kInt32:
      return use(std::int32_t{});
    case NpyType::kInt64:
      return use(std::int64_t{});
    case NpyType::kUint8:
      return use(std::uint8_t{});
    case NpyType::kUint16:
      return use(std::uint16_t{});
    case NpyType::kUint32:
      return use(std::uint32_t{});
    case NpyType::kUint64:
      break;
  }
  return use(std::uint64_t{});
}

/// What stands before the data of an NPY file.
struct NpyHeader {
  NpyType type = NpyType::kFloat64;
  bool is_half = false;  ///< the numbers are stored as float16; `type` is float32, which they become
  bool big_endian = false;
  bool fortran_order = false;  ///< the first index runs fastest, not the last
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;  ///< where the data begin
};

/// The bytes that an array of this type and shape takes. Throws DataError, with `origin` for the file, when they are
/// more than can be counted.
std::size_t data_bytes(NpyType type, const std::vector<std::size_t>& shape, std::string_view origin);

/// Reads the header of versions 1.0, 2.0 and 3.0. Booleans count as uint8, float16 become float32. `origin` stands for
/// the file in messages. Throws DataError naming the byte and what was expected there; Python objects, which only
/// Python can decode, and tables of records are named as such.
NpyHeader parse_npy_header(std::string_view content, std::string_view origin);

/// The header of version 1.0 for little-endian data in C order.
std::string npy_header(NpyType type, const std::vector<std::size_t>& shape);

}  // namespace dynamic_icp::formats
