// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace dynamic_icp::formats {

/// What a file is by its first bytes. Records of points have no mark and are unknown; none of the marks can be the
/// coordinates of a point.
enum class FileKind : std::uint8_t {
  kUnknown,
  kLfsPointer,
  kZip,  ///< NPZ files too
  kGzip,
  kZstd,
  kSevenZip,
  kTar,
  kNpy,
  kMcap,
  kRosBag,
  kOldRosBag,
  kSqlite,
  kPly,
  kPcd,
  kLas,
  kE57,
  kHdf5,
  kMatlab,
  kParquet,
  kPcap
};

/// As many bytes from the front of a file as it takes to tell.
constexpr std::size_t kKindBytes = 512;

/// Throws DataError that names the file and what it is where it is neither a file nor a folder: reading a named pipe, a
/// socket or a device may never end. What is missing or cannot be looked at passes, for the reader to say.
void refuse_irregular(const std::filesystem::path& path);

/// What a file is whose content, or the first kKindBytes of it, is `head`.
FileKind kind_of(std::string_view head);

/// The same for a file. Throws DataError naming file and reason when it cannot be read.
FileKind kind_of_file(const std::filesystem::path& path);

/// What follows the name of such a file in a message: "is a zip archive; unpack it first". Empty for kUnknown.
std::string_view sentence(FileKind kind);

/// Throws DataError with that sentence for content that is known to be something else than `expected`, which may be
/// kUnknown: records without a mark. Content without a mark always passes.
void refuse_other_kind(const std::filesystem::path& path, std::string_view head, FileKind expected);

}  // namespace dynamic_icp::formats
