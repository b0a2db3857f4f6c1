// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include <CLI/CLI.hpp>

namespace dynamic_icp::apps {

/// The help of the program and of its commands: wrapped for a terminal, with one long name an option. Its other names
/// are those of other programs.
class HelpFormat final : public CLI::Formatter {
 public:
  /// Width 0: nothing is wrapped.
  explicit HelpFormat(std::size_t width) : width_(width) {}

  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  [[nodiscard]] std::string entry(const std::string& name, const std::string& description) const;

  std::size_t width_;
};

}  // namespace dynamic_icp::apps
