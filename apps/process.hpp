// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

// The program as a process among others.
namespace dynamic_icp::apps {

/// Puts /dev/null in the place of standard streams that are closed: the next file to be opened would take their place,
/// and what is printed would go into it. To be called before any file is opened.
void open_standard_streams();

/// Lets the signals that ask a program to end (interrupt, terminate, hang-up, broken pipe) remove unfinished files and
/// folders before they end it. Those that are ignored stay so. To be called by the main thread, the one that writes.
/// Files that outgrow their limit are no signal any more.
void clean_up_on_signals();

/// Where memory ends in what cannot fail (destructors of the JSON library need some, so do directory iterators), the
/// program still says so, cleans up and ends with the status of a failed machine.
void clean_up_without_memory();

/// Lets the stack of the main thread take the memory that the deepest call needs, once. The system gives it page by
/// page as calls go deeper, and where no memory is left then, it ends the program by a signal without a word.
void reserve_stack();

/// As long as this object lives, the first interrupt or terminate ends nothing: it is only noted, for work that can
/// stop between two steps and keep what it has. A second one cleans up and ends the program. One object at a time.
class StopOnSignal {
 public:
  /// Writes `notice` to standard error when the first signal comes; it must live as long.
  explicit StopOnSignal(const char* notice);
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// The signal that came, 0 where none has.
  [[nodiscard]] static int signal();
};

}  // namespace dynamic_icp::apps
