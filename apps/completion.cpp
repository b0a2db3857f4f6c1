// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"

#include "apps/commands.hpp"
#include "apps/manual.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr const char* kHelpMeaning = "Explain a command";
constexpr const char* kVersionMeaning = "Print the version and how the program was built";

/// All names of an option: "--output", "-o".
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) {
    names.push_back("--" + name);
  }
  for (const std::string& name : option.get_snames()) {
    names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string> more = names_of(*option);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

std::vector<std::string> first_words(const CLI::App& app) {
  std::vector<std::string> words = {"help", "version"};
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    words.push_back(command->get_name());
  }
  const std::vector<std::string> options = names_of_options(app);
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

/// Text between single quotes of a zsh specification, in which these characters mean something.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
    } else {
      escaped += std::string(c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + c;
    }
  }
  return escaped;
}

bool takes_value(const CLI::Option& option) { return option.get_type_size() != 0; }

std::string zsh_option(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string action = type.starts_with("DIR") ? "_files -/" : type.starts_with("FILE") ? "_files" : " ";
  std::string lines;
  for (const std::string& name : names_of(option)) {
    lines += fmt::format("        '{}{}[{}]{}' \\\n", option.get_expected_max() > 1 ? "*" : "", name,
                         zsh_text(option.get_description()),
                         takes_value(option) ? fmt::format(":{}:{}", zsh_text(type), action) : "");
  }
  return lines;
}

std::string bash_completion(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    cases += fmt::format("    {}) words='{}' ;;\n", command->get_name(), fmt::join(names_of_options(*command), " "));
  }
  // No words: names of files, by -o default.
  return fmt::format(R"(# Completion of dynamic-icp for bash, made by 'dynamic-icp completion bash'.
_dynamic_icp() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words=
  if [[ $COMP_CWORD -eq 1 || ( $COMP_CWORD -eq 2 && ${{COMP_WORDS[1]}} == help ) ]]; then
    COMPREPLY=($(compgen -W '{}' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  COMPREPLY=()
  [[ $word != -* ]] || COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _dynamic_icp dynamic-icp
)",
                     fmt::join(first_words(app), " "), cases);
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands;
  std::string cases;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), zsh_text(summary_of(*command)));
    cases += fmt::format("    {})\n      _arguments \\\n", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      if (!option->get_positional()) {
        cases += zsh_option(*option);
      }
    }
    cases += "        '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef dynamic-icp
# Completion of dynamic-icp for zsh, made by 'dynamic-icp completion zsh'.
_dynamic_icp() {{
  local -a commands=(
{}    'help:{}'
    'version:{}'
  )
  if (( CURRENT == 2 )) || [[ CURRENT -eq 3 && $words[2] == help ]]; then
    _describe command commands
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{}  esac
}}
_dynamic_icp "$@"
)",
                     commands, kHelpMeaning, kVersionMeaning, cases);
}

/// Text between single quotes of fish.
std::string fish_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  }
  return escaped;
}

std::string fish_option(const std::string& condition, const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_lnames()) {
    names += " -l " + name;
  }
  for (const std::string& name : option.get_snames()) {
    names += " -s " + name;
  }
  return fmt::format("complete -c dynamic-icp -n '{}'{}{} -d '{}'\n", condition, names,
                     takes_value(option) ? " -r" : "", fish_text(option.get_description()));
}

std::string fish_completion(const CLI::App& app) {
  const std::string first = "__fish_use_subcommand";
  std::string script = "# Completion of dynamic-icp for fish, made by 'dynamic-icp completion fish'.\n";
  const auto add_word = [&](const std::string& word, const std::string& meaning) {
    script += fmt::format("complete -c dynamic-icp -n '{}' -f -a {} -d '{}'\n", first, word, fish_text(meaning));
  };
  add_word("help", kHelpMeaning);
  add_word("version", kVersionMeaning);
  for (const CLI::Option* option : app.get_options()) {
    script += fish_option(first, *option);
  }
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    add_word(command->get_name(), summary_of(*command));
    for (const CLI::Option* option : command->get_options()) {
      if (!option->get_positional()) {
        script += fish_option("__fish_seen_subcommand_from " + command->get_name(), *option);
      }
    }
  }
  return script;
}

struct Shell {
  const char* name;
  std::string (*completion)(const CLI::App&);
};

constexpr Shell kShells[] = {{"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}};

}  // namespace

void add_completion_command(CLI::App& app, std::function<int()>& selected) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "Print what completes commands, options and files in a shell: source it");
  command->add_option("SHELL", *name, "bash, zsh or fish")->required();
  command->callback([&app, name, &selected] {
    selected = [&app, name] {
      for (const Shell& shell : kShells) {
        if (*name == shell.name) {
          fmt::print("{}", shell.completion(app));
          return 0;
        }
      }
      throw UsageError(fmt::format("no completion for the shell '{}'; expected bash, zsh or fish", *name));
    };
  });
}

}  // namespace dynamic_icp::apps
