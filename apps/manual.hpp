// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

// Man pages, made of the options that the commands declare: no second text to keep.
namespace dynamic_icp::apps {

/// What a command does in one sentence without its full stop.
std::string summary_of(const CLI::App& command);

/// The page of the program or of one of its commands, for troff with the macros of man(7).
std::string man_page(const CLI::App& app, const CLI::App& command);

}  // namespace dynamic_icp::apps
