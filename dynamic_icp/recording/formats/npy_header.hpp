// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::formats {

/// The types of numbers in NPY files.
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

/// The bytes of one number.
std::size_t size_of(NpyType type);

/// What stands before the data of an NPY file.
struct NpyHeader {
  NpyType type = NpyType::kFloat64;
  bool big_endian = false;
  bool fortran_order = false;  ///< the first index runs fastest, not the last
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;  ///< where the data begin
};

/// The bytes that an array of this type and shape takes. Throws DataError, with `origin` for the file, when they are
/// more than can be counted.
std::size_t data_bytes(NpyType type, const std::vector<std::size_t>& shape, std::string_view origin);

/// Reads the header of versions 1.0, 2.0 and 3.0. Booleans count as uint8. `origin` stands for the file in messages.
/// Throws DataError naming the byte and what was expected there; Python objects, which only Python can decode, and
/// tables of records are named as such.
NpyHeader parse_npy_header(std::string_view content, std::string_view origin);

/// The header of version 1.0 for little-endian data in C order.
std::string npy_header(NpyType type, const std::vector<std::size_t>& shape);

}  // namespace dynamic_icp::formats
