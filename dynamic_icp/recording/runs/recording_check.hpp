// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"
#include "dynamic_icp/recording/diagnosis/sweep_search.hpp"

namespace dynamic_icp::runs {

/// What the diagnosis of a recording says.
struct RecordingCheck {
  double period_s = 0.0;                        ///< from scan to scan, median; 0 of one scan
  std::string doppler;                          ///< kind and sign, in words
  std::vector<std::string> warnings;            ///< what seems wrong, in sentences
  std::optional<diagnosis::SweepSearch> sweep;  ///< of points without times, where it was asked for
};

/// Which scans [begin, end) a run takes, and how many threads (0: as many as the machine has) may look at them.
struct ScansToCheck {
  std::size_t begin = 0;
  std::size_t end = 0;
  int threads = 0;
};

/// What a method needs to know of a recording.
struct Needs {
  bool doppler = true;
  bool sweep = false;  ///< how scans were taken whose points have no times
};

/// How the user states the correction of a finding, e.g. by the options of a program.
using FixInWords = std::function<std::string(const diagnosis::Finding&)>;

/// Diagnoses scans from all over a run before it begins, and searches for sweeps where asked. Throws DataError where
/// every result would be wrong: the sign or the unit of the Doppler, its kind, the unit of the points or the order of
/// the columns is beyond doubt another one than stated, or there is no Doppler and the method needs it. The message
/// holds the correction of each. What the user states is believed. Messages leave corrections out where `fix_in_words`
/// is empty.
RecordingCheck check_recording(const datasets::Dataset& dataset, const datasets::InputSettings& settings,
                               const ScansToCheck& scans, const Needs& needs, const FixInWords& fix_in_words = {});

}  // namespace dynamic_icp::runs
