// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy_header.hpp"

namespace dynamic_icp::formats {

/// How the numbers stand in a PCD file.
enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kBinaryCompressed };

/// A field of every point; "_" is the name of padding.
struct PcdField {
  std::string name;
  NpyType type = NpyType::kFloat32;
  std::size_t count = 1;         ///< numbers of a point
  std::size_t offset_bytes = 0;  ///< in the record of a point

  [[nodiscard]] bool is_padding() const { return name == "_"; }
  [[nodiscard]] std::size_t bytes() const { return count * size_of(type); }
};

/// What stands before the data of a PCD file.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t record_bytes = 0;  ///< of one point
  std::size_t points = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::size_t data_offset = 0;  ///< where the data begin
  std::size_t lines = 0;        ///< of the header, DATA and comments included
};

/// Reads the header of versions up to 0.7. VERSION, COUNT (1), VIEWPOINT and one of POINTS and WIDTH x HEIGHT may be
/// missing; the viewpoint is not used. `origin` stands for the file in messages. Throws DataError naming the line and
/// what was expected there; the number of points is only checked against the data where these are read.
PcdHeader parse_pcd_header(std::string_view content, std::string_view origin);

}  // namespace dynamic_icp::formats
