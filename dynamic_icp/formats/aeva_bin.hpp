// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "dynamic_icp/base/scan.hpp"

namespace dynamic_icp::formats {

// Scans of Aeva sensors as the players of HeRCULES and HeLiPR store them: little-endian records without padding.

/// One record, field by field in the order of the file; `line_index` leaves what follows it unaligned there.
struct AevaRecord {
  float x = 0.0F;  ///< m, sensor frame
  float y = 0.0F;
  float z = 0.0F;
  float reflectivity = 0.0F;
  float velocity = 0.0F;            ///< m/s, positive away
  std::int32_t time_offset_ns = 0;  ///< after the scan's stamp
  std::uint8_t line_index = 0;
  float intensity = 0.0F;  ///< dB; older recordings do not have it
};

/// Which records a file holds. The size of the file does not tell: whoever knows the recording does.
enum class AevaRecordKind : std::uint8_t {
  kWithoutIntensity,  ///< 25 bytes
  kWithIntensity      ///< 29 bytes
};

/// The size of one record of that kind.
constexpr std::size_t record_bytes(AevaRecordKind kind) { return kind == AevaRecordKind::kWithIntensity ? 29 : 25; }

/// A scan as it was read: columns of equal length.
struct AevaScan {
  RawScan raw;  ///< with the time of each point; the stamp is left 0, it is in the name of the file
  std::vector<float> reflectivity;
  std::vector<std::uint8_t> line_index;
  std::vector<float> intensity;  ///< dB; empty for records without it
};

/// Reads such a file. An empty file is an empty scan and bytes after the last whole record are left out, both with a
/// warning in the result. Throws DataError for files that cannot be read, and names what it is when it is a Git LFS
/// pointer or an archive instead of data.
AevaScan read_aeva(const std::filesystem::path& path, AevaRecordKind kind);

/// Writes records of 29 bytes to a file of an output folder (see write_bytes).
void write_aeva(const std::filesystem::path& path, std::span<const AevaRecord> records);

}  // namespace dynamic_icp::formats
