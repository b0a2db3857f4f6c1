// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/conversion/column_types.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::conversion {

/// What the target cannot hold, each sentence once, in the order in which it was found.
class Notes {
 public:
  void add(const std::string& sentence);
  [[nodiscard]] const std::vector<std::string>& sentences() const { return sentences_; }

 private:
  std::vector<std::string> sentences_;
};

/// One scan with all that is known of its points, on the way into a file.
struct ScanToWrite {
  const RawScan& scan;
  const std::vector<datasets::PointColumn>& columns;
  const ColumnTypes& types;
};

/// The columns of a scan by the names under which the reader of such files finds them (datasets/field_names.hpp).
/// Where `arrays_of_vectors`, points and los are one array of shape (N, 3) each; else x, y, z and los_x, los_y, los_z.
std::vector<formats::NamedArray> scan_table(const ScanToWrite& scan, bool arrays_of_vectors, Notes& notes);

}  // namespace dynamic_icp::conversion
