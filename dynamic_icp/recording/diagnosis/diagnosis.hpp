// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/recording/datasets/correction.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::diagnosis {

/// What the diagnosis asks of a recording, one file each.
enum class Question {
  kDopplerSign,
  kDopplerKind,
  kDopplerBias,
  kDopplerUnits,
  kPointUnits,
  kColumns,
  kMounting,
  kRigMountings,
  kPointTimes,
  kTimeScale,
  kStamps,
  kUnusablePoints,
};

/// doppler_sign, doppler_kind, ...: as in the JSON of `info`.
std::string_view to_string(Question question);

enum class Verdict {
  kOk,
  kWrong,       ///< it contradicts the evidence
  kSuspicious,  ///< unusual; it may be right
  kCannotTell,  ///< the recording does not show it; what the layout says is assumed
};

/// ok, wrong, suspicious, cannot_tell.
std::string_view to_string(Verdict verdict);

/// The answer to one question.
struct Finding {
  Question question = Question::kDopplerSign;
  Verdict verdict = Verdict::kCannotTell;
  std::string sentence = {};          ///< for the user
  datasets::Correction fix = {};      ///< what corrects it, with what was applied already; empty where nothing does
  bool needs_doppler_column = false;  ///< another column must be stated to be the Doppler
  std::vector<std::pair<std::string, double>> evidence = {};  ///< numbers by name; the unit ends the name
  std::string doppler_column = {};  ///< name of the one that is needed (OpenOptions::fields): the likely one, "COLUMN"
                                    ///< where none is likely, empty where no other one has a name
};

/// All answers, in the order of the questions.
struct Diagnosis {
  std::vector<Finding> findings;
  std::size_t scans_looked_at = 0;  ///< each counted once
  double period_s = 0.0;            ///< from scan to scan, median; 0 of one scan
  bool has_doppler = true;          ///< off: what stands for it is zeros or other numbers, see kDopplerKind

  [[nodiscard]] const Finding& of(Question question) const;
};

/// How closely to look.
struct DiagnosisConfig {
  std::size_t begin = 0;  ///< of the scans [begin, end) that count; end is cut to the length
  std::size_t end = static_cast<std::size_t>(-1);
  std::size_t probes = 10;            ///< stretches of the recording looked at, evenly spread
  datasets::Correction applied = {};  ///< what was done to the numbers already: a fix takes it in
  bool always_match_scans = true;     ///< off: only where there is no ground truth, or it disagrees with the Doppler
  bool search_sweep = true;           ///< off: nothing is asked about points without times
};

/// Looks at some stretches of about 0.8 s, compares the velocity that the Doppler gives with the motion by ground truth
/// or by matching scans (which takes no Doppler but to leave out what moves), and answers every question. Nothing is
/// claimed that the evidence does not show beyond doubt: traffic, standing still, featureless scenes and missing truth
/// end in kCannotTell. Throws what reading a scan throws. The same answers for any number of threads.
Diagnosis diagnose(const datasets::Dataset& dataset, const DiagnosisConfig& config, const Workers& workers);

}  // namespace dynamic_icp::diagnosis
