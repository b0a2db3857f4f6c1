// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace dynamic_icp::bags {

/// How a chunk, a message or a file is packed.
enum class Compression : std::uint8_t { kNone, kBz2, kLz4, kZstd };

/// By the names of ROS 1 bags and MCAP: "" and "none", "bz2", "lz4" (frames), "zstd".
std::optional<Compression> compression_of(std::string_view name);

/// What came out, also where something is wrong: then up to there.
struct Unpacked {
  std::string bytes;
  std::string fault;    ///< empty where all is well
  bool is_cut = false;  ///< the packed bytes end too early; what is there is right as far as can be told
};

/// Unpacks exactly `size` bytes, as the container states them; fewer and more are a fault. Memory grows with what
/// really comes out: a wrong `size` allocates nothing.
Unpacked unpack(Compression compression, std::string_view packed, std::uint64_t size);

/// Unpacks Zstandard whose size nobody states, up to `max_bytes`.
Unpacked unpack_zstd(std::string_view packed, std::uint64_t max_bytes);

/// The first bytes, at most `count`, of a file that is packed with Zstandard; fewer where it is damaged.
std::string zstd_file_head(const std::filesystem::path& packed, std::size_t count);

/// Unpacks a file that is packed with Zstandard into a new one, in constant memory. Where it is cut short, what is
/// there is written, and the place of the cut returned in words; else nothing. Throws DataError naming file and reason
/// where it is damaged (nobody knows since where: the bytes have no checksum until their end), and where the machine
/// fails.
std::string unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& unpacked);

}  // namespace dynamic_icp::bags
