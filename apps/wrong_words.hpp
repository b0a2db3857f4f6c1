// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

// What a mistyped command line is told.
namespace dynamic_icp::apps {

/// Throws UsageError for a first word that is neither an option nor a command, with the command that was probably
/// meant.
void refuse_unknown_command(const CLI::App& app, const std::vector<std::string>& words);

/// Throws UsageError for the name of an option of the command behind one dash instead of two: `-output OUT` would be
/// read as the option `-o` with the value `utput`.
void refuse_single_dashes(const CLI::App& app, const std::vector<std::string>& words);

/// What is wrong with a command line that could not be read, and which command explains it. An unknown option comes
/// before a missing one: mistyped, it is both.
std::string explanation(const CLI::App& app, const CLI::ParseError& error);

}  // namespace dynamic_icp::apps
