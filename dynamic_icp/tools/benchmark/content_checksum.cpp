// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/content_checksum.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockBytes = std::size_t{1} << 20U;

/// Recordings may come with many times as many bytes of pictures.
bool is_picture(const fs::path& path) {
  constexpr std::array<std::string_view, 7> kEndings = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".mp4"};
  return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
}

/// Collects the files in a folder and below, sorted by name in each folder. Links to folders are followed as readers
/// do; what is in `seen`, under its canonical name, is left out, so that those end which lead round in circles.
void collect_files(const fs::path& folder, std::set<fs::path>& seen, std::vector<fs::path>& files) {
  std::error_code fault;
  if (!seen.insert(fs::weakly_canonical(folder, fault)).second) {
    return;
  }
  const auto is_visible = [](const fs::directory_entry& entry) {
    return !entry.path().filename().string().starts_with(".");
  };
  for (const fs::path& entry : datasets::entries_of(folder, is_visible)) {
    std::error_code ignored;
    if (fs::is_directory(entry, ignored)) {
      collect_files(entry, seen, files);
    } else if (fs::is_regular_file(entry, ignored) && !is_picture(entry)) {
      files.push_back(entry);
    }
  }
}

std::vector<fs::path> files_below(const fs::path& folder, const fs::path& except) {
  std::vector<fs::path> files;
  std::set<fs::path> seen;
  if (!except.empty()) {
    std::error_code ignored;
    seen.insert(fs::weakly_canonical(except, ignored));
  }
  collect_files(folder, seen, files);
  return files;
}

}  // namespace

void Checksum::mix(std::uint64_t word) {
  // The shift carries differences of the highest bits, such as signs, down to where the product spreads them.
  state_ = (state_ ^ word) * 0x9e3779b97f4a7c15ULL;
  state_ ^= state_ >> 32U;
}

void Checksum::add(std::string_view bytes) {
  mix(bytes.size());
  for (; bytes.size() >= sizeof(std::uint64_t); bytes.remove_prefix(sizeof(std::uint64_t))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof(word));
    mix(word);
  }
  std::uint64_t rest = 0;
  if (!bytes.empty()) {
    std::memcpy(&rest, bytes.data(), bytes.size());
    mix(rest);
  }
}

void Checksum::add(std::span<const double> numbers) {
  const std::span<const std::byte> bytes = std::as_bytes(numbers);
  add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void Checksum::add_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string block(kBlockBytes, '\0');
  std::uint64_t size = 0;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0));
    add(std::string_view(block).substr(0, got));
    size += got;
  }
  mix(size);
}

std::string Checksum::text() const { return fmt::format("{:016x}", state_); }

std::string content_checksum(const fs::path& path, const fs::path& except) {
  Checksum checksum;
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    checksum.add_file(path);
    return checksum.text();
  }
  for (const fs::path& file : files_below(path, except)) {
    checksum.add(file.lexically_relative(path).string());
    checksum.add_file(file);
  }
  return checksum.text();
}

std::uintmax_t content_bytes(const fs::path& path, const fs::path& except) {
  std::error_code ignored;
  std::uintmax_t bytes = 0;
  for (const fs::path& file : fs::is_directory(path, ignored) ? files_below(path, except) : std::vector{path}) {
    const std::uintmax_t size = fs::file_size(file, ignored);
    bytes += ignored ? 0 : size;
  }
  return bytes;
}

std::string file_checksum(const fs::path& path) {
  Checksum checksum;
  checksum.add(formats::read_whole_file(path));
  return checksum.text();
}

}  // namespace dynamic_icp::benchmark
