// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStaging = ".partial-";
constexpr const char* kReplaced = ".replaced-";

[[noreturn]] void throw_fault(const fs::path& path, const char* action, const std::error_code& fault) {
  throw DataError(fmt::format("{}: cannot {}: {}", path.string(), action, fault.message()));
}

/// The final path without a trailing slash, absolute, so that its parent and name are well defined.
fs::path normalised(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

void check_replaceable(const fs::path& path, const std::string& marker, bool replace) {
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found) {
    return;
  }
  if (status.type() != fs::file_type::directory) {
    throw DataError(fmt::format("{}: exists and is not a folder", path.string()));
  }
  const bool empty = fs::is_empty(path, fault);
  if (fault) {
    throw_fault(path, "read", fault);
  }
  if (empty) {
    return;
  }
  const bool ours = fs::exists(path / marker, fault);
  if (!ours) {
    throw DataError(fmt::format("{}: folder is not empty and holds no {}; choose another one", path.string(), marker));
  }
  if (!replace) {
    throw DataError(
        fmt::format("{}: folder holds an earlier result ({}); use --force to replace it", path.string(), marker));
  }
}

/// Opens a folder and locks it; -1 when it cannot be locked. The lock ends with the process, however that ends.
int lock_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return -1;
  }
  return descriptor;
}

/// Removes staging folders that no running process holds.
void remove_leftovers(const fs::path& final_path) {
  const std::string prefix = "." + final_path.filename().string() + kStaging;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(final_path.parent_path(), fault)) {
    if (entry.path().filename().string().starts_with(prefix)) {
      const int lock = lock_folder(entry.path());
      if (lock >= 0) {
        std::error_code ignored;
        fs::remove_all(entry.path(), ignored);
        ::close(lock);
      }
    }
  }
}

fs::path sibling(const fs::path& path, const char* kind) {
  return path.parent_path() / fmt::format(".{}{}{}", path.filename().string(), kind, ::getpid());
}

/// An empty name would be that of the working directory.
fs::path named(const fs::path& path) {
  if (path.empty()) {
    throw UsageError("the folder for the results is '', expected a name");
  }
  return normalised(path);
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& final_path, const std::string& marker, bool replace)
    : final_(named(final_path)), staging_(sibling(final_, kStaging)), marker_(marker), replace_(replace) {
  check_replaceable(final_, marker_, replace_);
  remove_leftovers(final_);
  std::error_code fault;
  fs::create_directories(staging_, fault);
  if (fault) {
    throw_fault(final_, "create", fault);
  }
  lock_ = lock_folder(staging_);
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) {
    ::close(lock_);
  }
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void OutputFolder::commit() {
  check_replaceable(final_, marker_, replace_);
  std::error_code fault;
  const fs::path earlier = sibling(final_, kReplaced);
  const bool replacing = fs::exists(final_ / marker_, fault);
  if (replacing) {
    fs::rename(final_, earlier, fault);
    if (fault) {
      throw_fault(final_, "replace", fault);
    }
  }
  fs::rename(staging_, final_, fault);
  if (fault) {
    const std::error_code reason = fault;
    if (replacing) {
      fs::rename(earlier, final_, fault);
    }
    throw_fault(final_, "create", reason);
  }
  if (replacing) {
    fs::remove_all(earlier, fault);
  }
}

}  // namespace dynamic_icp::formats
