// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::apps {

/// Key and value of "key=value", blanks around both trimmed. Throws UsageError where there is no "=".
std::pair<std::string, std::string> split_setting(const std::string& setting);

/// Carries out the options --set key=value in their order. Throws UsageError naming the key and the valid range.
void apply_settings(const ConfigFields& fields, const std::vector<std::string>& settings);

}  // namespace dynamic_icp::apps
