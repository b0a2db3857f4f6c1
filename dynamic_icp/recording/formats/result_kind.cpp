// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/result_kind.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"
#include "dynamic_icp/recording/formats/staged_names.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Also what was left of writing such a file.
constexpr std::string_view kPartial = ".partial-#";

bool matches_exactly(std::string_view name, std::string_view pattern) {
  std::size_t at = 0;
  for (const char expected : pattern) {
    if (at == name.size() || (expected == '#' ? !is_digit(name[at]) : name[at] != expected)) {
      return false;
    }
    ++at;
    while (expected == '#' && at < name.size() && is_digit(name[at])) {
      ++at;
    }
  }
  return at == name.size();
}

bool is_part(const fs::directory_entry& entry, const std::string& name, const std::vector<std::string>& patterns) {
  const fs::file_type type = entry.symlink_status().type();
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    if (type == fs::file_type::regular) {
      return matches(name, pattern);
    }
    const std::size_t folders = static_cast<std::size_t>(std::count(name.begin(), name.end(), '/')) + 1;
    std::size_t end = 0;
    for (std::size_t i = 0; i < folders && end != std::string::npos; ++i) {
      end = pattern.find('/', i == 0 ? 0 : end + 1);
    }
    return type == fs::file_type::directory && end != std::string::npos &&
           matches_exactly(name, pattern.substr(0, end));
  });
}

/// Looks into the folders that results have, and no others.
std::optional<fs::path> foreign_below(const fs::path& folder, const fs::path& result,
                                      const std::vector<std::string>& patterns) {
  for (const fs::directory_entry& entry : entries_in(folder)) {
    if (folder == result && is_staged_within(entry.path().filename().string())) {
      continue;
    }
    if (!is_part(entry, entry.path().lexically_relative(result).generic_string(), patterns)) {
      return entry.path();
    }
    if (entry.symlink_status().type() == fs::file_type::directory) {
      if (const auto foreign = foreign_below(entry.path(), result, patterns)) {
        return foreign;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

bool matches(std::string_view name, std::string_view pattern) {
  return matches_exactly(name, pattern) || matches_exactly(name, std::string(pattern) + std::string(kPartial));
}

std::optional<fs::path> foreign_entry(const fs::path& folder, const ResultKind& kind) {
  try {
    return foreign_below(folder, folder, kind.files(folder));
  } catch (const fs::filesystem_error& error) {
    throw DataError(fmt::format("{}: cannot read: {}", error.path1().string(), error.code().message()));
  }
}

}  // namespace dynamic_icp::formats
