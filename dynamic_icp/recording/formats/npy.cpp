// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npy.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/half_floats.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

void check_size(const NpyArray& array) {
  if (array.bytes.size() != data_bytes(array.type, array.shape, array.origin)) {
    throw std::invalid_argument("the bytes of an array do not fit its shape");
  }
}

/// The items of `data`, where the first index runs fastest, with the last index fastest.
std::string in_c_order(std::string_view data, const std::vector<std::size_t>& shape, std::size_t item_bytes) {
  std::string sorted;
  sorted.reserve(data.size());
  std::vector<std::size_t> index(shape.size(), 0);
  while (sorted.size() < data.size()) {
    std::size_t item = 0;
    for (std::size_t d = shape.size(); d-- > 0;) {
      item = item * shape[d] + index[d];
    }
    sorted.append(data.substr(item * item_bytes, item_bytes));
    for (std::size_t d = shape.size(); d-- > 0 && ++index[d] == shape[d];) {
      index[d] = 0;
    }
  }
  return sorted;
}

void reverse_items(std::string& bytes, std::size_t item_bytes) {
  for (auto item = bytes.begin(); item != bytes.end(); item += static_cast<std::ptrdiff_t>(item_bytes)) {
    std::reverse(item, item + static_cast<std::ptrdiff_t>(item_bytes));
  }
}

/// An array may have any number of rows that take no bytes, as long as it has no columns.
void check_column(const NpyArray& array, std::size_t column) {
  if (column >= columns_of(array)) {
    throw DataError(
        fmt::format("{}: has {} columns, expected at least {}", array.origin, columns_of(array), column + 1));
  }
  check_size(array);
}

/// Calls `use` with each number of a column, which must be there, from the first row on.
template <class Use>
void for_column(const NpyArray& array, std::size_t column, const Use& use) {
  const std::size_t columns = columns_of(array);
  const std::size_t rows = rows_of(array);
  with_type(array.type, [&](auto zero) {
    for (std::size_t row = 0; row < rows; ++row) {
      use(value_at<decltype(zero)>(array.bytes, (row * columns + column) * sizeof(zero)));
    }
  });
}

}  // namespace

NpyArray parse_npy(std::string_view content, const std::string& origin) {
  NpyHeader header = parse_npy_header(content, origin);
  const std::string_view data = content.substr(header.data_offset);
  const std::size_t item_bytes = header.is_half ? kHalfBytes : size_of(header.type);
  const std::size_t expected = data_bytes(header.type, header.shape, origin) / size_of(header.type) * item_bytes;
  if (data.size() != expected) {
    throw DataError(fmt::format("{}: expected {} bytes of data for shape ({}) of {}, found {}", origin, expected,
                                fmt::join(header.shape, ", "), header.is_half ? "f2" : code_of(header.type),
                                data.size()));
  }
  NpyArray array{header.type, std::move(header.shape), {}, origin};
  array.bytes =
      header.fortran_order && array.shape.size() > 1 ? in_c_order(data, array.shape, item_bytes) : std::string(data);
  if (header.big_endian) {
    reverse_items(array.bytes, item_bytes);
  }
  if (header.is_half) {
    array.bytes = widened_halves(array.bytes);
  }
  return array;
}

NpyArray read_npy(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  refuse_other_kind(path, content, FileKind::kNpy);
  return with_memory_for(path, [&] { return parse_npy(content, path.string()); });
}

std::string npy_bytes(const NpyArray& array) {
  check_size(array);
  return npy_header(array.type, array.shape) + array.bytes;
}

void write_npy(const std::filesystem::path& path, const NpyArray& array) { write_whole_file(path, npy_bytes(array)); }

NpyArray npy_array(NpyType type, std::vector<std::size_t> shape, std::span<const std::byte> bytes) {
  NpyArray array{type, std::move(shape), {}, "array"};
  array.bytes.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_size(array);
  return array;
}

NpyArray array_of(NpyType type, std::vector<std::size_t> shape, std::span<const double> values) {
  NpyArray array{type, std::move(shape), {}, "array"};
  array.bytes.reserve(values.size() * size_of(type));
  with_type(type, [&](auto zero) {
    for (const double value : values) {
      append_value(array.bytes, static_cast<decltype(zero)>(value));
    }
  });
  return array;
}

std::size_t rows_of(const NpyArray& array) {
  if (array.shape.empty() || array.shape.size() > 2) {
    throw DataError(
        fmt::format("{}: has the shape ({}), expected (N,) or (N, k)", array.origin, fmt::join(array.shape, ", ")));
  }
  return array.shape.front();
}

std::size_t columns_of(const NpyArray& array) {
  rows_of(array);
  return array.shape.size() == 2 ? array.shape[1] : 1;
}

std::vector<double> column_as_doubles(const NpyArray& array, std::size_t column) {
  check_column(array, column);
  std::vector<double> values(rows_of(array));
  double* next = values.data();
  for_column(array, column, [&](auto value) { *next++ = static_cast<double>(value); });
  return values;
}

std::vector<std::int64_t> column_as_integers(const NpyArray& array, std::size_t column) {
  check_column(array, column);
  std::vector<std::int64_t> values;
  for_column(array, column, [&](auto value) {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      throw DataError(fmt::format("{}: holds {}, expected integers", array.origin, code_of(array.type)));
    } else {
      if (!std::in_range<std::int64_t>(value)) {
        throw DataError(
            fmt::format("{}: row {} is {}, expected at most 9223372036854775807", array.origin, values.size(), value));
      }
      values.push_back(static_cast<std::int64_t>(value));
    }
  });
  return values;
}

}  // namespace dynamic_icp::formats
