// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "dynamic_icp/recording/formats/npy_header.hpp"

namespace dynamic_icp::formats {

/// An array of NumPy: the numbers of all rows one after the other, little-endian.
struct NpyArray {
  NpyType type = NpyType::kFloat64;
  std::vector<std::size_t> shape;  ///< (N,), (N, k), ...; empty: a single number
  std::string bytes;               ///< in C order: the last index runs fastest
  std::string origin;              ///< names the array in messages
};

/// An array with its name among those of a file: a member of an archive, a field of points.
struct NamedArray {
  std::string name;
  NpyArray array;
};

/// Takes an array from memory; `origin` stands for the file in messages. Any byte order and both orders of indices are
/// understood; float16 become float32. Throws DataError naming what was expected: no NPY array, objects or records
/// instead of numbers, a size that is not what the header says. Never takes more memory than a small multiple of the
/// input.
NpyArray parse_npy(std::string_view content, const std::string& origin);

/// The same from a file.
NpyArray read_npy(const std::filesystem::path& path);

/// The bytes of an NPY file, version 1.0. Throws std::invalid_argument when shape and bytes do not belong together.
std::string npy_bytes(const NpyArray& array);

/// Writes an array whole or not at all.
void write_npy(const std::filesystem::path& path, const NpyArray& array);

/// An array of these bytes. Throws std::invalid_argument when there are more or fewer than the shape asks for.
NpyArray npy_array(NpyType type, std::vector<std::size_t> shape, std::span<const std::byte> bytes);

/// The type of an array of these numbers.
template <class Number>
constexpr NpyType npy_type_of() {
  static_assert(std::is_arithmetic_v<Number> && sizeof(Number) <= 8);
  if (std::is_floating_point_v<Number>) {
    return sizeof(Number) == 4 ? NpyType::kFloat32 : NpyType::kFloat64;
  }
  const auto first = static_cast<int>(std::is_signed_v<Number> ? NpyType::kInt8 : NpyType::kUint8);
  return static_cast<NpyType>(first + (sizeof(Number) == 1   ? 0
                                       : sizeof(Number) == 2 ? 1
                                       : sizeof(Number) == 4 ? 2
                                                             : 3));
}

/// An array of these numbers, row by row.
template <class Number>
NpyArray npy_array(std::vector<std::size_t> shape, std::span<const Number> values) {
  return npy_array(npy_type_of<Number>(), std::move(shape), std::as_bytes(values));
}

/// The same of numbers of any type, which holds them.
NpyArray array_of(NpyType type, std::vector<std::size_t> shape, std::span<const double> values);

/// N and k of an array of shape (N, k); k is 1 for (N,). Throws DataError for other shapes.
std::size_t rows_of(const NpyArray& array);
std::size_t columns_of(const NpyArray& array);

/// One column, converted to double; integers beyond 2^53 are rounded. Throws DataError when there is no such column.
std::vector<double> column_as_doubles(const NpyArray& array, std::size_t column = 0);

/// One column of integers. Throws DataError when there is no such column, the numbers are floating-point ones or one
/// does not fit.
std::vector<std::int64_t> column_as_integers(const NpyArray& array, std::size_t column = 0);

}  // namespace dynamic_icp::formats
