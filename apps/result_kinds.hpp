// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/formats/result_kind.hpp"

// What the results of the commands consist of, for --force: it removes these files and no others. Those of `run` are in
// recording/runs/run_folder.hpp, those of `simulate` in tools/simulation/sequence_folder.hpp.
namespace dynamic_icp::apps {

/// Of `convert`, in all layouts.
formats::ResultKind conversion_result();

}  // namespace dynamic_icp::apps
