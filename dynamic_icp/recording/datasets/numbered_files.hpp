// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace dynamic_icp::datasets {

/// The runs of digits in a text, from front to back.
std::vector<std::string_view> digit_runs(std::string_view text);

/// The last run of digits in a text; empty when there is none.
std::string_view last_digits(std::string_view text);

/// What tells the names of files apart.
enum class NameOrder : std::uint8_t {
  kSeconds,     ///< "<seconds>.<fraction>" at the end of each: 10 digits and any, or any and 9
  kLastNumber,  ///< the last run of digits
  kOneNumber,   ///< another one: all others are the same in all names
  kAllNumbers,  ///< several together, the first ones first
  kText         ///< no number: the order of names is all there is
};

/// Files in the order of what tells their names apart.
struct OrderedNames {
  std::vector<std::filesystem::path> files;
  NameOrder order = NameOrder::kText;
  std::size_t number = 0;  ///< of kOneNumber: which of the runs of digits
};

/// Orders files by their names, the first of NameOrder by which no two are the same. Throws DataError that names two
/// files with the same numbers where numbers tell the others apart, or where the same number is written in two ways.
OrderedNames order_names(std::vector<std::filesystem::path> files);

/// The files of a folder whose names end with `ending` (".bin", "_dop.npy") and hold a digit; all of that ending where
/// none does. Hidden files are left out. In no order. Throws DataError when the folder cannot be read.
std::vector<std::filesystem::path> files_ending_with(const std::filesystem::path& folder, std::string_view ending);

/// The same in the order of their names: numbers are integers of any length, 2.bin comes before 10.bin. Throws as both
/// of these.
std::vector<std::filesystem::path> numbered_files(const std::filesystem::path& folder, std::string_view ending);

}  // namespace dynamic_icp::datasets
