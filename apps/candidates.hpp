// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/tools/benchmark/cell_plan.hpp"

namespace dynamic_icp::apps {

/// A method with nothing or one part switched off.
struct Candidate {
  std::string method;
  std::string ablation;
  std::vector<std::string> settings;       ///< key=value, what differs from the preset and has an effect on it
  std::vector<std::string> configuration;  ///< resolved, key=value
};

std::vector<std::string> known_methods();

/// Without "none".
std::vector<std::string> known_ablations();

/// What a benchmark compares. The lists are names with commas, or "all"; "none" switches nothing off. Throws UsageError
/// for an unknown name, for ablations without the method they are about, and as `make_config` does; a key must have an
/// effect on one of the methods.
std::vector<Candidate> choose_candidates(const std::string& method_list, const std::string& ablation_list,
                                         const benchmark::RunSettings& settings);

}  // namespace dynamic_icp::apps
