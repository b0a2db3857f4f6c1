// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "dynamic_icp/recording/formats/path_lock.hpp"
#include "dynamic_icp/recording/formats/unfinished.hpp"

namespace dynamic_icp::formats {

/// A file being written, with every failure of the machine (disk full, no permission, ...) reported as a DataError
/// that names the file and the reason. What is not closed is incomplete: call close().
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  /// A file that is to be renamed: messages name the one that it will be.
  OutputFile(const std::filesystem::path& path, const std::filesystem::path& final_name);
  /// Resumes a file after its first `length` bytes and cuts off the rest. DataError where it is shorter, and where it
  /// is a link or no regular file.
  static OutputFile resume(const std::filesystem::path& path, std::uintmax_t length);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);

  /// Waits until the bytes are on the device. How many there are in the file.
  std::uintmax_t synchronise();

  /// The same before it closes the file, so that one that was renamed into place is whole.
  void close();

 private:
  OutputFile(const std::filesystem::path& path, const std::filesystem::path& final_name, int flags);
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path final_name_;
  int descriptor_ = -1;
};

/// A file written piece by piece that appears whole or not at all: under a temporary name beside `path` until commit().
/// Without that nothing is left, and an earlier file of that name stays untouched. What a
/// writer that was killed has left is written over by the next one. A device or pipe of that name is written into.
/// Every failure of the machine is a DataError that names `path`.
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& path);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  void write(std::string_view bytes) { file_->write(bytes); }

  /// Waits until the bytes are on the device and gives the file its name; nothing can be written after it.
  void commit();

 private:
  void make_partial();
  void remove_partial() const;

  std::filesystem::path path_;
  std::filesystem::path partial_;  ///< empty: written into what there is, or committed
  std::optional<PathLock> lock_;   ///< of it: it is being written
  std::optional<Unfinished> unfinished_;
  std::optional<OutputFile> file_;
};

/// Writes a file whole or not at all: under a temporary name beside `path`, then renamed. An earlier file of that
/// name stays untouched when anything fails. A device or pipe of that name is written into.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

/// The whole content of a regular file, in as much memory as the file is long. Throws DataError naming the file and the
/// reason, also where it is longer than `max_bytes` or the memory does not suffice.
std::string read_whole_file(const std::filesystem::path& path,
                            std::uintmax_t max_bytes = std::numeric_limits<std::uintmax_t>::max());

/// Longer texts are refused: a trajectory of a day at 100 Hz is not that long.
constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{1} << 30U;

/// The same for a text: one that is too long or has a zero byte in it is refused, and so is a file that is known to be
/// no text (see kind_of). Some parsers take a zero byte for the end and would miss what follows.
std::string read_text_file(const std::filesystem::path& path);

/// Calls use(line, number) for each line of a text, without its line feed and counted from 1: of a file of any length,
/// in as much memory as its longest line takes, which must not be longer than kMaxTextBytes. Throws as read_text_file
/// does.
void for_each_text_line(const std::filesystem::path& path,
                        const std::function<void(std::string_view line, std::size_t number)>& use);

}  // namespace dynamic_icp::formats
