// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/wrong_words.hpp"

#include <algorithm>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"

namespace dynamic_icp::apps {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> long_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

bool is_number(const std::string& word) { return word.find_first_not_of("-0123456789.eE") == std::string::npos; }

/// The option that was probably meant: one that begins with what was typed, else one that is spelled alike.
std::string_view meant_option(const std::string& typed, const std::vector<std::string>& known) {
  constexpr std::size_t kTelling = 4;  // two letters behind the dashes
  for (const std::string& name : known) {
    if (typed.size() >= kTelling && name.starts_with(typed)) {
      return name;
    }
  }
  return close_key(typed, known);
}

/// The first option that the command does not have.
std::optional<std::string> unknown_option(const CLI::App& command) {
  const std::vector<std::string> known = long_names(command);
  for (const std::string& word : command.remaining()) {
    if (word.size() > 1 && word.starts_with('-') && !is_number(word)) {
      const std::string name = word.substr(0, word.find('='));
      const std::string_view nearest = meant_option(name, known);
      return fmt::format("'{}' has no option '{}'{}", command.get_name(), name,
                         nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
    }
  }
  return std::nullopt;
}

}  // namespace

void refuse_unknown_command(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || words.front().starts_with('-')) {
    return;
  }
  const std::vector<std::string> known = command_names(app);
  if (std::find(known.begin(), known.end(), words.front()) == known.end()) {
    throw UsageError(fmt::format("unknown command '{}'{}; known are: {}", words.front(),
                                 did_you_mean(words.front(), known), fmt::join(known, ", ")));
  }
}

void refuse_single_dashes(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<const CLI::App*> commands = app.get_subcommands(
      [&](const CLI::App* command) { return !words.empty() && command->get_name() == words.front(); });
  if (commands.empty()) {
    return;
  }
  const CLI::App* const command = commands.front();
  const std::vector<std::string> known = long_names(*command);
  for (const std::string& word : words) {
    const std::string name = "-" + word.substr(0, word.find('='));
    if (name.starts_with("--") && std::find(known.begin(), known.end(), name) != known.end()) {
      throw UsageError(fmt::format("'{}' has no option '{}'; did you mean '{}'?; see 'dynamic-icp {} --help'",
                                   command->get_name(), name.substr(1), name, command->get_name()));
    }
  }
}

std::string explanation(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> chosen =
      app.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  std::string text = error.what();
  if (const auto unknown = unknown_option(command)) {
    text = *unknown;
  } else if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    text = fmt::format("'{}' takes no further arguments: '{}'", command.get_name(),
                       fmt::join(command.remaining(), "', '"));
  }
  return fmt::format("{}; see 'dynamic-icp{} --help'", text, &command == &app ? "" : " " + command.get_name());
}

}  // namespace dynamic_icp::apps
