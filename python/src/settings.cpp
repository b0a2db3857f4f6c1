// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/settings.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::python {
namespace {

/// The keyword of a setting: "doppler-sign" is doppler_sign.
std::string keyword(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace

odometry::Config config_of(const MethodTexts& method) {
  odometry::Config config = odometry::configuration(method.method, method.preset);
  const ConfigFields fields = odometry::fields(config);
  for (const auto& [key, value] : method.settings) {
    set_field(fields, key, value);
  }
  odometry::apply_ablation(config, method.ablation);
  odometry::check(config);
  return config;
}

datasets::InputSettings input_settings_of(const Texts& texts) {
  datasets::InputSettings settings;
  for (const auto& [name, text] : texts) {
    try {
      datasets::set(settings, name, text);
    } catch (const UsageError& error) {
      throw UsageError(keyword(name) + std::string(error.what()).substr(name.size()));  // begins with the name
    }
  }
  return settings;
}

std::string as_keywords(const Texts& settings) {
  std::vector<std::string> words;
  std::map<std::string, std::vector<std::string>> gathered;  // "topic.1", "field.doppler": parts of one argument
  for (const auto& [name, text] : settings) {
    const std::size_t point = name.find('.');
    if (point == std::string::npos) {
      words.push_back(fmt::format("{}='{}'", keyword(name), text));
    } else if (name.starts_with("field.")) {
      gathered["field"].push_back(fmt::format("'{}': '{}'", name.substr(point + 1), text));
    } else {
      gathered[name.substr(0, point)].push_back(fmt::format("'{}'", text));
    }
  }
  for (const auto& [name, parts] : gathered) {
    const bool is_mapping = name == "field";
    words.push_back(
        fmt::format("{}={}{}{}", name, is_mapping ? "{" : "[", fmt::join(parts, ", "), is_mapping ? "}" : "]"));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string fix_in_words(const diagnosis::Finding& finding, const datasets::InputSettings& settings) {
  return as_keywords(finding.needs_doppler_column ? datasets::texts_of_doppler(finding.doppler_column, settings)
                                                  : datasets::texts_of_fix(finding.fix, settings));
}

}  // namespace dynamic_icp::python
