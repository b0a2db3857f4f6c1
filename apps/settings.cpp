// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/settings.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::apps {

void apply_settings(const ConfigFields& fields, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw UsageError(fmt::format("--set '{}': expected key=value", setting));
    }
    set_field(fields, setting.substr(0, equals), setting.substr(equals + 1));
  }
}

}  // namespace dynamic_icp::apps
