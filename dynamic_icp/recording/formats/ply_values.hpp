// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "dynamic_icp/recording/formats/npy_header.hpp"

// The numbers of PLY files, by their types.
namespace dynamic_icp::formats {

/// The type of that name in a header, old or new; nothing for other names.
std::optional<NpyType> ply_type_of(std::string_view name);

/// The old name of a type, which every reader knows; empty for integers of 64 bits, which PLY does not know.
std::string_view ply_name(NpyType type);

/// The numbers of a field of records that lie `record_bytes` apart, as many as there is room for.
void load_numbers(NpyType type, const char* first, std::size_t record_bytes, bool big_endian,
                  std::span<double> numbers);

}  // namespace dynamic_icp::formats
