// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/help_format.hpp"

#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kFooterIndent = 4;

}  // namespace

std::string HelpFormat::make_option_name(const CLI::Option* option, bool is_positional) const {
  if (is_positional || option->get_lnames().empty()) {
    return CLI::Formatter::make_option_name(option, is_positional);
  }
  const std::string name = "--" + option->get_lnames().front();
  return option->get_snames().empty() ? name : "-" + option->get_snames().front() + "," + name;
}

std::string HelpFormat::entry(const std::string& name, const std::string& description) const {
  std::string text = "  " + name;
  if (!description.empty()) {
    text += text.size() >= column_width_ ? "\n" + std::string(column_width_, ' ')
                                         : std::string(column_width_ - text.size(), ' ');
    text += description;
  }
  return wrapped(text, width_, column_width_) + "\n";
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpFormat::make_description(const CLI::App* app) const {
  return wrapped(CLI::Formatter::make_description(app), width_, 0);
}

std::string HelpFormat::make_footer(const CLI::App* app) const {
  return wrapped(CLI::Formatter::make_footer(app), width_, kFooterIndent);
}

}  // namespace dynamic_icp::apps
