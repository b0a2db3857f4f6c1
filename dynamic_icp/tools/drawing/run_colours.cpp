// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/run_colours.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

namespace dynamic_icp::drawing {
namespace {

struct MethodColour {
  std::string_view method;
  std::size_t place;
};

constexpr MethodColour kMethods[] = {{"dynamic-icp", 0}, {"doppler-icp", 1},    {"gicp", 2},
                                     {"kiss-icp", 3},    {"point-to-point", 4}, {"point-to-plane", 6}};

/// Whether a name is that of a variant of the method: "kiss-icp, 0.5 m", not "kiss-icp2".
bool begins_with_method(std::string_view name, std::string_view method) {
  return name.starts_with(method) && (name.size() == method.size() || name[method.size()] == ',' ||
                                      name[method.size()] == ' ' || name[method.size()] == ':');
}

}  // namespace

std::vector<std::size_t> colours_of_runs(const std::vector<std::string>& names) {
  std::vector<std::optional<std::size_t>> places(names.size());
  std::set<std::size_t> taken;
  // The method itself before its variants, of which but one can have its colour.
  const auto give = [&](const auto& fits) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto* known = std::find_if(std::begin(kMethods), std::end(kMethods),
                                       [&](const MethodColour& entry) { return fits(names[k], entry.method); });
      if (!places[k] && known != std::end(kMethods) && taken.insert(known->place).second) {
        places[k] = known->place;
      }
    }
  };
  give([](std::string_view name, std::string_view method) { return name == method; });
  give(begins_with_method);
  // Where methods are drawn their colours stay theirs, also those of methods that are not there.
  const bool has_methods = !taken.empty();
  for (const MethodColour& entry : kMethods) {
    if (has_methods) {
      taken.insert(entry.place);
    }
  }
  std::vector<std::size_t> colours;
  std::size_t next = 0;
  for (const std::optional<std::size_t>& place : places) {
    while (!place && taken.contains(next)) {
      ++next;
    }
    colours.push_back(place ? *place : next++);
  }
  return colours;
}

}  // namespace dynamic_icp::drawing
