// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/output_folder.hpp"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/folder_moves.hpp"
#include "dynamic_icp/recording/formats/staged_names.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_fault(const fs::path& path, const char* action, const std::error_code& fault) {
  throw DataError(fmt::format("{}: cannot {}: {}", path.string(), action, fault.message()));
}

/// An empty name would be that of the working directory.
fs::path named(const fs::path& path) {
  if (path.empty()) {
    throw UsageError("the folder for the results is '', expected a name");
  }
  return path;
}

/// The path without links as far as it exists, and without a trailing slash, so that parent and name are well defined.
fs::path resolved(const fs::path& path) {
  std::error_code fault;
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const fs::path bare = absolute.has_filename() ? absolute : absolute.parent_path();
  if (fs::is_symlink(bare, fault) && !fs::exists(bare, fault)) {
    throw DataError(
        fmt::format("{}: is a link to {}, which is not there", path.string(), fs::read_symlink(bare, fault).string()));
  }
  const fs::path canonical = fs::weakly_canonical(fs::absolute(path), fault);
  if (fault) {
    return bare;  // what is wrong shows when it is made
  }
  return canonical.has_filename() ? canonical : canonical.parent_path();
}

/// Lets the signals that ask to end wait.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t asking;
    ::sigemptyset(&asking);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      ::sigaddset(&asking, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &asking, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_ = {};
};

}  // namespace

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

OutputFolder::OutputFolder(const fs::path& path, const ResultKind& kind, bool replace,
                           const std::vector<fs::path>& inputs, Leftover leftover)
    : named_(named(path)), final_(resolved(path)), kind_(kind), replace_(replace), within_(must_stay(final_)) {
  look_for_checkpoint(leftover == Leftover::kTakeOver);
  remove_leftovers(final_);
  if (!within_) {
    remove_abandoned(final_.parent_path(), kind_);
  }
  refuse_if_within(inputs);
  check_final();
  if (staging_.empty()) {
    make_staging();
  }
}

OutputFolder::~OutputFolder() {
  if (lock_ && !is_kept_) {  // not after commit(): the name may be another one's by now
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
  }
}

void OutputFolder::check_final() const {
  while (true) {
    const PathLock looking(final_, PathLock::Wait::kYes);  // who replaces it may do so first
    if (!looking.held() || looking.is_of(final_)) {
      check_replaceable(final_);
      return;
    }
  }
}

void OutputFolder::check_replaceable(const fs::path& folder) const {
  std::error_code fault;
  const fs::file_status status = fs::status(folder, fault);
  if (status.type() == fs::file_type::not_found) {
    return;
  }
  if (status.type() != fs::file_type::directory) {
    throw DataError(fmt::format("{}: exists and is not a folder", named_.string()));
  }
  try {
    if (is_vacant(folder)) {
      return;
    }
  } catch (const fs::filesystem_error& error) {
    throw_fault(named_, "read", error.code());
  }
  if (!fs::exists(folder / kind_.marker, fault)) {
    throw DataError(
        fmt::format("{}: folder is not empty and holds no {}; choose another one", named_.string(), kind_.marker));
  }
  if (!replace_) {
    throw EarlierResult(fmt::format("{}: folder holds an earlier result ({})", named_.string(), kind_.marker));
  }
  if (const auto foreign = foreign_entry(folder, kind_)) {
    throw DataError(
        fmt::format("{}: cannot be replaced: {} is no file of such a result; move it away or choose another folder",
                    named_.string(), (named_ / foreign->lexically_relative(folder)).string()));
  }
}

void OutputFolder::refuse_if_within(const std::vector<fs::path>& inputs) const {
  std::error_code fault;
  if (!fs::exists(final_ / kind_.marker, fault)) {
    return;  // nothing will be replaced
  }
  for (const fs::path& input : inputs) {
    if (!input.empty() && lies_in(fs::weakly_canonical(fs::absolute(input), fault), final_)) {
      throw UsageError(
          fmt::format("{}: cannot be replaced: the input {} lies in it; choose another folder for the output",
                      named_.string(), input.string()));
    }
  }
  const fs::path working = fs::current_path(fault);
  if (!fault && working != final_ && lies_in(working, final_)) {
    throw UsageError(
        fmt::format("{}: cannot be replaced from {}, which lies in it", named_.string(), working.string()));
  }
}

void OutputFolder::keep() {
  is_kept_ = true;
  unfinished_.reset();
}

void OutputFolder::drop() {
  if (is_kept_) {
    is_kept_ = false;
    unfinished_ = std::make_unique<Unfinished>(staging_);
  }
}

/// Takes over a partial result at the same place that has one.
void OutputFolder::look_for_checkpoint(bool take_over) {
  const StagedNames names = within_ ? StagedNames::within(final_) : StagedNames::beside(final_);
  for (const StagedNames::Found& left : names.found()) {
    std::error_code ignored;
    if (left.state != Staged::kPartial || fs::symlink_status(left.path, ignored).type() != fs::file_type::directory ||
        !has_checkpoint(left.path, kind_) ||
        fs::exists(names.path(Staged::kReplaced, left.number), ignored)) {  // was about to come into place
      continue;
    }
    auto lock = std::make_unique<PathLock>(left.path);
    if (lock->taken() && take_over) {
      throw DataError(fmt::format("{}: another process is writing this result", named_.string()));
    }
    if (!lock->is_of(left.path)) {
      continue;
    }
    had_checkpoint_ = true;
    if (take_over) {
      number_ = left.number;
      staging_ = left.path;
      lock_ = std::move(lock);
      is_kept_ = true;
      return;
    }
  }
}

void OutputFolder::make_staging() {
  const StagedNames names = within_ ? StagedNames::within(final_) : StagedNames::beside(final_);
  std::error_code fault;
  if (!within_) {
    fs::create_directories(final_.parent_path(), fault);
  }
  // Writers in two containers may have the same number.
  for (auto number = static_cast<unsigned long>(::getpid()); !fault; ++number) {
    number_ = std::to_string(number);
    const fs::path staging = names.path(Staged::kPartial, number_);
    if (::mkdir(staging.c_str(), 0777) != 0) {
      if (errno != EEXIST) {
        fault.assign(errno, std::generic_category());
      }
      continue;
    }
    lock_ = std::make_unique<PathLock>(staging);
    // Until it is locked, another one may take it for left behind.
    std::error_code ignored;
    const bool there = lock_->held() ? lock_->is_of(staging) : !lock_->taken() && fs::exists(staging, ignored);
    if (!there) {
      continue;
    }
    staging_ = staging;
    unfinished_ = std::make_unique<Unfinished>(staging_);
    return;
  }
  throw_fault(named_, "create", fault);
}

void OutputFolder::commit() {
  const SignalsHeld held;
  const FolderCheck check = [this](const fs::path& folder) { check_replaceable(folder); };
  unfinished_.reset();
  try {
    if (within_) {
      move_within(final_, number_, kind_.marker, check);
    } else {
      move_beside(final_, number_, check);
    }
  } catch (const std::system_error& error) {
    throw_fault(named_, "create", error.code());
  }
  lock_.reset();
}

std::string OutputFolder::in_final_names(std::string message) const {
  const std::string staging = staging_.string();
  const std::string user = named_.has_filename() ? named_.string() : named_.parent_path().string();
  for (std::size_t at = 0; (at = message.find(staging, at)) != std::string::npos; at += user.size()) {
    message.replace(at, staging.size(), user);
  }
  return message;
}

}  // namespace dynamic_icp::formats
