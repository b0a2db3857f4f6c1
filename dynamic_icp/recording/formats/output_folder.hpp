// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/path_lock.hpp"
#include "dynamic_icp/recording/formats/result_kind.hpp"
#include "dynamic_icp/recording/formats/unfinished.hpp"

namespace dynamic_icp::formats {

/// Whether a path is a folder or something in it, by the names alone.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

/// The folder holds an earlier result of the same kind, which the caller may allow to replace.
class EarlierResult : public DataError {
 public:
  using DataError::DataError;
};

/// A result folder that appears whole or not at all.
///
/// Files are written into a hidden staging folder beside the final one; commit() renames it into place. When the
/// object is destroyed before that, the staging folder is removed and an earlier result is untouched. A folder that no
/// other one can be renamed to (a mount point, the working directory) is staged within: its files come into place one
/// by one then, the marker last. What a killed process left behind is removed by the next one that writes to the same
/// place, or brought to its end when it was about to come into place; of another place in the same folder it is removed
/// when it is of the same kind. With a checkpoint in it (ResultKind) it can be taken over instead, and stays for that
/// until a result comes to the same place.
class OutputFolder {
 public:
  /// What is done with a partial result that was left with a checkpoint at the same place.
  enum class Leftover { kRemove, kTakeOver };

  /// A link is followed. An existing folder that is not empty is refused with a DataError, EarlierResult where
  /// `replace` would help: with it a result of the same kind in it is replaced at commit. Nothing else is ever removed:
  /// a folder with any other file in it is refused, and one that holds one of the `inputs` or the working directory.
  ///
  /// Where a partial result is to be taken over and another process still writes it, that is a DataError.
  OutputFolder(const std::filesystem::path& path, const ResultKind& kind, bool replace,
               const std::vector<std::filesystem::path>& inputs = {}, Leftover leftover = Leftover::kRemove);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return staging_; }

  /// Whether there was a checkpoint that was taken over with the files beside it, or to be removed.
  [[nodiscard]] bool had_checkpoint() const { return had_checkpoint_; }

  /// From now on what is staged is left for another one to take over, however this process ends without commit(). Until
  /// `drop`.
  void keep();
  void drop();

  /// Puts the staged files into their final place. Throws DataError; an earlier result is kept then. The signals that
  /// ask a program to end wait for it.
  void commit();

  /// A message with the names that the user knows in place of the staging folder's.
  [[nodiscard]] std::string in_final_names(std::string message) const;

  /// Calls what writes the result. Messages of its DataErrors are given the final names.
  template <class Write>
  auto fill(Write&& write) const {
    try {
      return std::forward<Write>(write)();
    } catch (const DataError& error) {
      throw DataError(in_final_names(error.what()));
    }
  }

 private:
  void check_final() const;
  void check_replaceable(const std::filesystem::path& folder) const;
  void refuse_if_within(const std::vector<std::filesystem::path>& inputs) const;
  void make_staging();
  void look_for_checkpoint(bool take_over);

  std::filesystem::path named_;  ///< as the user gave it
  std::filesystem::path final_;  ///< absolute, without links
  ResultKind kind_;
  bool replace_;
  bool within_;         ///< whether staging_ lies in final_
  std::string number_;  ///< of staging_
  std::filesystem::path staging_;
  std::unique_ptr<PathLock> lock_;  ///< on the staging folder, so that others can tell it from one left behind
  std::unique_ptr<Unfinished> unfinished_;
  bool had_checkpoint_ = false;
  bool is_kept_ = false;
};

}  // namespace dynamic_icp::formats
