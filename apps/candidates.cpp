// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/candidates.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"

#include "apps/method_options.hpp"

namespace dynamic_icp::apps {
namespace {

/// The names of a list with commas, in the order in which they are known; "all" for all, "none" for none where there
/// may be none.
std::vector<std::string> chosen_names(const std::string& option, const std::string& list,
                                      const std::vector<std::string>& known, bool none_allowed) {
  if (list == "all") {
    return known;
  }
  std::vector<std::string> wanted;
  std::istringstream names(list);
  for (std::string name; std::getline(names, name, ',');) {
    const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
    if (!is_known && !(none_allowed && name == "none")) {
      throw UsageError(fmt::format("{}: unknown name '{}'{}; known are: all, {}{}", option, name,
                                   did_you_mean(name, known), none_allowed ? "none, " : "", fmt::join(known, ", ")));
    }
    wanted.push_back(name);
  }
  if (wanted.empty()) {
    throw UsageError(fmt::format("{}: no name given; known are: all, {}", option, fmt::join(known, ", ")));
  }
  std::vector<std::string> chosen;
  std::copy_if(known.begin(), known.end(), std::back_inserter(chosen),
               [&](const std::string& name) { return std::find(wanted.begin(), wanted.end(), name) != wanted.end(); });
  return chosen;
}

std::vector<std::string> without_none(const std::vector<std::string_view>& names) {
  std::vector<std::string> parts(names.begin(), names.end());
  std::erase(parts, "none");
  return parts;
}

MethodOptions method_options(const benchmark::RunSettings& settings, const std::string& method = "dynamic-icp",
                             const std::string& ablation = "none") {
  MethodOptions options;
  options.method = method;
  options.ablation = ablation;
  options.preset = settings.preset;
  options.config_file = settings.config_file;
  options.settings = settings.settings;
  return options;
}

std::vector<std::string> texts(const ConfigFields& fields) {
  std::vector<std::string> result;
  for (const ConfigField& field : fields) {
    result.push_back(field.key + "=" + value_text(field));
  }
  return result;
}

Candidate candidate(const benchmark::RunSettings& settings, const std::string& method, const std::string& ablation) {
  odometry::Config config = resolve_config(method_options(settings, method, ablation)).config;
  odometry::Config whole = resolve_config(method_options(settings, method)).config;
  odometry::Config plain = odometry::configuration(method, settings.preset);
  const std::vector<std::string> usual = texts(odometry::fields(plain));
  std::vector<std::string> changed = texts(odometry::fields(whole));
  std::erase_if(changed, [&](const std::string& text) { return std::ranges::find(usual, text) != usual.end(); });
  return {method, ablation, changed, texts(odometry::fields(config))};
}

}  // namespace

std::vector<std::string> known_methods() {
  const auto names = odometry::method_names();
  return {names.begin(), names.end()};
}

std::vector<std::string> known_ablations() { return without_none(odometry::ablation_names()); }

std::vector<Candidate> choose_candidates(const std::string& method_list, const std::string& ablation_list,
                                         const benchmark::RunSettings& settings) {
  const std::vector<std::string> methods = chosen_names("--methods", method_list, known_methods(), false);
  const std::vector<std::string> parts =
      ablation_list == "all" ? without_none(odometry::ablation_names(resolve_config(method_options(settings)).config))
                             : chosen_names("--ablations", ablation_list, known_ablations(), true);
  if (ablation_list != "all" && !parts.empty() &&
      std::find(methods.begin(), methods.end(), benchmark::kOurMethod) == methods.end()) {
    throw UsageError(fmt::format("--ablations is about {}, which is not among --methods", benchmark::kOurMethod));
  }
  std::vector<ResolvedConfig> resolved;
  for (const std::string& method : methods) {
    resolved.push_back(resolve_config(method_options(settings, method)));
  }
  refuse_unread_keys(method_options(settings), methods, resolved);
  std::vector<Candidate> all;
  for (const std::string& method : methods) {
    all.push_back(candidate(settings, method, "none"));
    for (const std::string& part : method == benchmark::kOurMethod ? parts : std::vector<std::string>()) {
      all.push_back(candidate(settings, method, part));
    }
  }
  return all;
}

}  // namespace dynamic_icp::apps
