// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
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

/// Waits until a child of this process ends; any of them without its number. Throws DataError when there is none.
EndedChild wait_for_child(pid_t child = -1);

/// Forks: gives 0 in the child. Throws DataError when no process can be started.
pid_t fork_child();

}  // namespace dynamic_icp::benchmark
