// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/numbered_files.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

/// The last run of digits in a name, without leading zeros; empty when there is none. Kept as text: time stamps in
/// nanoseconds with a prefix may be longer than any integer type.
std::string number_in(const std::string& stem) {
  const std::string_view digits = last_digits(stem);
  const std::size_t nonzero = digits.find_first_not_of('0');
  return std::string(nonzero == std::string_view::npos ? digits.substr(0, 1) : digits.substr(nonzero));
}

bool smaller_number(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

}  // namespace

std::string_view last_digits(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t last = text.find_last_of(kDigits);
  if (last == std::string_view::npos) {
    return {};
  }
  const std::size_t before = text.find_last_not_of(kDigits, last);
  const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
  return text.substr(first, last - first + 1);
}

std::vector<fs::path> numbered_files(const fs::path& folder, std::string_view ending) {
  std::error_code fault;
  std::vector<std::pair<std::string, fs::path>> numbered;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const fs::path& path = entry.path();
    const std::string name = path.filename().string();
    if (name.ends_with(ending) && name.front() != '.') {
      std::string number = number_in(path.stem().string());
      if (!number.empty()) {
        numbered.emplace_back(std::move(number), path);
      }
    }
  }
  if (fault) {
    throw DataError(fmt::format("{}: cannot read the folder: {}", folder.string(), fault.message()));
  }
  std::sort(numbered.begin(), numbered.end(), [](const auto& a, const auto& b) {
    return a.first == b.first ? a.second < b.second : smaller_number(a.first, b.first);
  });
  std::vector<fs::path> files;
  for (std::size_t i = 0; i < numbered.size(); ++i) {
    if (i > 0 && numbered[i].first == numbered[i - 1].first) {
      throw DataError(fmt::format("{}: carries the same number as {}", numbered[i].second.string(),
                                  files.back().filename().string()));
    }
    files.push_back(std::move(numbered[i].second));
  }
  return files;
}

}  // namespace dynamic_icp::datasets
