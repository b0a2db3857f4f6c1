// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/datasets/scan_stamps.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/base/parse_number.hpp"

namespace dynamic_icp::datasets {
namespace {

std::optional<Stamp> stamp_in(const std::string& stem) {
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) {
    return std::nullopt;
  }
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  const std::string digits = stem.substr(first, last - first + 1);
  const std::optional<std::int64_t> number = parse_number<std::int64_t>(digits);
  const std::int64_t unit = digits.size() == 19   ? 1
                            : digits.size() == 16 ? 1'000
                            : digits.size() == 13 ? 1'000'000
                            : digits.size() == 10 ? 1'000'000'000
                                                  : 0;
  const bool fits = number && unit != 0 && *number <= std::numeric_limits<std::int64_t>::max() / unit;
  return fits ? std::optional(Stamp{*number * unit}) : std::nullopt;
}

}  // namespace

std::vector<Stamp> stamps_of(const std::vector<std::filesystem::path>& files, double period_s,
                             std::vector<std::string>& assumptions) {
  std::vector<Stamp> stamps;
  for (const std::filesystem::path& file : files) {
    if (const std::optional<Stamp> stamp = stamp_in(file.stem().string())) {
      stamps.push_back(*stamp);
    }
  }
  if (stamps.size() == files.size()) {
    return stamps;
  }
  stamps.clear();
  const std::int64_t period_ns = std::llround(1e9 * period_s);
  for (std::size_t i = 0; i < files.size(); ++i) {
    stamps.push_back(Stamp{static_cast<std::int64_t>(i) * period_ns});
  }
  assumptions.push_back(fmt::format("the names of the scans are no times: a scan period of {} s is assumed", period_s));
  return stamps;
}

}  // namespace dynamic_icp::datasets
