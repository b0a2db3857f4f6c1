// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

// Children of this process. Starting one gives SIGCHLD its default action.
namespace dynamic_icp::benchmark {

/// Starts a program with these arguments, its messages (standard error) going to a file, its standard output nowhere.
/// The child ends when this process ends, however that happens. Throws DataError when
/// no process can be started; a program that cannot be executed ends with status 127.
pid_t start_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& messages);

/// How a child ended.
struct EndedChild {
  pid_t pid = -1;
  int exit_status = -1;  ///< -1 when it was killed
  int signal = 0;        ///< that killed it; 0: none
  double peak_memory_mib = 0.0;

  [[nodiscard]] bool succeeded() const { return exit_status == 0; }
};

/// Waits until any child of this process ends. Throws DataError when there is none.
EndedChild wait_for_child();

/// Runs `work` in a forked child, so that its memory is its own, and returns the text it made. An exception of the
/// child is thrown here as DataError with its message (UsageError stays one); so is a child that was killed. This
/// process must have no other threads.
std::string text_of_child(const std::function<std::string()>& work);

/// What a program writes to its standard output. Throws DataError when it cannot be run or fails.
std::string output_of_program(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace dynamic_icp::benchmark
