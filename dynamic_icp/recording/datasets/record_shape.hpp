// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/formats/npy_header.hpp"

namespace dynamic_icp::datasets {

// What the records of files without a mark are when they are of no known layout: numbers of one type, one after the
// other, without padding. Told by the sizes of the files and by the numbers of one of them, to say it to the user.

struct RecordShape {
  std::size_t numbers = 0;  ///< of a record
  formats::NpyType type = formats::NpyType::kFloat32;
  std::string columns;  ///< what they may be, as a proposal: "x,y,z,_,doppler"

  [[nodiscard]] std::size_t bytes() const { return numbers * formats::size_of(type); }
};

/// The shape of float32 or float64 records, of 3 to 16 numbers: numbers of one column are closer to each other than to
/// those of other columns, from one record to the next. Nothing where the numbers are absurd (beyond 10 000 km, or not
/// 0 but below 1e-9) whatever they are taken for, or where no length stands out.
std::optional<RecordShape> shape_of(std::string_view content);

/// Why the files, scans of one recording, are no records of `numbers` numbers of this type (nothing: float16), where
/// sizes and content agree that they are of another shape, which it proposes. Nothing where nothing speaks against it,
/// and where sizes allow x, y, z and Doppler in float32 and a velocity explains the Doppler of all points, such as
/// those of beams that take turns.
std::optional<UnclearInput> other_shape(const std::vector<std::filesystem::path>& files, std::size_t numbers,
                                        std::optional<formats::NpyType> type);

/// Whether the sizes of all files, or of many from all over the recording, are multiples of a record's.
bool sizes_fit(const std::vector<std::filesystem::path>& files, std::size_t bytes);

/// What the files look like whatever was expected, as such an error; nothing where they look like no records.
std::optional<UnclearInput> likely_shape(const std::vector<std::filesystem::path>& files);

}  // namespace dynamic_icp::datasets
