// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/number_list.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kMost = 100'000;  // of a range: nobody means more

}  // namespace

std::vector<std::size_t> number_list(const char* option, const std::string& text) {
  std::set<std::size_t> numbers;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view part = rest.substr(0, comma);
    const std::size_t dash = std::min(part.find('-'), part.size());
    const std::optional<std::size_t> first = parse_number<std::size_t>(part.substr(0, dash));
    const std::optional<std::size_t> last =
        dash < part.size() ? parse_number<std::size_t>(part.substr(dash + 1)) : first;
    if (!first || !last || *last < *first || *last - *first >= kMost || comma + 1 == rest.size()) {
      throw UsageError(fmt::format("{} is '{}', expected whole numbers and ranges of them: 10,20-25", option, text));
    }
    for (std::size_t number = *first; number <= *last; ++number) {
      numbers.insert(number);
    }
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return {numbers.begin(), numbers.end()};
}

}  // namespace dynamic_icp::apps
