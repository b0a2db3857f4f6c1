// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/folder_moves.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"
#include "dynamic_icp/recording/formats/path_lock.hpp"
#include "dynamic_icp/recording/formats/staged_names.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxTries = 100;  // others may come and go at the same place

void clear_away(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

/// Exchanges two folders at once; false where the file system cannot.
bool exchange(const fs::path& one, const fs::path& other) {
  if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) {
    return true;
  }
  if (errno != EINVAL && errno != ENOSYS && errno != EOPNOTSUPP) {
    throw std::system_error(errno, std::generic_category());
  }
  return false;
}

/// Exchanges a result and an earlier one that `check` lets go; false where the file system cannot.
bool try_exchange(const fs::path& staging, const fs::path& target, const FolderCheck& check) {
  if (!exchange(staging, target)) {
    return false;
  }
  try {
    check(staging);
  } catch (...) {
    exchange(staging, target);
    throw;
  }
  return true;
}

/// Moves the entries of a folder into another one, but for our temporary folders; `first` or `last`, if it is one of
/// them, before or after the others.
void move_entries(const fs::path& from, const fs::path& to, const std::string& first, const std::string& last) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : entries_in(from)) {
    if (const std::string name = entry.path().filename().string(); !is_staged_within(name)) {
      names.push_back(name);
    }
  }
  const auto rank = [&](const std::string& name) { return name == first ? 0 : name == last ? 2 : 1; };
  std::sort(names.begin(), names.end(),
            [&](const auto& a, const auto& b) { return std::pair(rank(a), a) < std::pair(rank(b), b); });
  for (const std::string& name : names) {
    fs::rename(from / name, to / name);
  }
}

/// Ends a move within a folder as far as it came, on one of both sides.
void settle_within(const fs::path& target) {
  const StagedNames names = StagedNames::within(target);
  if (names.found().empty()) {
    return;
  }
  const PathLock moving(target, PathLock::Wait::kYes);
  for (const StagedNames::Found& left : names.found()) {
    std::error_code ignored;
    const PathLock lock(left.path);
    if (!lock.is_of(left.path)) {
      continue;  // being written
    }
    const fs::path replaced = names.path(Staged::kReplaced, left.number);
    if (left.state == Staged::kArriving) {
      move_entries(left.path, target, "", "");
      clear_away(left.path);
      clear_away(replaced);
    } else if (left.state == Staged::kPartial) {
      if (fs::exists(replaced, ignored)) {
        move_entries(replaced, target, "", "");
        clear_away(replaced);
      }
      clear_away(left.path);
    } else if (!fs::exists(names.path(Staged::kPartial, left.number), ignored) &&
               !fs::exists(names.path(Staged::kArriving, left.number), ignored)) {
      clear_away(left.path);
    }
  }
}

void settle_beside(const fs::path& target) {
  for (const StagedNames::Found& left : StagedNames::beside(target).found()) {
    const PathLock lock(left.path);
    if (!lock.is_of(left.path)) {
      continue;
    }
    std::error_code fault;
    if (left.state == Staged::kReplaced && !fs::exists(target, fault)) {
      fs::rename(left.path, target, fault);
    } else {
      clear_away(left.path);
    }
  }
}

bool is_mount_point(const fs::path& folder) {
#ifdef STATX_ATTR_MOUNT_ROOT
  struct statx status = {};
  if (::statx(AT_FDCWD, folder.c_str(), 0, 0, &status) == 0 &&
      (status.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0) {
    return (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
  }
#endif
  struct stat own = {};
  struct stat above = {};
  return ::stat(folder.c_str(), &own) == 0 && ::stat((folder / "..").c_str(), &above) == 0 &&
         own.st_dev != above.st_dev;
}

}  // namespace

bool is_vacant(const fs::path& folder) {
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault); !fault && entry != fs::directory_iterator();
       entry.increment(fault)) {
    if (!is_staged_within(entry->path().filename().string())) {
      return false;
    }
  }
  if (fault && fault != std::errc::no_such_file_or_directory) {  // it may have been replaced meanwhile
    throw fs::filesystem_error("cannot read", folder, fault);
  }
  return true;
}

