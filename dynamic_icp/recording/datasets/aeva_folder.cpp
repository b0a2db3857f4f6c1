// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/aeva_folder.hpp"

#include <algorithm>
#include <system_error>

#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr Stamp kStartOf2024{1'704'067'200'000'000'000};

bool holds_aeva(const fs::path& folder) {
  const fs::path scans = child(folder, "LiDAR/Aeva");
  return !scans.empty() && holds_files(scans, ".bin");
}

}  // namespace

fs::path find_aeva_folder(const fs::path& input) {
  const fs::path whole = named_path(input);
  const fs::path above = same_name(whole, "Aeva") ? whole.parent_path() : whole;
  if (same_name(above, "LiDAR") && holds_aeva(above.parent_path())) {
    return above.parent_path();
  }
  return find_folder(input, holds_aeva);
}

bool is_hercules(const fs::path& folder) {
  return !find_part(folder, "PR_GT").empty() || !find_part(folder, "Radar").empty() ||
         stamped_files(child(folder, "LiDAR/Aeva"), ".bin", 0.1).stamps.front() >= kStartOf2024;
}

fs::path find_part(const fs::path& folder, std::string_view name) {
  fs::path found = child(folder, name);
  if (!found.empty()) {
    return found;
  }
  const fs::path above = named_path(folder).parent_path();
  found = child(above, name);
  if (!found.empty()) {
    return found;
  }
  std::vector<fs::path> beside;
  std::error_code fault;
  for (fs::directory_iterator entry(above, fault); !fault && entry != fs::directory_iterator();
       entry.increment(fault)) {
    beside.push_back(entry->path());
  }
  std::sort(beside.begin(), beside.end());
  for (const fs::path& part : beside) {
    found = fs::is_directory(part, fault) && !holds_aeva(part) ? child(part, name) : fs::path();
    if (!found.empty()) {
      return found;
    }
  }
  return {};
}

}  // namespace dynamic_icp::datasets
