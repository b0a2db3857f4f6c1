// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/nearest_key.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace dynamic_icp {
namespace {

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

/// Letters to insert, to delete, to replace, or neighbours to exchange: the optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // of the letters of `a` so far to all beginnings of `b`
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::vector<std::size_t> above = row;
  std::vector<std::size_t> second_above = row;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    second_above.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], second_above[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

/// No fewer than these: letters of one that the other has not, wherever they stand.
std::size_t least_edits(std::string_view a, std::string_view b) {
  std::array<std::size_t, 256> letters = {};
  for (const char c : b) {
    ++letters[static_cast<unsigned char>(c)];
  }
  std::size_t only_in_a = 0;
  for (const char c : a) {
    std::size_t& left = letters[static_cast<unsigned char>(c)];
    only_in_a += left == 0 ? 1 : 0;
    left -= left == 0 ? 0 : 1;
  }
  return std::max(only_in_a, b.size() + only_in_a - a.size());  // the latter only in b
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return small;
}

/// Letters to change, twice; a part of a key is nearer than one with a single letter to change. Where these are `limit`
/// or more, any number that is.
std::size_t key_distance(std::string_view typed_as_is, std::string_view key_as_is, std::size_t limit = kAny) {
  constexpr std::size_t kFewest = 3;     // letters that say something
  constexpr std::size_t kLongest = 100;  // no key is longer, and what has megabytes would take minutes
  const std::string typed = in_small_letters(typed_as_is.substr(0, kLongest));
  const std::string key = in_small_letters(key_as_is);
  const std::string_view last = std::string_view(key).substr(key.rfind('.') + 1);  // npos + 1 is 0
  const bool is_part = typed.size() >= kFewest && key.find(typed) != std::string::npos;
  std::size_t changes = 2 * std::min(least_edits(typed, key), least_edits(typed, last));
  if (changes < limit) {
    changes = 2 * edit_distance(typed, key);
    if (last.size() < key.size() && 2 * least_edits(typed, last) < changes) {
      changes = std::min(changes, 2 * edit_distance(typed, last));
    }
  }
  return is_part ? std::min<std::size_t>(changes, 1) : changes;
}

}  // namespace

std::string_view nearest_key(std::string_view typed, std::span<const std::string> keys) {
  std::string_view nearest;
  std::size_t least = kAny;
  for (const std::string& key : keys) {
    const std::size_t distance = key_distance(typed, key, least);
    if (distance < least) {
      least = distance;
      nearest = key;
    }
  }
  return nearest;
}

std::string_view close_key(std::string_view typed, std::span<const std::string> keys) {
  const std::string_view nearest = nearest_key(typed, keys);
  return !nearest.empty() && key_distance(typed, nearest) <= 2 * ((nearest.size() + 2) / 3) ? nearest
                                                                                            : std::string_view();
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> keys) {
  const std::string_view key = close_key(typed, keys);
  return key.empty() ? "" : fmt::format(" (did you mean '{}'?)", key);
}

}  // namespace dynamic_icp