bool must_stay(const fs::path& folder) {
  std::error_code fault;
  if (!fs::is_directory(folder, fault)) {
    return false;
  }
  return is_mount_point(folder) || fs::equivalent(folder, fs::current_path(fault), fault) ||
         ::access(folder.parent_path().c_str(), W_OK | X_OK) != 0;
}

void replace_in_two_steps(const fs::path& target, const std::string& number, const FolderCheck& check) {
  const StagedNames names = StagedNames::beside(target);
  const fs::path earlier = names.path(Staged::kReplaced, number);
  fs::rename(target, earlier);
  try {
    check(earlier);
    fs::rename(names.path(Staged::kPartial, number), target);
  } catch (...) {
    std::error_code ignored;
    fs::rename(earlier, target, ignored);
    throw;
  }
  clear_away(earlier);
}

void move_beside(const fs::path& target, const std::string& number, const FolderCheck& check) {
  const fs::path staging = StagedNames::beside(target).path(Staged::kPartial, number);
  for (int tries = 1; tries <= kMaxTries; ++tries) {
    std::error_code fault;
    if (!fs::exists(target, fault) || is_vacant(target)) {
      fs::rename(staging, target, fault);
      if (!fault) {
        return;
      }
      if (fault != std::errc::directory_not_empty && fault != std::errc::file_exists) {
        throw std::system_error(fault);
      }
      continue;  // another one was faster
    }
    const PathLock replacing(target, PathLock::Wait::kYes);  // nor must it look left behind while it is checked
    if (replacing.held() && !replacing.is_of(target)) {
      continue;
    }
    check(target);
    if (try_exchange(staging, target, check)) {
      clear_away(staging);
    } else {
      replace_in_two_steps(target, number, check);
    }
    return;
  }
  throw std::system_error(std::make_error_code(std::errc::device_or_resource_busy));
}

void move_within(const fs::path& target, const std::string& number, const std::string& marker,
                 const FolderCheck& check) {
  const StagedNames names = StagedNames::within(target);
  const fs::path partial = names.path(Staged::kPartial, number);
  const fs::path arriving = names.path(Staged::kArriving, number);
  const fs::path replaced = names.path(Staged::kReplaced, number);
  const PathLock moving(target, PathLock::Wait::kYes);
  check(target);
  const bool replacing = !is_vacant(target);
  try {
    if (replacing) {
      fs::create_directory(replaced);
      move_entries(target, replaced, marker, "");
      check(replaced);
    }
    fs::rename(partial, arriving);  // from here on the new result counts
  } catch (...) {
    if (replacing) {
      move_entries(replaced, target, "", marker);
      clear_away(replaced);
    }
    throw;
  }
  move_entries(arriving, target, "", marker);
  clear_away(arriving);
  clear_away(replaced);
}

bool has_checkpoint(const fs::path& folder, const ResultKind& kind) {
  std::error_code fault;
  return !kind.checkpoint.empty() && fs::is_regular_file(folder / kind.checkpoint, fault);
}

void remove_abandoned(const fs::path& folder, const ResultKind& kind) {
  for (const fs::path& left : partial_folders(folder)) {
    const PathLock lock(left);
    try {
      if (lock.is_of(left) && !has_checkpoint(left, kind) && !foreign_entry(left, kind)) {
        clear_away(left);
      }
    } catch (const DataError&) {
      // Whose content cannot be read is not ours.
    }
  }
}

void remove_leftovers(const fs::path& target) {
  try {
    settle_beside(target);
    settle_within(target);
  } catch (const std::system_error&) {
    // What is in the way is told when the place is checked.
  }
}

}  // namespace dynamic_icp::formats
