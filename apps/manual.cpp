// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/manual.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/version.hpp"

#include "apps/commands.hpp"
#include "apps/help_format.hpp"

namespace dynamic_icp::apps {
namespace {

/// Text of which troff takes nothing for a request or an escape.
std::string troff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    const bool begins_line = escaped.empty() || escaped.back() == '\n';
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if (begins_line && (c == '.' || c == '\'')) {
      escaped += fmt::format("\\&{}", c);
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string entry(const std::string& name, const std::string& description) {
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(name), troff(description));
}

/// Paragraphs, and the rows of tables of settings: "  key   what it means".
std::string paragraphs(const std::string& text) {
  std::string page;
  bool in_table = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_row = line.starts_with("  ");
    if (is_row) {
      const std::size_t key_end = std::min(line.find(' ', 2), line.size());
      const std::size_t meaning = std::min(line.find_first_not_of(' ', key_end), line.size());
      page += entry(line.substr(2, key_end - 2), line.substr(meaning));
    } else {
      page += (line.empty() || in_table ? ".PP\n" : "") + (line.empty() ? "" : troff(line) + "\n");
    }
    in_table = is_row;
  }
  return page;
}

std::string options_section(const CLI::App& command, const char* title, bool positional) {
  const HelpFormat format(0);
  std::string entries;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() == positional) {
      entries += entry(format.make_option_name(option, positional) + format.make_option_opts(option),
                       option->get_description());
    }
  }
  return entries.empty() ? "" : fmt::format(".SH {}\n{}", title, entries);
}

std::string page_name(const CLI::App& app, const CLI::App& command) {
  return &command == &app ? app.get_name() : fmt::format("{}-{}", app.get_name(), command.get_name());
}

std::string usage(const CLI::App& app, const CLI::App& command) {
  if (&command == &app) {
    return fmt::format("{} COMMAND [OPTIONS]", app.get_name());
  }
  std::string text = fmt::format("{} {} [OPTIONS]", app.get_name(), command.get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      text += option->get_required() ? fmt::format(" {}", option->get_name(true))
                                     : fmt::format(" [{}]", option->get_name(true));
    }
  }
  return text;
}

std::string see_also(const CLI::App& app, const CLI::App& command) {
  if (&command != &app) {
    return fmt::format(".BR {} (1)\n", troff(app.get_name()));
  }
  std::string pages;
  for (const CLI::App* listed : app.get_subcommands(nullptr)) {
    pages += fmt::format("{}.BR {} (1)", pages.empty() ? "" : " ,\n", troff(page_name(app, *listed)));
  }
  return pages + "\n";
}

struct ManualOptions {
  std::string command;  ///< empty: the program
  bool list = false;
};

std::string manual(const CLI::App& app, const ManualOptions& options) {
  if (options.command.empty() && !options.list) {
    return man_page(app, app);
  }
  std::string names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == options.command) {
      return man_page(app, *command);
    }
    names += command->get_name() + "\n";
  }
  if (!options.list) {
    throw UsageError(
        fmt::format("the manual has no page of a command '{}'; --list shows those it has", options.command));
  }
  return names;
}

}  // namespace

std::string summary_of(const CLI::App& command) {
  const std::string text = command.get_description();
  return text.substr(0, text.find(". "));
}

std::string man_page(const CLI::App& app, const CLI::App& command) {
  const std::string name = page_name(app, command);
  std::string upper = name;
  for (char& c : upper) {
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  std::string page = fmt::format(".TH {} 1 \"\" \"dynamic-icp {}\" \"User Commands\"\n", troff(upper), version());
  page += fmt::format(".SH NAME\n{} \\- {}\n", troff(name), troff(summary_of(command)));
  page += fmt::format(".SH SYNOPSIS\n.B {}\n", troff(usage(app, command)));
  page += fmt::format(".SH DESCRIPTION\n{}", paragraphs(command.get_description() + ".\n"));
  if (&command == &app) {
    page += ".SH COMMANDS\n";
    for (const CLI::App* listed : app.get_subcommands(nullptr)) {
      page += entry(listed->get_name(), listed->get_description());
    }
  }
  page += options_section(command, "ARGUMENTS", true);
  page += options_section(command, "OPTIONS", false);
  if (const std::string notes = command.get_footer(); !notes.empty()) {
    page += fmt::format(".SH NOTES\n{}", paragraphs(notes));
  }
  return page + fmt::format(".SH SEE ALSO\n{}", see_also(app, command));
}

void add_manual_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ManualOptions>();
  CLI::App* command =
      app.add_subcommand("manual", "Print a page of the manual, as man takes it: dynamic-icp manual run | man -l -");
  command->add_option("COMMAND", options->command, "Command that the page is about (default: the program)");
  command->add_flag("--list", options->list, "List the commands that have a page and end");
  command->callback([&app, options, &selected] {
    selected = [&app, options] {
      fmt::print("{}", manual(app, *options));
      return 0;
    };
  });
}

}  // namespace dynamic_icp::apps
