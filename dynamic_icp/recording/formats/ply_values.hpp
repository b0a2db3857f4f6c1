// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "dynamic_icp/recording/formats/ply.hpp"

// The numbers of PLY files, by their types.
namespace dynamic_icp::formats {

/// Size and range of a type; floating-point types have no range.
struct PlyTypeTraits {
  std::size_t bytes;
  double minimum;
  double maximum;
  bool whole;
};

const PlyTypeTraits& traits(PlyType type);

/// The type of that name in a header, old or new; nothing for other names.
std::optional<PlyType> ply_type_of(std::string_view name);

/// The number at `bytes`, in the byte order of the machine.
double load_number(PlyType type, const char* bytes);

/// Fills the values of a column, as many as it has, from fields that lie `record_bytes` apart from the first one on.
void load_column(PlyColumn& column, const char* first, std::size_t record_bytes, bool big_endian);

}  // namespace dynamic_icp::formats
