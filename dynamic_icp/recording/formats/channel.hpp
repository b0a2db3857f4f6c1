// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "dynamic_icp/method/base/raw_scan.hpp"

namespace dynamic_icp::formats {

/// What a further number of a point says, of those that a scan has a place for.
enum class Channel : std::uint8_t {
  kNone,
  kSensor,  ///< to kReturnNumber: see Channels
  kLine,
  kFace,
  kIntensity,
  kReturnNumber,
  kValid,   ///< 0 or NaN: no measurement (RawScan::is_unusable)
  kInvalid  ///< anything but 0: no measurement
};

/// Puts the numbers of a column, one for each point, into their place in a scan whose points and Doppler are there
/// already. All but intensities and flags must be whole, from 0 up to what the place holds; those of points at the
/// origin or without finite numbers do not count. What one column flags stays flagged.
///
/// Where the numbers do not fit the place stays as it was, and the result says why, in words that follow the name of
/// the column; else it is empty.
std::string set_channel(RawScan& scan, Channel channel, std::span<const double> values);

/// Adds to the warnings of a scan that a column of its file is left out, and why; nothing where there is no reason.
void warn_of_column(RawScan& scan, const std::filesystem::path& file, std::string_view column,
                    const std::string& reason);

}  // namespace dynamic_icp::formats
