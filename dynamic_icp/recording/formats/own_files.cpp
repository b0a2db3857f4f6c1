// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/own_files.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

/// Whom a file belongs to that is made in a folder; who runs the program where none can be made.
uid_t owner_of_new_file(const fs::path& folder) {
  std::string name = (folder / "owner.XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  struct stat status = {};
  const bool is_known = file >= 0 && ::fstat(file, &status) == 0;
  if (file >= 0) {
    ::close(file);
    ::unlink(name.c_str());
  }
  return is_known ? status.st_uid : ::geteuid();
}

class OwnerCheck {
 public:
  explicit OwnerCheck(const fs::path& folder) : folder_(folder) {}

  /// Throws where an entry, or one below, is not one's own.
  void check_all(const fs::path& path) {
    if (check(path)) {
      for (const fs::directory_entry& entry : entries_in(path)) {
        check_all(entry.path());
      }
    }
  }

 private:
  /// Whether an entry is a folder.
  bool check(const fs::path& path) {
    struct stat status = {};
    if (::lstat(path.c_str(), &status) != 0) {
      throw DataError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
    }
    const bool is_folder = S_ISDIR(status.st_mode);
    if (!is_folder && !S_ISREG(status.st_mode)) {
      throw DataError(fmt::format("{}: is {}, expected a regular file or a folder", path.string(),
                                  S_ISLNK(status.st_mode) ? "a link" : "a pipe, socket or device"));
    }
    if (status.st_uid != ::geteuid() && status.st_uid != owner_of_new()) {
      throw DataError(fmt::format("{}: belongs to another user (uid {})", path.string(), status.st_uid));
    }
    return is_folder;
  }

  uid_t owner_of_new() {
    owner_of_new_ = owner_of_new_ ? *owner_of_new_ : owner_of_new_file(folder_);
    return *owner_of_new_;
  }

  const fs::path& folder_;
  std::optional<uid_t> owner_of_new_;
};

}  // namespace

void refuse_foreign_files(const fs::path& path, const fs::path& folder) { OwnerCheck(folder).check_all(path); }

}  // namespace dynamic_icp::formats
