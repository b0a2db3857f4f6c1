// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/figures/object_figure.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"
#include "dynamic_icp/tools/figures/run_figures.hpp"
#include "dynamic_icp/tools/figures/step_figure.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"

#include "apps/commands.hpp"
#include "apps/options.hpp"
#include "apps/svg_rendering.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kMinScale = 0.25;
constexpr double kMaxScale = 8.0;

struct PlotOptions {
  std::vector<std::string> folders;
  std::string output;
  std::optional<std::int64_t> frame;
  std::optional<std::int64_t> pair;
  std::int64_t worst_objects = 0;
  std::string theme = "light";
  std::string format = "svg";
  double scale = 2.0;
  bool paper = false;

  [[nodiscard]] figures::Medium medium() const { return paper ? figures::Medium::kPaper : figures::Medium::kScreen; }
};

drawing::Theme theme_of(const std::string& name) {
  if (name != "light" && name != "dark") {
    throw UsageError(fmt::format("--theme is '{}', expected light or dark", name));
  }
  return drawing::theme(name == "light" ? drawing::Ground::kLight : drawing::Ground::kDark);
}

/// What is drawn, and what was left out.
struct Pictures {
  std::vector<figures::Figure> figures;
  std::vector<std::string> notes;
};

drawing::Svg steps_of_pair(const runs::RunFiles& run, std::int64_t source, const drawing::Theme& theme,
                           figures::Medium medium) {
  if (source < 0) {
    throw UsageError(fmt::format("--pair is {}, expected 0 or more", source));
  }
  std::vector<std::string> notes;
  const std::unique_ptr<datasets::Dataset> recording = figures::open_recording(run, notes);
  if (recording == nullptr) {
    throw DataError(notes.back());
  }
  drawing::Svg steps = figures::step_figure(
      run, figures::read_pair(run, *recording, static_cast<std::size_t>(source), Workers()), theme, medium);
  if (medium == figures::Medium::kPaper) {
    steps.set_px_per_mm(figures::kPaperPxPerMm);
  }
  return steps;
}

Pictures pictures_of_run(const PlotOptions& options, const drawing::Theme& theme) {
  if (options.frame && *options.frame < 0) {
    throw UsageError(fmt::format("--frame is {}, expected 0 or more", *options.frame));
  }
  if (options.worst_objects < 0) {
    throw UsageError(fmt::format("--worst-objects is {}, expected 0 or more", options.worst_objects));
  }
  const runs::RunFiles run = runs::read_run(options.folders.front());
  const std::optional<std::size_t> frame =
      options.frame ? std::optional(static_cast<std::size_t>(*options.frame)) : std::nullopt;
  const figures::RunContext context = figures::read_context(run, frame);
  Pictures pictures{figures::draw_figures(run, context, theme, options.medium()), context.notes};
  if (options.pair) {
    pictures.figures.push_back({"steps", steps_of_pair(run, *options.pair, theme, options.medium())});
  }
  if (options.worst_objects > 0) {
    auto worst = figures::draw_worst_objects(run, static_cast<std::size_t>(options.worst_objects), theme);
    std::move(worst.begin(), worst.end(), std::back_inserter(pictures.figures));
  }
  return pictures;
}

/// Paths can be drawn over each other when they are of the same drive and begin with the same scan.
void check_comparable(const std::vector<runs::RunFiles>& runs) {
  for (const runs::RunFiles& run : runs) {
    const std::string input = runs::text_of(runs.front().run, "input.path");
    if (runs::text_of(run.run, "input.path") != input || run.frames.empty() || runs.front().frames.empty() ||
        run.frames.front().index != runs.front().frames.front().index) {
      throw UsageError(
          fmt::format("{} and {} are no runs over the same recording from the same scan on: they cannot be "
                      "drawn over each other",
                      runs.front().folder.string(), run.folder.string()));
    }
  }
}

