// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

namespace dynamic_icp::python {

/// Names and values as text.
using Texts = std::vector<std::pair<std::string, std::string>>;

/// A pipeline as Python asks for it.
struct MethodTexts {
  std::string method;
  std::string preset;
  std::string ablation;
  Texts settings;  ///< configuration keys
};

/// The configuration that is meant. Throws UsageError naming what cannot be.
odometry::Config config_of(const MethodTexts& method);

/// Throws UsageError as datasets::set does, in the words of Python.
datasets::InputSettings input_settings_of(const Texts& texts);

/// The keyword arguments of dynamic_icp.open that state these settings, e.g. "doppler_sign='towards'".
std::string as_keywords(const Texts& settings);

/// The same of what corrects a finding about an input that was opened with `settings`.
std::string fix_in_words(const diagnosis::Finding& finding, const datasets::InputSettings& settings);

}  // namespace dynamic_icp::python
