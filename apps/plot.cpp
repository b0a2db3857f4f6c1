// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/figures/run_context.hpp"
#include "dynamic_icp/figures/run_figures.hpp"
#include "dynamic_icp/formats/binary_file.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

#include "apps/commands.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

struct PlotOptions {
  std::string run_folder;
  std::string output;
  std::optional<std::int64_t> frame;
  std::string theme = "light";
};

drawing::Theme theme_of(const std::string& name) {
  if (name != "light" && name != "dark") {
    throw UsageError(fmt::format("--theme is '{}', expected light or dark", name));
  }
  return drawing::theme(name == "light" ? drawing::Ground::kLight : drawing::Ground::kDark);
}

int plot(const PlotOptions& options) {
  const drawing::Theme theme = theme_of(options.theme);
  if (options.frame && *options.frame < 0) {
    throw UsageError(fmt::format("--frame is {}, expected 0 or more", *options.frame));
  }
  const figures::RunFiles run = figures::read_run(options.run_folder);
  const std::optional<std::size_t> frame =
      options.frame ? std::optional(static_cast<std::size_t>(*options.frame)) : std::nullopt;
  const figures::RunContext context = figures::read_context(run, frame);
  const fs::path folder = options.output.empty() ? run.folder / "plots" : fs::path(options.output);
  formats::make_folder(folder);
  for (const figures::Figure& figure : figures::draw_figures(run, context, theme)) {
    const fs::path file = folder / (figure.name + ".svg");
    formats::write_whole_file(file, figure.svg.document());
    fmt::print("{}\n", file.string());
  }
  for (const std::string& note : context.notes) {
    fmt::print("note: {}\n", note);
  }
  return 0;
}

}  // namespace

void add_plot_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* command = app.add_subcommand("plot", "Draw trajectory, errors, speed and a scan of a run as SVG");
  command->add_option("DIR", options->run_folder, "Folder of a run")->required();
  command->add_option("--output", options->output, "Folder for the pictures (default: DIR/plots)")->type_name("DIR2");
  command
      ->add_option("--frame", options->frame,
                   "Which scan to draw: line of frames.jsonl, counted from 0 (default: the one with most points on "
                   "moving objects)")
      ->type_name("N");
  command->add_option("--theme", options->theme, "Background of the pictures: light or dark (default light)")
      ->type_name("NAME");
  command->callback([options, &selected] { selected = [options] { return plot(*options); }; });
}

}  // namespace dynamic_icp::apps
