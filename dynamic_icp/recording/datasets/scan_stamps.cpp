// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestIndex = 9;  // digits
constexpr std::size_t kDecimals = 9;
constexpr std::size_t kUnixDigits = 19;
// Half of the range of 64 bits, so that the difference of any two stamps fits as well.
constexpr std::int64_t kMaxStampNs = std::numeric_limits<std::int64_t>::max() / 2;

/// What a name says of the time.
struct NamedTime {
  fs::path file;
  std::string whole;     ///< the digits before the point of "seconds.fraction", else the last run of digits
  std::string fraction;  ///< those after it; empty: none
};

/// The digits that tell the time or the index, by what tells the names apart; empty: none do.
std::string_view telling_digits(std::string_view stem, const OrderedNames& names) {
  const std::vector<std::string_view> runs = digit_runs(stem);
  switch (names.order) {
    case NameOrder::kSeconds:
    case NameOrder::kLastNumber:
      return runs.empty() ? std::string_view() : runs.back();
    case NameOrder::kOneNumber:
      return runs[names.number];
    case NameOrder::kAllNumbers:
    case NameOrder::kText:
      break;
  }
  return {};
}

NamedTime time_in(const fs::path& file, const OrderedNames& names) {
  const std::string stem = file.stem().string();
  const std::string_view digits = telling_digits(stem, names);
  if (names.order == NameOrder::kSeconds) {
    const std::string_view before = std::string_view(stem).substr(0, stem.size() - digits.size() - 1);
    return {file, std::string(last_digits(before)), std::string(digits)};
  }
  // Zeros in front are those of an index, however many; but 19 digits are nanoseconds, also soon after time 0.
  const bool counts_ns = digits.size() == kUnixDigits;
  const std::size_t nonzero =
      counts_ns || digits.empty() ? 0 : std::min(digits.find_first_not_of('0'), digits.size() - 1);
  return {file, std::string(digits.substr(nonzero)), {}};
}

bool is_index(const NamedTime& named) { return named.fraction.empty() && named.whole.size() <= kLongestIndex; }

/// Names of one kind can be compared: indices, or times of one unit.
bool same_kind(const NamedTime& a, const NamedTime& b) {
  if (!a.fraction.empty() && !b.fraction.empty()) {
    return true;  // seconds, of simulated time too
  }
  return is_index(a) || is_index(b) ? is_index(a) == is_index(b)
                                    : a.whole.size() == b.whole.size() && a.fraction.empty() == b.fraction.empty();
}

/// The index, or Unix time in ns.
Stamp whole_stamp(const NamedTime& named) {
  if (!named.fraction.empty()) {
    return parse_seconds(named.whole).value_or(Stamp{});
  }
  if (is_index(named)) {
    Stamp index;
    std::from_chars(named.whole.data(), named.whole.data() + named.whole.size(), index.ns);
    return index;
  }
  if (named.whole.size() == kUnixDigits && named.whole.front() == '0') {
    Stamp soon;
    std::from_chars(named.whole.data(), named.whole.data() + named.whole.size(), soon.ns);
    return soon;
  }
  const std::optional<Stamp> stamp = parse_unix_time(named.whole);
  if (!stamp || stamp->ns > kMaxStampNs) {
    throw DataError(
        fmt::format("{}: the number in its name has {} digits, expected an index of up to {} digits or Unix time of 10 "
                    "(s), 13 (ms), 16 (us) or 19 (ns)",
                    named.file.string(), named.whole.size(), kLongestIndex));
  }
  return *stamp;
}

/// The part of a second that a name says. Where the parts of a folder differ in length they are either decimals without
/// the zeros at the end, or whole nanoseconds without those in front.
Stamp stamp_of(const NamedTime& named, bool fractions_are_nanoseconds) {
  Stamp stamp = whole_stamp(named);
  if (!named.fraction.empty()) {
    const std::string& digits = named.fraction;
    const std::string padded = fractions_are_nanoseconds && digits.size() < kDecimals
                                   ? std::string(kDecimals - digits.size(), '0') + digits
                                   : digits;
    stamp.ns += parse_seconds("0." + padded).value_or(Stamp{}).ns;
  }
  return stamp;
}

/// Whether the parts after the point differ in length, and none but 0 begins with 0 though they are many: whole
/// nanoseconds that were not padded.
bool counts_nanoseconds(const std::vector<NamedTime>& times, std::vector<std::string>& assumptions) {
  const auto [shortest, longest] = std::minmax_element(
      times.begin(), times.end(), [](const auto& a, const auto& b) { return a.fraction.size() < b.fraction.size(); });
  if (shortest->fraction.size() == longest->fraction.size()) {
    return false;
  }
  const bool padded = std::any_of(times.begin(), times.end(), [](const NamedTime& named) {
    return named.fraction.size() > 1 && named.fraction.front() == '0';
  });
  const bool nanoseconds = !padded && longest->fraction.size() == kDecimals;
  assumptions.push_back(fmt::format("the names of the scans have {} to {} digits after the point: taken as {}",
                                    shortest->fraction.size(), longest->fraction.size(),
                                    nanoseconds ? "whole nanoseconds" : "decimals of a second"));
  return nanoseconds;
}

