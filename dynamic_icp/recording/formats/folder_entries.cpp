// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/folder_entries.hpp"

#include <system_error>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {

std::vector<std::filesystem::directory_entry> entries_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::directory_entry> entries;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(folder, fault);
       !fault && entry != std::filesystem::directory_iterator(); entry.increment(fault)) {
    entries.push_back(*entry);
  }
  if (fault) {
    throw DataError(fmt::format("{}: cannot read the folder: {}", folder.string(), fault.message()));
  }
  return entries;
}

}  // namespace dynamic_icp::formats
