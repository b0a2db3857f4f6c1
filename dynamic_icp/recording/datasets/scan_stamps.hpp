// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::datasets {

/// The scans of a folder in the order of their stamps.
struct StampedFiles {
  std::vector<std::filesystem::path> files;
  std::vector<Stamp> stamps;             ///< as long as the files, strictly increasing
  bool are_indices = false;              ///< the names count the scans and say no time
  std::vector<std::string> assumptions;  ///< sentences for the user
};

/// The files of a folder with the given extension (".bin") and the time stamps in their names. What is the same in all
/// names tells nothing (numbered_files.hpp). The number that tells them apart, as a rule the last run of digits, is
/// Unix time of the unit its length tells (dates from 2001 to 2286): 10 digits s, 13 ms, 16 us, 19 ns; names that end
/// in 10 digits, a point and further digits, or in digits, a point and 9 digits, are seconds; 19 digits may begin with
/// zeros. Up to 9 digits after any zeros in front are the index of a scan: `period_s` apart, from 0 at the first, with
/// a sentence that says so. Where no number alone tells scans apart they are `period_s` apart in the order of their
/// names. Names without a digit, beside others with one, and hidden files are left out.
///
/// Throws DataError when the folder cannot be read or has no such file, for numbers of other lengths, when names of
/// several kinds are mixed, and when two files carry the same stamp, naming both.
StampedFiles stamped_files(const std::filesystem::path& folder, std::string_view extension, double period_s);

/// The same for these files, at least one.
StampedFiles stamped_files(const std::vector<std::filesystem::path>& files, double period_s);

}  // namespace dynamic_icp::datasets
