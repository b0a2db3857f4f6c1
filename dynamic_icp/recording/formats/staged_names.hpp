// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::formats {

/// What a temporary folder of output_folder.hpp holds.
enum class Staged {
  kPartial,   ///< a result being written
  kArriving,  ///< a whole result on its way into place
  kReplaced,  ///< an earlier result that makes room
};

/// The names of the temporary folders for one result: beside its folder, or within it.
class StagedNames {
 public:
  static StagedNames beside(const std::filesystem::path& folder);
  static StagedNames within(const std::filesystem::path& folder);

  /// `number` tells the writers from each other.
  [[nodiscard]] std::filesystem::path path(Staged state, const std::string& number) const;

  struct Found {
    std::filesystem::path path;
    Staged state;
    std::string number;
  };
  /// Those that are there.
  [[nodiscard]] std::vector<Found> found() const;

 private:
  StagedNames(std::filesystem::path folder, std::string prefix);

  std::filesystem::path folder_;
  std::string prefix_;
};

/// The folders in this one that have the name of a partial result beside its folder, whatever the name of that is.
std::vector<std::filesystem::path> partial_folders(const std::filesystem::path& folder);

/// Whether an entry of a folder is one of its temporary folders within.
bool is_staged_within(std::string_view name);

}  // namespace dynamic_icp::formats
