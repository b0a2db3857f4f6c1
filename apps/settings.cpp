// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/settings.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::apps {

namespace {

std::string trimmed(const std::string& text) {
  constexpr const char* kBlanks = " \t";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace

std::pair<std::string, std::string> split_setting(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    throw UsageError(fmt::format("--set '{}': expected key=value", setting));
  }
  return {trimmed(setting.substr(0, equals)), trimmed(setting.substr(equals + 1))};
}

void apply_settings(const ConfigFields& fields, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const auto& [key, value] = split_setting(setting);
    set_field(fields, key, value);
  }
}

}  // namespace dynamic_icp::apps
