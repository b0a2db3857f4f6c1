// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/numbered_files.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kUnixSecondsDigits = 10;
constexpr std::size_t kNanosecondDigits = 9;

/// A number without leading zeros, kept as text: time stamps in nanoseconds with a prefix may be longer than any
/// integer type.
std::string without_zeros(std::string_view digits) {
  const std::size_t nonzero = digits.find_first_not_of('0');
  return std::string(nonzero == std::string_view::npos ? digits.substr(0, 1) : digits.substr(nonzero));
}

using Numbers = std::vector<std::string>;

bool smaller_number(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

bool smaller(const Numbers& a, const Numbers& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), smaller_number);
}

struct NamedNumbers {
  fs::path file;
  Numbers all;
  Numbers key;  ///< those that it is ordered by
};

bool are_unique(std::vector<NamedNumbers>& names) {
  std::sort(names.begin(), names.end(), [](const NamedNumbers& a, const NamedNumbers& b) {
    return a.key == b.key ? a.file < b.file : smaller(a.key, b.key);
  });
  return std::adjacent_find(names.begin(), names.end(),
                            [](const NamedNumbers& a, const NamedNumbers& b) { return a.key == b.key; }) == names.end();
}

/// Seconds and the digits behind their point; nothing for names that do not end so.
std::optional<std::pair<std::string_view, std::string_view>> seconds_in(std::string_view stem) {
  const std::size_t point = stem.rfind('.');
  if (point == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view fraction = stem.substr(point + 1);
  const std::string_view whole = last_digits(stem.substr(0, point));
  const bool are_digits = !fraction.empty() && fraction.find_first_not_of(kDigits) == std::string_view::npos &&
                          !whole.empty() && stem.substr(0, point).ends_with(whole);
  const bool is_unix = whole.size() == kUnixSecondsDigits && whole.front() != '0';
  const bool is_simulated = fraction.size() == kNanosecondDigits && whole.size() <= kUnixSecondsDigits;
  return are_digits && (is_unix || is_simulated) ? std::optional(std::pair(whole, fraction)) : std::nullopt;
}

/// Whether all names say seconds; then they are the keys. Parts behind the point of several lengths are decimals, or
/// whole nanoseconds that were not padded (scan_stamps.hpp says which).
bool take_seconds(std::vector<NamedNumbers>& names) {
  std::size_t longest = 0;
  std::size_t shortest = std::string::npos;
  bool padded = false;
  for (NamedNumbers& name : names) {
    const std::string stem = name.file.stem().string();
    const auto seconds = seconds_in(stem);
    if (!seconds) {
      return false;
    }
    const auto& [whole, fraction] = *seconds;
    name.key = {without_zeros(whole), std::string(fraction)};
    longest = std::max(longest, fraction.size());
    shortest = std::min(shortest, fraction.size());
    padded = padded || (fraction.size() > 1 && fraction.front() == '0');
  }
  const bool are_decimals = shortest != longest && (padded || longest != kNanosecondDigits);
  for (NamedNumbers& name : names) {
    std::string& fraction = name.key.back();
    fraction = without_zeros(are_decimals ? fraction + std::string(longest - fraction.size(), '0') : fraction);
  }
  return !names.empty();
}

/// The only number that is not the same in all names; nothing when several differ or names have other counts of them.
std::optional<std::size_t> only_difference(const std::vector<NamedNumbers>& names) {
  std::set<std::size_t> differing;
  for (const NamedNumbers& name : names) {
    if (name.all.size() != names.front().all.size()) {
      return std::nullopt;
    }
    for (std::size_t k = 0; k < name.all.size(); ++k) {
      if (name.all[k] != names.front().all[k]) {
        differing.insert(k);
      }
    }
  }
  return differing.size() == 1 ? std::optional(*differing.begin()) : std::nullopt;
}

/// Text between the numbers: two names with the same are one name written in two ways.
std::string skeleton(const fs::path& file) {
  std::string text = file.stem().string();
  std::erase_if(text, [](char c) { return kDigits.find(c) != std::string_view::npos; });
  return text;
}

[[noreturn]] void refuse_duplicate(const std::vector<NamedNumbers>& names) {
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (names[i].key == names[i - 1].key) {
      throw DataError(fmt::format("{}: carries the same {} as {}", names[i].file.string(),
                                  names[i].key.back().size() > kNanosecondDigits ? "time stamp" : "number",
                                  names[i - 1].file.filename().string()));
    }
  }
  throw DataError("two files carry the same number");  // not reached: the caller found them
}

