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
void clean_up_on_signals();

}  // namespace dynamic_icp::apps
