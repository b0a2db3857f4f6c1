// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/nearest_key.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace dynamic_icp {
namespace {

/// Letters to insert, to delete, to replace, or neighbours to exchange: the optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        rows[i][j] = i + j;
        continue;
      }
      rows[i][j] =
          std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
      }
    }
  }
  return rows[a.size()][b.size()];
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return small;
}

/// Letters to change, twice; a part of a key is nearer than one with a single letter to change.
std::size_t key_distance(std::string_view typed_as_is, std::string_view key_as_is) {
  constexpr std::size_t kFewest = 3;     // letters that say something
  constexpr std::size_t kLongest = 100;  // no key is longer, and what has megabytes would take minutes
  const std::string typed = in_small_letters(typed_as_is.substr(0, kLongest));
  const std::string key = in_small_letters(key_as_is);
  const std::string_view last = std::string_view(key).substr(key.rfind('.') + 1);  // npos + 1 is 0
  const std::size_t changes = 2 * std::min(edit_distance(typed, key), edit_distance(typed, last));
  return typed.size() >= kFewest && key.find(typed) != std::string::npos ? std::min<std::size_t>(changes, 1) : changes;
}

}  // namespace

std::string_view nearest_key(std::string_view typed, std::span<const std::string> keys) {
  std::string_view nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& key : keys) {
    const std::size_t distance = key_distance(typed, key);
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
