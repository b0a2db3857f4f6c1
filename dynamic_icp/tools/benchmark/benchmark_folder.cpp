// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "benchmark.lock";
constexpr std::array<std::string_view, 7> kOwnNames = {"tables",  "tables.md",   "results.json",   "plan.json",
                                                       kLockName, "report.html", "comparison.html"};
constexpr std::size_t kLongestName = 200;  // file systems take 255, some of which go to endings

/// The folder of a benchmark, made where it is missing.
fs::path usable_folder(const fs::path& given) {
  const fs::path path = fs::absolute(given).lexically_normal();
  std::error_code fault;
  if (!fs::exists(path, fault)) {
    formats::make_folder(path);
    return path;
  }
  if (!fs::is_directory(path, fault)) {
    throw DataError(fmt::format("{}: exists and is not a folder", path.string()));
  }
  if (!fs::exists(path / kLockName, fault) && !fs::is_empty(path, fault)) {
    throw DataError(
        fmt::format("{}: folder is not empty and holds no {}; choose another one", path.string(), kLockName));
  }
  return path;
}

fs::path made_file(const fs::path& path) {
  formats::OutputFile file(path);
  file.close();
  return path;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const char* name, Kind kind)
    : lock_(made_file(folder / name), formats::PathLock::Wait::kNo, kind) {
  if (lock_.taken()) {
    throw DataError(fmt::format("{}: another benchmark is running in this folder", folder.string()));
  }
  if (!lock_.held()) {
    throw DataError(fmt::format("{}: cannot be locked", (folder / name).string()));
  }
}

BenchmarkFolder::BenchmarkFolder(const fs::path& path, FolderLock::Kind kind)
    : path_(usable_folder(path)), lock_(path_, kLockName, kind) {
  if (kind == FolderLock::Kind::kAlone) {
    remove_partial_files(path_);
  }
}

bool is_own_name(std::string_view name) {
  return std::find(kOwnNames.begin(), kOwnNames.end(), name) != kOwnNames.end();
}

std::string unfit_name(std::string_view name) {
  if (name.find_first_of("/\\") != std::string_view::npos) {
    return "holds a slash";
  }
  if (name.empty() || name.front() == '.') {
    return name.empty() ? "is empty" : "begins with a dot";
  }
  if (without_control_characters(name) != name) {
    return "holds a control character";
  }
  if (name.size() > kLongestName) {
    return fmt::format("is longer than {} bytes", kLongestName);
  }
  return is_own_name(name) ? "is that of a file of the benchmark itself" : "";
}

std::string without_control_characters(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool of_two_bytes = byte == 0xC2U && next >= 0x80U && next < 0xA0U;  // U+0080 to U+009F
    const bool is_control = byte < 0x20U || byte == 0x7FU || of_two_bytes;
    result += is_control ? '_' : text[i];
    i += of_two_bytes ? 1 : 0;
  }
  return result;
}

void remove_partial_files(const fs::path& folder) {
  for (const fs::directory_entry& entry : formats::entries_in(folder)) {
    std::error_code fault;
    if (entry.path().filename().string().find(".partial-") != std::string::npos && entry.is_regular_file(fault)) {
      fs::remove(entry.path(), fault);
    }
  }
}

}  // namespace dynamic_icp::benchmark
