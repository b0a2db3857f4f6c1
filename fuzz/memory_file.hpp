// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace dynamic_icp::fuzz {

/// The folder of the files of this process, alone in one above it: readers look there for times and ground truth, and
/// find nothing. scripts/fuzz.sh lets TMPDIR name a place in memory.
class EmptyFolder {
 public:
  EmptyFolder() : above_(std::filesystem::temp_directory_path() / ("dynamic-icp-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path());
  }
  ~EmptyFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(above_, ignored);
  }
  EmptyFolder(const EmptyFolder&) = delete;
  EmptyFolder& operator=(const EmptyFolder&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return above_ / "recording"; }

 private:
  std::filesystem::path above_;
};

/// A file for readers that take a path. Files are used again, one after the other: making and removing one takes longer
/// than most readers need for what is in it.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : file_(take()) {
    if (file_.descriptor < 0 || ::pwrite(file_.descriptor, data, size, 0) != static_cast<ssize_t>(size) ||
        ::ftruncate(file_.descriptor, static_cast<off_t>(size)) != 0) {
      std::abort();
    }
  }
  ~MemoryFile() { unused().push_back(std::move(file_)); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path; }

  /// The same file under this name, alone in a folder: for readers that go by names.
  [[nodiscard]] std::filesystem::path named(const std::string& name) const {
    const std::filesystem::path folder = file_.path.string() + "-" + name;
    if (!std::filesystem::exists(folder)) {
      std::filesystem::create_directory(folder);
      std::filesystem::create_symlink(file_.path, folder / name);
    }
    return folder / name;
  }

 private:
  struct File {
    std::filesystem::path path;
    int descriptor = -1;
  };

  static std::vector<File>& unused() {
    static std::vector<File> files;
    return files;
  }

  static File take() {
    static const EmptyFolder folder;
    static int made = 0;
    if (unused().empty()) {
      std::filesystem::path path = folder.path() / ("input-" + std::to_string(made++));
      const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
      return {std::move(path), descriptor};
    }
    File file = std::move(unused().back());
    unused().pop_back();
    return file;
  }

  File file_;
};

/// Ends the process with a report, as a finding, where what must hold does not.
inline void must(bool holds) {
  if (!holds) {
    std::abort();
  }
}

}  // namespace dynamic_icp::fuzz
