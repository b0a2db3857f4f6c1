// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "dynamic_icp/recording/evaluation/evaluation.hpp"

namespace dynamic_icp::evaluation {

/// Where the two trajectories came from, for the report.
struct EvaluationSource {
  std::string estimate;
  std::string reference;
  std::size_t estimate_repeated_lines = 0;  ///< see formats::TumFile
  std::size_t reference_repeated_lines = 0;
};

/// The evaluation as a table to read, with what each number means and warnings where numbers mean little. Ends with a
/// line break.
std::string evaluation_table(const Evaluation& evaluation, const EvaluationSource& source);

/// The evaluation as one JSON object with every number; null where a number cannot be told. `docs/evaluation.md`
/// describes the keys. Ends with a line break.
std::string evaluation_json(const Evaluation& evaluation, const EvaluationSource& source);

/// The name an alignment has on the command line: none, first, se3, sim3.
const char* alignment_name(Alignment alignment);

}  // namespace dynamic_icp::evaluation
