// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// dynamic-icp-speed: how long whole scans take, reading excluded. See docs/performance.md.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"

#include "apps/keep_memory.hpp"
#include "benchmarks/sequence/measurement.hpp"
#include "benchmarks/sequence/reference_work.hpp"
#include "benchmarks/sequence/report.hpp"

namespace dynamic_icp::speed {
namespace {

constexpr int kDataOrMachineFailed = 1;
constexpr int kWrongUsage = 2;

struct Options {
  std::vector<std::string> recordings;
  std::vector<std::string> methods = {"dynamic-icp"};
  std::vector<std::string> presets = {"default", "paper"};
  std::vector<int> threads = {1, 2};
  int repeat = 3;
  std::string reference;
  std::string output;
  bool growth = false;
  bool quiet = false;
};

/// Rows, and every time of the reference work.
struct Results {
  std::vector<Row> rows;
  std::vector<double> reference_ms;
};

std::vector<Setup> setups_of(const Options& options) {
  std::vector<Setup> setups;
  for (const std::string& recording : options.recordings) {
    for (const std::string& method : options.methods) {
      for (const std::string& preset : options.presets) {
        for (const int threads : options.threads) {
          setups.push_back({recording, method, preset, threads});
        }
      }
    }
  }
  return setups;
}

/// Every setup once in each round, so that a noisy minute of the machine falls on all of them; and before each run the
/// reference work, so that it falls on both sides of the ratio.
Results run_rounds(const std::vector<Setup>& setups, const ReferenceWork* reference, const Options& options) {
  std::vector<std::vector<Run>> runs(setups.size());
  Results results;
  for (int round = 0; round < options.repeat; ++round) {
    for (std::size_t i = 0; i < setups.size(); ++i) {
      const std::optional<double> reference_ms = reference != nullptr ? std::optional(reference->run()) : std::nullopt;
      runs[i].push_back(measure_in_child(setups[i]));
      runs[i].back().reference_ms = reference_ms;
      if (reference_ms) {
        results.reference_ms.push_back(*reference_ms);
      }
      if (!options.quiet) {
        fmt::print(stderr, "round {} of {}, {} of {}: {} {} {}, {} thread(s): {:.2f} ms\n", round + 1, options.repeat,
                   i + 1, setups.size(), short_name(setups[i].recording), setups[i].method, setups[i].preset,
                   setups[i].threads, median(runs[i].back().ms));
      }
    }
  }
  for (std::size_t i = 0; i < setups.size(); ++i) {
    results.rows.push_back(summarise(setups[i], runs[i]));
  }
  compare(results.rows);
  return results;
}

nlohmann::ordered_json reference_json(const ReferenceWork* reference, const Results& results, const Options& options) {
  if (reference == nullptr) {
    return nullptr;
  }
  const Repeated ms = repeated(results.reference_ms);
  return {{"program", options.reference},
          {"recording", options.recordings.front()},
          {"scan", reference->scan()},
          {"points", reference->points()},
          {"ms", ms.median},
          {"ms_least_of_runs", ms.min},
          {"ms_largest_of_runs", ms.max}};
}

void print(const Results& results, const ReferenceWork* reference, const std::vector<Growth>& growth,
           const Options& options) {
  fmt::print("{}\n", benchmark::describe_machine());
  fmt::print(
      "Times of whole scans in ms, reading excluded. The first {} scans are warm-up (their largest is shown).\n"
      "Median of {} runs; in brackets least and largest. MiB: most in use beside the loaded scans, and with them.\n\n",
      kWarmUpScans, options.repeat);
  fmt::print("{}\nMedian of each stage, ms\n{}", table_text(results.rows), stage_text(results.rows));
  if (reference != nullptr) {
    const Repeated ms = repeated(results.reference_ms);
    fmt::print("\nReference work on scan {} of {}, {} points: {:.2f} ms ({:.2f}-{:.2f})\n", reference->scan(),
               short_name(options.recordings.front()), reference->points(), ms.median, ms.min, ms.max);
  }
  if (!growth.empty()) {
    fmt::print("\n{}", growth_text(growth));
  }
}

/// Refuses a file that cannot be written before anything is measured.
void check_output(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw UsageError(fmt::format("--output: the folder {} is missing", folder.string()));
  }
}

int run(const Options& options) {
  check_output(options.output);
  std::unique_ptr<ReferenceWork> reference;
  if (!options.reference.empty()) {
    reference = std::make_unique<ReferenceWork>(options.reference, options.recordings.front());
  }
  const Results results = run_rounds(setups_of(options), reference.get(), options);
  const std::vector<Growth> growth = options.growth ? growth_of(results.rows) : std::vector<Growth>();
  print(results, reference.get(), growth, options);
  if (!options.output.empty()) {
    const nlohmann::ordered_json json = {{"version", version()},
                                         {"machine", benchmark::describe_machine()},
                                         {"repeat", options.repeat},
                                         {"warm_up_scans", kWarmUpScans},
                                         {"reference", reference_json(reference.get(), results, options)},
                                         {"rows", json_of(results.rows)},
                                         {"growth", json_of(growth)}};
    formats::write_whole_file(options.output,
                              json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }
  return 0;
}

/// A list like "1,2"; what follows is another argument.
template <class List>
CLI::Option* add_list(CLI::App& app, const std::string& name, List& list, const std::string& description) {
  return app.add_option(name, list, description)->delimiter(',')->allow_extra_args(false)->type_name("LIST");
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("RECORDINGS", options.recordings, "Folders of recordings, of any layout that 'run' takes")->required();
  add_list(app, "--presets", options.presets, "Configurations (default default,paper)");
  add_list(app, "--methods", options.methods, "Methods (default dynamic-icp)");
  add_list(app, "--threads", options.threads, "Numbers of threads (default 1,2)")->check(CLI::Range(1, 1024));
  app.add_option("--repeat", options.repeat, "Runs of everything, in turn (default 3)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  app.add_option("--reference", options.reference,
                 "Program that does a fixed work on a file of float32 x, y, z, Doppler and prints its milliseconds; it "
                 "is given the scan in the middle of the first recording")
      ->type_name("PROGRAM");
  app.add_flag("--growth", options.growth, "Fit how the time grows with the points of a scan over the recordings");
  app.add_option("--output", options.output, "File for the results")->type_name("FILE.json");
  app.add_flag("--quiet", options.quiet, "No progress");
}

}  // namespace
}  // namespace dynamic_icp::speed

int main(int argc, char** argv) {
  using namespace dynamic_icp;
  keep_freed_memory();  // as the program does
  speed::Options options;
  CLI::App app{"Times the odometry over whole recordings", "dynamic-icp-speed"};
  speed::add_options(app, options);
  try {
    app.parse(argc, argv);
    return speed::run(options);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "dynamic-icp-speed: {}\nRun 'dynamic-icp-speed --help'.\n", error.what());
    return speed::kWrongUsage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "dynamic-icp-speed: {}\n", error.what());
    return speed::kWrongUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "dynamic-icp-speed: {}\n", error.what());
    return speed::kDataOrMachineFailed;
  }
}
