// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/folder_search.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr int kSearchDepth = 3;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Links to folders are not: they may lead round in circles. Nor are hidden folders, such as that of a recording which
/// is being written, or was when its program was ended.
bool is_own_folder(const fs::directory_entry& entry) {
  std::error_code ignored;
  return is_visible_folder(entry) && !entry.is_symlink(ignored);
}

/// Calls for each entry until it is told to stop by `false`. A folder that is not there, or not ours to read, has none;
/// one that fails otherwise must not pass for another kind of input.
template <class Use>
void for_each_entry(const fs::path& folder, Use&& use) {
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault); !fault && entry != fs::directory_iterator();
       entry.increment(fault)) {
    if (!use(*entry)) {
      return;
    }
  }
  if (fault && fault != std::errc::no_such_file_or_directory && fault != std::errc::not_a_directory &&
      fault != std::errc::permission_denied) {
    throw DataError(fmt::format("{}: cannot read: {}", folder.string(), fault.message()));
  }
}

void search(const fs::path& folder, const std::function<bool(const fs::path&)>& wanted, int levels,
            std::vector<fs::path>& found) {
  if (wanted(folder)) {
    found.push_back(folder);
    return;
  }
  if (levels > 0) {
    for (const fs::path& below : entries_of(folder, is_own_folder)) {
      search(below, wanted, levels - 1, found);
    }
  }
}

}  // namespace

std::vector<fs::path> entries_of(const fs::path& folder, const std::function<bool(const fs::directory_entry&)>& test) {
  std::vector<fs::path> entries;
  for_each_entry(folder, [&](const fs::directory_entry& entry) {
    if (test(entry)) {
      entries.push_back(entry.path());
    }
    return true;
  });
  std::sort(entries.begin(), entries.end());
  return entries;
}

bool is_visible_folder(const fs::directory_entry& entry) {
  std::error_code ignored;
  return entry.path().filename().string().front() != '.' && entry.is_directory(ignored);
}

fs::path named_path(const fs::path& path) { return (fs::absolute(path) / ".").lexically_normal().parent_path(); }

bool same_name(const fs::path& path, std::string_view name) {
  const std::string own = path.filename().string();
  return std::equal(own.begin(), own.end(), name.begin(), name.end(),
                    [](char a, char b) { return lower(a) == lower(b); });
}

fs::path child(const fs::path& folder, std::string_view name) {
  const std::size_t slash = name.find('/');
  const std::string_view first = name.substr(0, slash);
  fs::path found = folder / first;
  std::error_code ignored;
  if (!fs::exists(found, ignored)) {
    const std::vector<fs::path> matches =
        entries_of(folder, [&](const fs::directory_entry& entry) { return same_name(entry.path(), first); });
    if (matches.empty()) {
      return {};
    }
    found = matches.front();
  }
  return slash == std::string_view::npos ? found : child(found, name.substr(slash + 1));
}

bool holds_files(const fs::path& folder, std::string_view extension) {
  bool found = false;
  for_each_entry(folder, [&](const fs::directory_entry& entry) {
    found = entry.path().extension() == extension && entry.path().filename().string().front() != '.';
    return !found;
  });
  return found;
}

fs::path find_folder(const fs::path& input, const std::function<bool(const fs::path&)>& wanted) {
  std::vector<fs::path> found;
  search(input, wanted, kSearchDepth, found);
  if (found.size() > 1) {
    std::string names;
    for (const fs::path& path : found) {
      names += "\n  " + path.string();
    }
    throw NotARecording(fmt::format("{}: holds several recordings, name one of them:{}", input.string(), names));
  }
  return found.empty() ? fs::path() : found.front();
}

}  // namespace dynamic_icp::datasets
