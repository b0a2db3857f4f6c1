// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <functional>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/conversion/conversion.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/messages.hpp"
#include "apps/progress.hpp"
#include "apps/result_kinds.hpp"
#include "apps/scan_selection.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string input;
  std::string to;
  std::string output;
  datasets::InputSettings settings;  ///< what was said about the input
  std::size_t start = 0;
  std::optional<std::size_t> max_frames;
  bool force = false;
  bool quiet = false;
};

std::string record_json(const ConvertOptions& options, const datasets::Dataset& dataset,
                        const datasets::ScanRange& selection, const std::vector<std::string>& left_out) {
  const nlohmann::ordered_json json = {{"version", version()},
                                       {"command", command_line()},
                                       {"input",
                                        {{"path", fs::absolute(options.input).string()},
                                         {"format", dataset.format()},
                                         {"options", datasets::texts(options.settings)},
                                         {"scans", dataset.size()}}},
                                       {"format", options.to},
                                       {"start", selection.begin},
                                       {"scans", selection.size()},
                                       {"ground_truth", dataset.ground_truth_file().string()},
                                       {"assumptions", dataset.assumptions()},
                                       {"notes", left_out}};
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Whether the output is one file rather than a folder.
bool is_file(const ConvertOptions& options) {
  return options.to == "mcap" && fs::path(options.output).extension() == ".mcap" && !fs::is_directory(options.output);
}

/// Throws DataError unless a file may be written there: nothing but an MCAP file is replaced, and never the input.
void check_output_file(const ConvertOptions& options, const std::vector<fs::path>& inputs) {
  const fs::path& output = options.output;
  std::error_code ignored;
  if (!fs::exists(output, ignored) || fs::is_other(output, ignored)) {
    return;
  }
  for (const fs::path& input : inputs) {
    if (!input.empty() && fs::equivalent(input, output, ignored)) {
      throw DataError(fmt::format("{}: is what is to be converted; choose another name", output.string()));
    }
  }
  if (!options.force) {
    throw formats::EarlierResult(fmt::format("{}: exists", output.string()));
  }
  if (formats::kind_of_file(output) != formats::FileKind::kMcap) {
    throw DataError(fmt::format("{}: cannot be replaced: it is no MCAP file; choose another name", output.string()));
  }
}

/// Each scan is read twice: one is done with every second reading, half of them when all were read once.
std::function<void()> every_second(Progress& progress) {
  return [&progress, readings = std::size_t{0}]() mutable {
    if (++readings % 2 == 0) {
      progress.advance();
    }
  };
}

/// Converts into a folder, or into one file.
std::vector<std::string> write_output(const ConvertOptions& options, conversion::Target target,
                                      const datasets::Dataset& dataset, const datasets::ScanRange& selection) {
  const std::vector<fs::path> inputs = {options.input, dataset.scan_file(selection.begin), dataset.ground_truth_file()};
  if (is_file(options)) {
    check_output_file(options, inputs);
    Progress progress("convert", selection.size(), options.quiet);
    return conversion::convert_to_mcap(dataset, selection, options.output, every_second(progress));
  }
  const formats::ResultKind kind = conversion_result();
  formats::OutputFolder output(options.output, kind, options.force, inputs);
  std::vector<std::string> notes = output.fill([&] {
    Progress progress("convert", selection.size(), options.quiet);
    std::vector<std::string> left_out =
        conversion::convert(dataset, selection, target, output.path(), every_second(progress));
    formats::write_whole_file(output.path() / kind.marker, record_json(options, dataset, selection, left_out));
    return left_out;
  });
  output.commit();
  return notes;
}

int convert(const ConvertOptions& options) {
  const conversion::Target target = conversion::find_target(options.to);
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(options.input, options.settings);
  const datasets::ScanRange selection = datasets::select_scans(*dataset, options.start, options.max_frames);
  if (!options.quiet) {
    for (const std::string& assumption : dataset->assumptions()) {
      tell("dynamic-icp: warning: {}\n", assumption);
    }
  }
  const std::vector<std::string> notes = write_output(options, target, *dataset, selection);
  if (!options.quiet) {
    for (const std::string& note : notes) {
      fmt::print("note         {}\n", note);
    }
    fmt::print("scans        {}, {} to {}\n", selection.size(), dataset->format(), options.to);
    fmt::print("written to   {}\n", options.output);
  }
  return 0;
}

}  // namespace

void add_convert_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app.add_subcommand("convert", "Write a recording in another layout");
  command->add_option("INPUT", options->input, "Folder or file of the recording")->required();
  command->add_option("--to", options->to, "Layout to write: dicp, npz, pcd, ply or mcap")
      ->required()
      ->type_name("NAME");
  command
      ->add_option("-o,--output", options->output,
                   "Folder for the result, which must be new or empty; with --to mcap also a new file FILE.mcap")
      ->required()
      ->type_name("DIR");
  add_input_options(*command, options->settings);
  add_selection_options(*command, "convert", options->start, options->max_frames);
  command->add_flag("--force", options->force,
                    "Replace an earlier conversion in DIR, which may hold nothing else, or FILE.mcap");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &selected] { selected = [options] { return convert(*options); }; });
}

}  // namespace dynamic_icp::apps
