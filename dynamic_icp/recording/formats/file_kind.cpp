// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/file_kind.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

using std::string_view_literals::operator""sv;

struct Mark {
  std::string_view bytes;
  FileKind kind;
};

constexpr Mark kMarks[] = {
    {"version https://git-lfs", FileKind::kLfsPointer},
    {"PK\x03\x04", FileKind::kZip},
    {"PK\x05\x06", FileKind::kZip},  // one without members
    {"\x28\xB5\x2F\xFD", FileKind::kZstd},
    {"7z\xBC\xAF\x27\x1C", FileKind::kSevenZip},
    {"\x93NUMPY", FileKind::kNpy},
    {"\x89MCAP0\r\n", FileKind::kMcap},
    {"#ROSBAG V2.0\n", FileKind::kRosBag},
    {"#ROSBAG V1", FileKind::kOldRosBag},
    {"#ROSRECORD", FileKind::kOldRosBag},
    {"SQLite format 3\0"sv, FileKind::kSqlite},
    {"ply\n", FileKind::kPly},
    {"ply\r\n", FileKind::kPly},
    {"# .PCD ", FileKind::kPcd},
    {"VERSION ", FileKind::kPcd},  // some writers leave the comment out,
    {"FIELDS ", FileKind::kPcd},   // others the version too
    {"LASF", FileKind::kLas},
    {"ASTM-E57", FileKind::kE57},
    {"\x89HDF\r\n\x1A\n", FileKind::kHdf5},
    {"MATLAB ", FileKind::kMatlab},
    {"PAR1", FileKind::kParquet},
    {"\xD4\xC3\xB2\xA1"sv, FileKind::kPcap},
    {"\x0A\x0D\x0D\x0A"sv, FileKind::kPcap},  // pcapng
};

// In the order of FileKind.
constexpr std::string_view kSentences[] = {
    "",
    "is a Git LFS pointer, not data; run 'git lfs pull' where it came from",
    "is a zip archive; unpack it first",
    "is compressed with gzip; unpack it first ('gunzip', or 'tar xzf' for a .tar.gz)",
    "is compressed with Zstandard; unpack it first ('zstd -d')",
    "is a 7z archive; unpack it first",
    "is a tar archive; unpack it first ('tar xf')",
    "is an array of NumPy (.npy)",
    "is an MCAP recording, which format mcap reads",
    "is a ROS 1 bag, which format rosbag reads",
    "is a ROS bag from before version 2.0; convert it first: 'rosbag fix OLD.bag NEW.bag' (python3-rosbag of Debian)",
    "is an SQLite database; if it is of a ROS 2 bag, format rosbag2 reads it",
    "is a PLY file",
    "is a PCD file",
    "is a LAS or LAZ file, which is not read; write each scan, with the Doppler among its extra dimensions, with "
    "Python: "
    "import laspy, numpy; las = laspy.read('IN.las'); numpy.savez('00000.npz', points=las.xyz, **{n: "
    "numpy.asarray(las[n]) for n in las.point_format.extra_dimension_names})",
    "is an E57 file, which is not read: it has no field for a Doppler, and what software adds to the standard only "
    "that "
    "software reads; have it export each scan as PCD, PLY or text",
    "is an HDF5 file, which is not read; write each scan with Python: import h5py, numpy; numpy.savez('00000.npz', "
    "points=..., doppler=...) of its data sets of shape (N, 3) and (N,)",
    "is a MATLAB file, which is not read; write each scan with Python: import numpy, scipy.io; "
    "numpy.savez('00000.npz', points=..., doppler=...) of what scipy.io.loadmat reads",
    "is a Parquet file, which is not read; write each scan as text with Python: import pandas; "
    "pandas.read_parquet('IN.parquet').to_csv('OUT.csv', index=False)",
    "is a capture of network packets, which is not read; have the software of the sensor write each scan as PCD or "
    "text",
};
static_assert(std::size(kSentences) == static_cast<std::size_t>(FileKind::kPcap) + 1);

unsigned char byte_at(std::string_view head, std::size_t at) { return static_cast<unsigned char>(head[at]); }

/// Two marking bytes alone could begin a coordinate: method, flags, level and system must be possible as well.
bool is_gzip(std::string_view head) {
  return head.size() >= 10 && head.starts_with("\x1F\x8B\x08") && byte_at(head, 3) < 0x20 &&
         (byte_at(head, 8) == 0 || byte_at(head, 8) == 2 || byte_at(head, 8) == 4) &&
         (byte_at(head, 9) <= 13 || byte_at(head, 9) == 255);
}

/// The mark lies after the name, mode and size of the first member; these are text.
bool is_tar(std::string_view head) {
  constexpr std::size_t kMarkAt = 257;
  constexpr std::size_t kModeAt = 100;
  return head.size() >= kMarkAt + 6 &&
         (head.substr(kMarkAt, 6) == "ustar\0"sv || head.substr(kMarkAt, 6) == "ustar ") && head[kModeAt] >= '0' &&
         head[kModeAt] <= '7';
}

std::string_view name_of(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::fifo:
      return "a named pipe";
    case std::filesystem::file_type::socket:
      return "a socket";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return "a device";
    default:
      return "no regular file";
  }
}

}  // namespace

void refuse_irregular(const std::filesystem::path& path) {
  std::error_code unknown;
  const std::filesystem::file_type type = std::filesystem::status(path, unknown).type();
  if (unknown || type == std::filesystem::file_type::regular || type == std::filesystem::file_type::directory ||
      type == std::filesystem::file_type::not_found || type == std::filesystem::file_type::none) {
    return;
  }
  throw DataError(fmt::format("{}: is {}, expected a regular file or a folder", path.string(), name_of(type)));
}

FileKind kind_of(std::string_view head) {
  const auto* const mark =
      std::find_if(std::begin(kMarks), std::end(kMarks), [&](const Mark& m) { return head.starts_with(m.bytes); });
  if (mark != std::end(kMarks)) {
    return mark->kind;
  }
  if (is_gzip(head)) {
    return FileKind::kGzip;
  }
  return is_tar(head) ? FileKind::kTar : FileKind::kUnknown;
}

FileKind kind_of_file(const std::filesystem::path& path) {
  refuse_irregular(path);
  std::array<char, kKindBytes> head{};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  if (!file.is_open() || file.bad()) {
    throw DataError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  return kind_of({head.data(), static_cast<std::size_t>(file.gcount())});
}

std::string_view sentence(FileKind kind) { return kSentences[static_cast<std::size_t>(kind)]; }

void refuse_other_kind(const std::filesystem::path& path, std::string_view head, FileKind expected) {
  const FileKind kind = kind_of(head);
  if (kind != FileKind::kUnknown && kind != expected) {
    throw DataError(fmt::format("{}: {}", path.string(), sentence(kind)));
  }
}

}  // namespace dynamic_icp::formats