/// What the names say, in their order. Throws DataError where they are of several kinds.
std::vector<NamedTime> times_in(const OrderedNames& names) {
  std::vector<NamedTime> times;
  for (const fs::path& file : names.files) {
    times.push_back(time_in(file, names));
  }
  // An order that does not depend on that of the folder, for messages.
  std::sort(times.begin(), times.end(), [](const NamedTime& a, const NamedTime& b) { return a.file < b.file; });
  for (const NamedTime& named : times) {
    if (!same_kind(named, times.front())) {
      throw DataError(
          fmt::format("{}: its name is another kind of number than that of {}, expected indices or time "
                      "stamps of one unit for all scans",
                      named.file.string(), times.front().file.filename().string()));
    }
  }
  return times;
}

/// Scans that are a period apart, in the order of their names.
StampedFiles counted_files(OrderedNames names, double period_s) {
  StampedFiles result;
  result.are_indices = true;
  for (std::size_t i = 0; i < names.files.size(); ++i) {
    result.stamps.push_back(Stamp{std::llround(1e9 * period_s * static_cast<double>(i))});
  }
  result.files = std::move(names.files);
  if (result.files.size() > 1) {
    result.assumptions.push_back(fmt::format("{} the names of the scans, {} first: a scan period of {} s is assumed",
                                             names.order == NameOrder::kText
                                                 ? "no number tells the scans apart: they are in the order of"
                                                 : "several numbers together are the order of",
                                             result.files.front().filename().string(), period_s));
  }
  return result;
}

/// What is assumed of the period of scans whose names are indices.
std::string period_sentence(const std::vector<Stamp>& indices, double period_s) {
  std::string sentence =
      fmt::format("the names of the scans are numbers, not times: a scan period of {} s is assumed", period_s);
  std::int64_t step = 0;
  for (std::size_t i = 1; i < indices.size(); ++i) {
    step = std::gcd(step, indices[i].ns - indices[i - 1].ns);
  }
  if (indices.size() > 2 && step > 1) {
    sentence +=
        fmt::format(" for each number; they go up in steps of {}: if no scans are missing, state a period of {:.6g} s",
                    step, period_s / static_cast<double>(step));
  }
  return sentence;
}

}  // namespace

StampedFiles stamped_files(const fs::path& folder, std::string_view extension, double period_s) {
  const std::vector<fs::path> files = files_ending_with(folder, extension);
  if (files.empty()) {
    throw DataError(fmt::format("{}: holds no scans, expected files *{} with numbers or time stamps as names",
                                folder.string(), extension));
  }
  return stamped_files(files, period_s);
}

StampedFiles stamped_files(const std::vector<fs::path>& files, double period_s) {
  OrderedNames names = order_names(files);
  if (names.order == NameOrder::kAllNumbers || names.order == NameOrder::kText) {
    return counted_files(std::move(names), period_s);
  }
  std::vector<NamedTime> times = times_in(names);
  StampedFiles result;
  std::vector<std::pair<Stamp, fs::path>> scans;
  const bool indices = is_index(times.front());
  result.are_indices = indices;
  const bool nanoseconds = !indices && counts_nanoseconds(times, result.assumptions);
  for (NamedTime& named : times) {
    const Stamp stamp = stamp_of(named, nanoseconds);
    scans.emplace_back(stamp, std::move(named.file));
  }
  std::sort(scans.begin(), scans.end());
  for (std::size_t i = 1; i < scans.size(); ++i) {
    if (scans[i].first == scans[i - 1].first) {
      throw DataError(fmt::format("{}: carries the same {} as {}", scans[i].second.string(),
                                  indices ? "number" : "time stamp", scans[i - 1].second.filename().string()));
    }
  }
  for (auto& [stamp, file] : scans) {
    result.stamps.push_back(stamp);
    result.files.push_back(std::move(file));
  }
  if (indices) {
    result.assumptions.push_back(period_sentence(result.stamps, period_s));
    const std::int64_t first = result.stamps.front().ns;
    for (Stamp& stamp : result.stamps) {
      stamp.ns = std::llround(1e9 * period_s * static_cast<double>(stamp.ns - first));
    }
  }
  return result;
}

}  // namespace dynamic_icp::datasets
