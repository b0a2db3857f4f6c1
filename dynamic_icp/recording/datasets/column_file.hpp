// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/formats/csv.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/pcd_read.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"

namespace dynamic_icp::datasets {

/// The kinds of files whose columns have names.
enum class ColumnFileKind : std::uint8_t {
  kNpz,
  kPcd,
  kPly,
  kNpy,     ///< one array of shape (N, 4) or wider
  kCsv,     ///< text; without a header the one array of all columns
  kNpyPair  ///< points in <name>.npy, an array of shape (N, 3), and Doppler in <name>_dop.npy, of shape (N,)
};

/// One scan in such a file: arrays of numbers by name.
class ColumnFile final : public NamedColumns {
 public:
  /// Opens a file. Throws DataError naming file, place and what was expected.
  ColumnFile(ColumnFileKind kind, const std::filesystem::path& path);

  /// The names of the arrays of numbers, in the order of the file.
  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }

  /// Of arrays of the file that hold no numbers, why, in sentences: they are not among the names.
  [[nodiscard]] const std::vector<std::string>& unusable() const { return unusable_; }

  /// The array of that name. Throws DataError where there is none or it is damaged.
  [[nodiscard]] formats::NpyArray read(const std::string& name) const override;

  /// What was odd but could be lived with; empty: nothing.
  [[nodiscard]] std::string warning() const override;

  /// The Doppler file of a pair.
  static std::filesystem::path doppler_file(const std::filesystem::path& points);

 private:
  struct NpyPair {
    std::filesystem::path points;
  };

  std::filesystem::path path_;
  std::vector<std::string> names_;
  std::vector<std::string> unusable_;
  struct NpyFile {
    std::filesystem::path path;
  };

  std::variant<NpyPair, NpyFile, formats::CsvTable, formats::NpzFile, formats::PcdFile, formats::PlyFile> file_;
};

}  // namespace dynamic_icp::datasets
