// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynamic_icp::apps {

/// Keeps the words the program was started with; called once, first thing in main.
void remember_command_line(int argc, const char* const* argv);

/// The command as a shell would take it again, for the record in run.json.
const std::string& command_line();

}  // namespace dynamic_icp::apps
