// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/scan.hpp"

#include "tests/program.hpp"

// For tests: recordings in every layout, and what may happen to them.
namespace dynamic_icp::tests {

/// A layout as it lies on disk.
struct Layout {
  std::string name;
  std::string scans;             ///< folder of the scans within the recording
  std::string extension;         ///< of those that are damaged
  std::size_t record_bytes = 0;  ///< of layouts of records, that begin with x, y, z as float32
  std::string truth;             ///< file of the ground truth
  std::string metadata;          ///< what else is said of the recording: file or folder
};

const std::vector<Layout>& layouts();

/// The one of that name.
const Layout& layout_of(const std::string& name);

/// As --format takes it.
std::string format_of(const Layout& layout);

/// The scans of a recording, in the order of their names.
std::vector<fs::path> scan_files(const Layout& layout, const fs::path& recording);

/// What is put in the place of numbers.
enum class Numbers { kAsMeasured, kNan, kOtherByteOrder };

/// A scan as a file of a layout that is not one of records; of plain x, y, z and Doppler for "bin".
std::string file_of(const std::string& layout, const RawScan& scan, Numbers numbers);

/// The Doppler beside the points of "npy-pair".
std::string doppler_file_of(const RawScan& scan);

/// The text with the first place of `what` replaced, if there is one.
std::string replaced(std::string text, const std::string& what, const std::string& with);

/// Damages a recording; false: the layout knows no such damage. `file` is its second scan.
using Damage =
    std::function<bool(const Layout& layout, const fs::path& recording, const fs::path& file, const RawScan& scan)>;

/// All of them by name.
const std::vector<std::pair<std::string, Damage>>& damages();

}  // namespace dynamic_icp::tests
