// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/formats/point_records.hpp"

namespace dynamic_icp::datasets {

/// Throws DataError naming file and record when most points of a scan are no numbers anybody measured (beyond 10 000
/// km, or not 0 but below 1e-20): read in the wrong byte order or from records of another size. Points that are not
/// finite do not count.
void refuse_foreign_numbers(const RawScan& scan, const std::filesystem::path& file,
                            const formats::RecordLayout& layout);

/// The same of points from columns with names.
void refuse_foreign_numbers(const RawScan& scan, const std::filesystem::path& file);

}  // namespace dynamic_icp::datasets