OrderedNames in_order(std::vector<NamedNumbers>& names, NameOrder order, std::size_t number = 0) {
  OrderedNames result;
  result.order = order;
  result.number = number;
  for (NamedNumbers& name : names) {
    result.files.push_back(std::move(name.file));
  }
  return result;
}

/// Whether no number differs, but the text does.
bool differ_by_text_alone(const std::vector<NamedNumbers>& names) {
  std::set<std::string> skeletons;
  for (const NamedNumbers& name : names) {
    if (name.all != names.front().all || !skeletons.insert(skeleton(name.file)).second) {
      return false;
    }
  }
  // Two files of one time are of two sensors, not of two times.
  return names.front().all.empty() || names.front().all.back().size() <= kNanosecondDigits;
}

}  // namespace

std::vector<std::string_view> digit_runs(std::string_view text) {
  std::vector<std::string_view> runs;
  for (std::size_t begin = text.find_first_of(kDigits); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(kDigits, begin), text.size());
    runs.push_back(text.substr(begin, end - begin));
    begin = text.find_first_of(kDigits, end);
  }
  return runs;
}

std::string_view last_digits(std::string_view text) {
  const std::vector<std::string_view> runs = digit_runs(text);
  return runs.empty() ? std::string_view() : runs.back();
}

OrderedNames order_names(std::vector<fs::path> files) {
  std::vector<NamedNumbers> names;
  for (fs::path& file : files) {
    const std::string stem = file.stem().string();
    Numbers all;
    for (const std::string_view digits : digit_runs(stem)) {
      all.push_back(without_zeros(digits));
    }
    names.push_back({std::move(file), std::move(all), {}});
  }
  if (take_seconds(names)) {
    if (!are_unique(names)) {
      refuse_duplicate(names);
    }
    return in_order(names, NameOrder::kSeconds);
  }
  const auto by = [&](const auto& key_of) {
    for (NamedNumbers& name : names) {
      name.key = key_of(name);
    }
    return are_unique(names);
  };
  const bool all_have_numbers =
      std::none_of(names.begin(), names.end(), [](const NamedNumbers& name) { return name.all.empty(); });
  if (all_have_numbers) {
    if (by([](const NamedNumbers& name) { return Numbers{name.all.back()}; })) {
      return in_order(names, NameOrder::kLastNumber);
    }
    if (by([](const NamedNumbers& name) { return name.all; })) {
      const std::optional<std::size_t> one = only_difference(names);
      return in_order(names, one ? NameOrder::kOneNumber : NameOrder::kAllNumbers, one.value_or(0));
    }
    if (!differ_by_text_alone(names)) {
      refuse_duplicate(names);
    }
  }
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
  return in_order(names, NameOrder::kText);
}

std::vector<fs::path> files_ending_with(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> numbered;
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : formats::entries_in(folder)) {
    const fs::path& path = entry.path();
    const std::string name = path.filename().string();
    if (name.ends_with(ending) && name.front() != '.') {
      (last_digits(path.stem().string()).empty() ? others : numbered).push_back(path);
    }
  }
  return numbered.empty() ? others : numbered;
}

std::vector<fs::path> numbered_files(const fs::path& folder, std::string_view ending) {
  return order_names(files_ending_with(folder, ending)).files;
}

}  // namespace dynamic_icp::datasets
