// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/recording/formats/channel.hpp"
#include "dynamic_icp/recording/formats/npy_header.hpp"

namespace dynamic_icp::formats {

// Scans as files of little-endian records without padding, one per point, that hold x, y, z (m, sensor frame) and the
// Doppler (m/s, positive away): in the layouts of data sets as float32, x, y and z in front.

/// How a record holds the time of its point after the scan's stamp.
enum class RecordTime : std::uint8_t {
  kNone,
  kNanoseconds,           ///< int32
  kSeconds,               ///< float32
  kSecondsOrNanoseconds,  ///< float32: nanoseconds in files where one is above 10
  kAsStored               ///< of the type of the point, in a unit and from a time that the reader does not know
};

using NumberType = NpyType;

/// A further number of a record.
struct RecordField {
  std::string_view name;
  std::size_t offset = 0;
  NumberType type = NumberType::kFloat32;
  bool is_integer = false;  ///< also where it is stored as a float
  unsigned shift = 0;       ///< of integers made of several parts: the part is (value >> shift) & mask
  unsigned mask = 0;        ///< 0: the whole number
  Channel channel = Channel::kNone;
};

struct RecordLayout {
  std::string_view name;
  std::size_t bytes = 0;    ///< of one record, as it is read
  std::size_t doppler = 0;  ///< its offset
  RecordTime time_type = RecordTime::kNone;
  std::size_t time = 0;  ///< its offset
  std::span<const RecordField> fields = {};
  std::array<std::size_t, 3> point = {0, 4, 8};  ///< offsets of x, y, z
  NumberType type = NumberType::kFloat32;        ///< of x, y, z and the Doppler
  bool is_half = false;  ///< all numbers are float32 that are stored as float16, in half of the bytes

  /// Of one record in the file.
  [[nodiscard]] std::size_t stored_bytes() const { return is_half ? bytes / 2 : bytes; }
};

// The layouts by their names.
extern const RecordLayout kXyzd;                  ///< 16 bytes: Doppler-ICP, and the plain one for interchange
extern const RecordLayout kAeva25;                ///< HeLiPR before the recorder changed
extern const RecordLayout kAeva29;                ///< HeRCULES and later HeLiPR: with intensity in dB
extern const RecordLayout kBoreas40;              ///< Boreas-RT
extern const RecordLayout kBoreas24;              ///< Boreas-Aeva
extern const RecordLayout kBoreas28;              ///< the same with a beam
extern const RecordLayout kBoreas28BeamThenTime;  ///< the same in the other order
extern const RecordLayout kBoreas32;              ///< the same with beam and sensor
extern const RecordLayout kXyzdTime;              ///< 20 bytes: the "Aeva" set
extern const RecordLayout kVod28;                 ///< the radar of View-of-Delft

/// Reads points, Doppler, times and channels; the stamp is left 0, it is in the name of the file. Numbers are handed on
/// as they are, finite or not. An empty file is an empty scan and bytes after the last whole record are left out, both
/// with a warning in the result; so is a channel whose numbers do not fit it. Throws DataError naming the file when it
/// cannot be read or is something else: an archive, a Git LFS pointer and the like.
RawScan read_points(const std::filesystem::path& path, const RecordLayout& layout);

/// Reads a further column, as stored. Errors as above.
std::vector<double> read_field(const std::filesystem::path& path, const RecordLayout& layout, const RecordField& field);

}  // namespace dynamic_icp::formats