Pictures pictures_of_runs(const PlotOptions& options, const drawing::Theme& theme) {
  if (options.frame || options.pair || options.worst_objects != 0) {
    throw UsageError("--frame, --pair and --worst-objects are for the pictures of one run");
  }
  std::vector<runs::RunFiles> runs;
  for (const std::string& folder : options.folders) {
    runs.push_back(runs::read_run(folder));
  }
  check_comparable(runs);
  const std::vector<std::string> names = report::distinguishing_names(runs);
  Pictures pictures;
  std::vector<figures::ComparedRun> compared;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::vector<std::string> notes;
    const std::unique_ptr<datasets::Dataset> recording = figures::open_recording(runs[k], notes);
    std::optional<figures::RunTruth> truth = figures::read_truth(runs[k], recording.get(), notes);
    compared.push_back({names[k], std::move(runs[k]), std::move(truth)});
  }
  pictures.figures = figures::draw_comparison(compared, theme, options.medium());
  return pictures;
}

int plot(const PlotOptions& options) {
  const drawing::Theme theme = theme_of(options.theme);
  if (!(options.scale >= kMinScale && options.scale <= kMaxScale)) {
    throw UsageError(fmt::format("--scale is {}, expected {} to {}", options.scale, kMinScale, kMaxScale));
  }
  const Pictures pictures =
      options.folders.size() == 1 ? pictures_of_run(options, theme) : pictures_of_runs(options, theme);
  const fs::path folder =
      options.output.empty() ? fs::path(options.folders.front()) / "plots" : fs::path(options.output);
  formats::make_folder(folder);
  const auto write = [&](const std::string& name, const std::string& content) {
    formats::write_whole_file(folder / name, content);
    fmt::print("{}\n", (folder / name).string());
  };
  const auto is_asked_for = [&](const std::string& format) {
    return options.format == format || options.format == "all" || (options.format == "both" && format != "pdf");
  };
  // First those that need nothing: they are there whatever becomes of the others.
  for (const figures::Figure& figure : pictures.figures) {
    if (is_asked_for("svg")) {
      write(figure.name + ".svg", figure.svg.document());
    }
  }
  for (const figures::Figure& figure : pictures.figures) {
    if (is_asked_for("png")) {
      write(figure.name + ".png", png_of_svg(figure.svg.document(), options.scale));
    }
    if (is_asked_for("pdf")) {
      write(figure.name + ".pdf", pdf_of_svg(figure.svg.document()));
    }
  }
  for (const std::string& note : pictures.notes) {
    fmt::print("note: {}\n", note);
  }
  return 0;
}

}  // namespace

void add_plot_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* command = app.add_subcommand("plot", "Draw trajectory, errors, speed and a scan of a run, or several runs");
  command
      ->add_option("DIR", options->folders,
                   "Folder of a run; of several over the same recording: trajectories, errors, iterations and times in "
                   "common pictures")
      ->required();
  add_option(*command, "-o,--output", options->output, "DIR2",
             "Folder for the pictures (default: plots in the first DIR)");
  add_option(*command, "--frame", options->frame, "N",
             "Which scan to draw: line of frames.jsonl, counted from 0 (default: the one with most points on "
             "moving objects)");
  add_option(*command, "--pair", options->pair, "N",
             "Also draw the steps from this scan to its alignment with the next one, as --frame counts them: "
             "steps.svg (runs with --save-labels show the points as the method sorted them)");
  add_option(*command, "--worst-objects", options->worst_objects, "N",
             "Also draw so many moving objects of a simulated recording, those whose boxes overlap least with the true "
             "ones, each of another body: worst_object_1.svg, ... (default 0)");
  add_option(*command, "--theme", options->theme, "NAME", "Background of the pictures: light or dark (default light)");
  add_option(*command, "--format", options->format, "NAME",
             "Files to write: svg, png, pdf, both (svg and png) or all (default svg)")
      ->check(CLI::IsMember({"svg", "png", "pdf", "both", "all"}).description(""));
  add_option(*command, "--scale", options->scale, "F",
             fmt::format("Pixels of a PNG file for each px of the SVG one, {} to {} (default {})", kMinScale, kMaxScale,
                         options->scale));
  command->add_flag(
      "--paper", options->paper,
      "Sizes for a paper of two columns: 88 mm wide (paths and plots over time) or 181 mm (scans), letters "
      "of 7 to 9 pt, no titles");
  command->callback([options, &selected] { selected = [options] { return plot(*options); }; });
}

}  // namespace dynamic_icp::apps
