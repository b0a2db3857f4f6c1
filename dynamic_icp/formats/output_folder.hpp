// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace dynamic_icp::formats {

/// A result folder that appears whole or not at all.
///
/// Files are written into a hidden staging folder beside the final one; commit() renames it into place. When the
/// object is destroyed before that, the staging folder is removed and an earlier result is untouched. Staging folders
/// left behind by a killed process are removed by the next one that writes to the same place.
class OutputFolder {
 public:
  /// `marker` is the file every result of this kind holds ("run.json"). An existing folder that is not empty is
  /// refused with a DataError; with `replace` it is replaced at commit, but only if it holds the marker: a folder with
  /// anything else in it is never deleted.
  OutputFolder(const std::filesystem::path& final_path, const std::string& marker, bool replace);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return staging_; }

  /// Puts the staged files into their final place. Throws DataError; an earlier result is kept then.
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;
  std::string marker_;
  bool replace_;
  int lock_ = -1;  ///< held on the staging folder, so that others can tell it from one left behind
};

}  // namespace dynamic_icp::formats
