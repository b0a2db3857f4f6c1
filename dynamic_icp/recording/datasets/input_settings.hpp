// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/datasets/correction.hpp"
#include "dynamic_icp/recording/datasets/open_options.hpp"

namespace dynamic_icp::datasets {

/// All that a user may say about an input. As names and texts it goes from the command line to run.json, to the runs of
/// a benchmark, and back when figures open the recording again.
struct InputSettings {
  OpenOptions open;
  Correction correction;
};

/// Takes over what the correction states, such as the one that fixes a finding of the diagnosis.
inline void apply(const Correction& correction, InputSettings& settings) { settings.correction.apply(correction); }

/// Takes over one of them:
///   format NAME, field.NAME COLUMN, lidar.NUMBER NAME, topic.NUMBER NAME, truth-topic NAME, period S,
///   doppler-sign away|towards, doppler-kind relative|compensated, doppler-scale F, point-scale F, time-scale F,
///   columns: x, y, z and doppler with commas, in the order in which they are stored; or what each number of a record
///   without names is ("x,y,z,_,doppler"), dtype TYPE of these numbers.
/// Throws UsageError naming the setting, its value and what was expected.
void set(InputSettings& settings, const std::string& name, const std::string& text);

/// Those that were stated, so that `set` makes the same settings of them; but not the format.
std::vector<std::pair<std::string, std::string>> texts(const InputSettings& settings);

/// Those that state what corrects an input, `fix`, beside the `settings` that are stated already: columns that are
/// stated of a record stay those of a record.
std::vector<std::pair<std::string, std::string>> texts_of_fix(const Correction& fix, const InputSettings& settings);

/// Those that state that another column is the Doppler: the one of that name, or, where there is none with a name, one
/// of those that are left out ("_") of the columns stated of a record, "LIST" standing for them where several are.
/// Empty: there is no other column.
std::vector<std::pair<std::string, std::string>> texts_of_doppler(const std::string& column,
                                                                  const InputSettings& settings);

/// `open_dataset`, then `corrected`; throws as they do.
std::unique_ptr<Dataset> open_input(const std::filesystem::path& input, const InputSettings& settings);

}  // namespace dynamic_icp::datasets
