// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/datasets/open_options.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"

namespace dynamic_icp::datasets {

/// Whether the user says what the records of a recording are: by the names of their numbers or by their type.
bool states_records(const OpenOptions& options);

/// Has the scans of a recording, whose files are found, read as the records that the user states: numbers of one type
/// without padding, whose names (field_names.hpp) say what they are. The unit of times is found in the first scan with
/// points (point_times.hpp). Adds what is assumed to the sentences of the scans. Throws UsageError for names that are
/// given twice or lack x, y, z or the Doppler, and for unknown types; UnclearInput where the sizes of the files
/// are those of other records, or their content is and the user did not say all that differs.
void read_as_stated(const OpenOptions& options, RecordRecording& recording);

}  // namespace dynamic_icp::datasets
