// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/tools/report/page.hpp"
#include "dynamic_icp/tools/report/run_scans.hpp"

namespace dynamic_icp::report {

/// The page of one run. Throws DataError when the folder is not that of a finished run; what is gone beside it
/// (recording, ground truth) is left out and stands in the notes.
PageContent run_report(const std::filesystem::path& folder, const ScanChoice& choice, const Workers& workers);

}  // namespace dynamic_icp::report
