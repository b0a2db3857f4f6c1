// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"
#include "dynamic_icp/recording/runs/continuation.hpp"
#include "dynamic_icp/recording/runs/files_beside.hpp"
#include "dynamic_icp/recording/runs/latency.hpp"
#include "dynamic_icp/recording/runs/live_view.hpp"
#include "dynamic_icp/recording/runs/method_needs.hpp"
#include "dynamic_icp/recording/runs/recording_check.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/recording/runs/run_json.hpp"
#include "dynamic_icp/recording/runs/run_truth.hpp"
#include "dynamic_icp/recording/runs/run_writer.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"
#include "dynamic_icp/recording/runs/scan_source.hpp"
#include "dynamic_icp/recording/runs/usable_points.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

/// A run while it continues.
class Run {
 public:
  Run(const Recording& recording, const RunSettings& settings, const RunCallbacks& callbacks)
      : recording_(recording),
        settings_(settings),
        callbacks_(callbacks),
        beside_(settings, [this](const std::string& text) { fail(text); }),
        calibration_(settings.calibration ? std::optional(read_calibration(*settings.calibration)) : std::nullopt),
        source_(recording, settings, callbacks.stop, [this](const std::string& text) { warn(text); }),
        dataset_(source_.dataset()),
        scans_(source_.scans()),
        truth_(truth_for_run(dataset_, source_.first_scans(), settings.ground_truth)),
        check_(check_recording(dataset_, recording.settings,
                               {source_.first_scans().begin, source_.first_scans().end, settings.threads},
                               needs_of(settings), callbacks.fix_in_words)) {
    result_.period_s = check_.period_s;
    result_.doppler = check_.doppler;
    result_.scans_selected = source_.first_scans().size();
    result_.sweep.search = check_.sweep;
    if (check_.sweep && check_.sweep->found_sweep()) {
      diagnosis::declare(*check_.sweep, *sweep_config(settings_.config));
    }
    if (settings.resume && !can_resume()) {
      throw UsageError(settings.follow ? "a run that follows a recording while it grows cannot be resumed"
                                       : "a run that writes an MCAP file cannot be resumed");
    }
    identity_ = run_identity(recording, settings_, dataset_, truth_.file);
  }

  /// Whether it came to its end.
  bool write() {
    std::vector<fs::path> inputs = {recording_.path, dataset_.scan_file(scans_.begin), truth_.file};
    if (settings_.calibration) {
      inputs.push_back(*settings_.calibration);
    }
    inputs.insert(inputs.end(), settings_.inputs.begin(), settings_.inputs.end());
    beside_.refuse(inputs);
    using Leftover = formats::OutputFolder::Leftover;
    formats::OutputFolder output(settings_.output, run_result(), settings_.replace || settings_.resume, inputs,
                                 settings_.resume ? Leftover::kTakeOver : Leftover::kRemove);
    if (!find_checkpoint(output)) {
      return true;
    }
    if (!fill(output)) {
      output.drop();
      return false;
    }
    if (!stopped_ && result_.failures.empty()) {
      output.drop();
      std::error_code ignored;
      fs::remove(output.path() / kCheckpointFile, ignored);
    }
    if (std::error_code ignored; !fs::exists(output.path() / kCheckpointFile, ignored)) {
      fs::remove(output.path() / kScanRecordsFile, ignored);
    }
    output.commit();
    return true;
  }

  RunResult take_result() { return std::move(result_); }

 private:
  void warn(const std::string& text) {
    result_.warnings.push_back(text);
    if (callbacks_.warning) {
      callbacks_.warning(text);
    }
  }

  /// Writes the files of the run; false when cancelled.
  bool fill(formats::OutputFolder& output) {
    try {
      return output.fill([&] { return write_files(output); });
    } catch (const DataError& error) {
      if (saved_ == 0) {
        throw;
      }
      throw DataError(fmt::format("{} (--resume continues after {} of {} scans)", error.what(), saved_, scans_.size()));
    }
  }

  void tell(const std::string& text) const {
    if (callbacks_.notice) {
      callbacks_.notice(text);
    }
  }

  /// Scans that come when they come cannot be read again, and MCAP files are written from one end to the other.
  [[nodiscard]] bool can_resume() const { return !settings_.follow && !settings_.mcap_file; }

  /// Looks for where to resume; false when nothing is left to do.
  bool find_checkpoint(const formats::OutputFolder& output) {
    if (!settings_.resume) {
      if (output.had_checkpoint()) {
        tell("a run that was ended early was here, with a checkpoint: removed, as it was not to be resumed");
      }
      return true;
    }
    Continuation found = continuation(output, settings_.output, identity_, settings_.replace,
                                      [this](const std::string& text) { tell(text); });
    from_ = std::move(found.from);
    result_.was_complete = found.is_complete;
    if (!from_ && !found.is_complete) {
      tell("no checkpoint to resume from: the run begins with its first scan");
    }
    return !found.is_complete;
  }

  /// The caller tells it at the end.
  void fail(const std::string& text) {
    result_.failures.push_back(text);
    result_.warnings.push_back(text);
  }

  /// All files of the run into the folder where it is put together; false when cancelled.
  bool write_files(formats::OutputFolder& output) {
    beside_.place(output);
    const FilesInRun files = beside_.in_run(output);
    std::unique_ptr<odometry::Odometry> odometry = make_odometry();
    std::vector<std::string> assumptions = dataset_.assumptions();
    for (const std::string& assumption : odometry->assumptions()) {
      assumptions.push_back(assumption);
    }
    if (check_.sweep && check_.sweep->hypothesis != diagnosis::SweepHypothesis::kInstant) {
      assumptions.push_back(check_.sweep->sentence);
    }
    for (const std::vector<std::string>* texts : {&assumptions, &check_.warnings}) {
      for (const std::string& text : *texts) {
        warn(text);
      }
    }
    if (!truth_.warning.empty()) {
      warn(truth_.warning);
    }
    std::unique_ptr<RunWriter> resumed = resume(odometry, output);
    if (!resumed) {
      resumed = std::make_unique<RunWriter>(output.path(), settings_.save_labels);
    }
    RunWriter& writer = *resumed;
    beside_.open(truth_.trajectory, messages_settings(settings_, check_.period_s));
    open_live_view();
    if (!process_scans(*odometry, writer, output)) {
      return false;
    }
    end_live_view();
    source_.complete(truth_, result_.scans_selected);
    if (const std::optional<window::SensorCalibration> learned = odometry->calibration()) {
      formats::write_whole_file(output.path() / "calibration.yaml", calibration_text(*learned));
    }
    result_.summary = writer.finish(settings_.method, truth_.trajectory, assumptions, stopped_);
    if (!result_.summary.failure.empty()) {  // the caller tells it at the end
      result_.warnings.insert(result_.warnings.begin(), result_.summary.failure);
    }
    if (!result_.summary.no_accuracy.empty()) {
      warn(fmt::format("no accuracy: {}: {}", truth_.file.string(), result_.summary.no_accuracy));
    }
    const auto write_run_json = [&] {
      formats::write_whole_file(output.path() / "run.json",
                                run_json(recording_, settings_, dataset_, truth_.file, result_, files));
    };
    beside_.describe(result_);
    write_run_json();
    const std::size_t failures = result_.failures.size();
    beside_.write(writer.trajectory(), output, result_);
    if (result_.failures.size() > failures) {
      write_run_json();
    }
    try_to_add_files(output);
    return true;
  }

  [[nodiscard]] std::unique_ptr<odometry::Odometry> make_odometry() const {
    return odometry::make_odometry(
        settings_.config, {dataset_.T_vehicle_sensor(), dataset_.doppler_kind(), calibration_}, settings_.threads);
  }

  /// What was found and counted beside the odometry and the files of the run.
  void results_state(StateArchive& archive) {
    archive(usable_, result_.sweep, result_.warnings, result_.failures, beside_);
  }

  /// Brings everything to where it was at the checkpoint, from which the odometry and the files continue. Null without
  /// one, and where that cannot be done: then everything is as it was, to begin anew.
  std::unique_ptr<RunWriter> resume(std::unique_ptr<odometry::Odometry>& odometry,
                                    const formats::OutputFolder& output) {
    if (!from_) {
      return nullptr;
    }
    refuse_other_scans(*from_, dataset_, scans_, settings_.output);
    const RunResult before = result_;
    std::string fault;
    try {
      odometry->load(from_->odometry);
      StateArchive results(from_->results);
      auto writer = std::make_unique<RunWriter>(output.path(), settings_.save_labels, from_->next, results);
      results_state(results);
      results.end();
      settings_.command = from_->command;
      saved_ = from_->next - scans_.begin;
      tell(fmt::format("resumed after {} of {} scans", from_->next - scans_.begin, scans_.size()));
      return writer;
    } catch (const DataError& error) {
      fault = output.in_final_names(error.what());
    } catch (const fs::filesystem_error& error) {
      fault = output.in_final_names(error.what());
    }
    const std::string checkpoint = (settings_.output / kCheckpointFile).string();
    const bool is_named = fault.find(settings_.output.string()) != std::string::npos;  // one of the other files
    tell(fmt::format("{}{}; the run begins anew", is_named ? "" : checkpoint + ": ", fault));
    from_.reset();
    remove_files_of_run(output.path());
    odometry = make_odometry();
    result_ = before;
    beside_.begin_anew();
    usable_ = {};
    return nullptr;
  }

  /// A checkpoint that cannot be written is no reason to lose the run: the one before serves as well.
  void save_checkpoint(odometry::Odometry& odometry, RunWriter& writer, const RawScan& scan, std::size_t next,
                       formats::OutputFolder& output) {
    timer_.time([&] {
      StateArchive results;
      writer.save(results);
      results_state(results);
      Checkpoint checkpoint{identity_, settings_.command, next, checksum(scan), odometry.save(), results.take()};
      try {
        write_checkpoint(output.path(), checkpoint);
        output.keep();
        saved_ = next - scans_.begin;
      } catch (const DataError& error) {
        tell(fmt::format("no checkpoint: {}", output.in_final_names(error.what())));
      }
    });
  }

  bool process_scans(odometry::Odometry& odometry, RunWriter& writer, formats::OutputFolder& output) {
    const std::size_t first = from_ ? from_->next : scans_.begin;
    source_.begin_at(first);
    report_progress(0);
    if (first > scans_.begin) {
      report_progress(first - scans_.begin);
    }
    for (std::size_t i = first; !stopped_ && source_.has_next(); ++i) {
      if (callbacks_.cancelled && callbacks_.cancelled()) {
        return false;
      }
      std::optional<RawScan> next = next_scan();
      if (!next) {
        break;
      }
      RawScan scan = std::move(*next);
      odometry::Frame frame = odometry.process(scan);
      writer.add(i, frame);
      is_begun_ = true;
      usable_.add(frame);
      result_.sweep.add(frame, scan);
      const double latency_ms = latencies_.add(source_.arrival());
      beside_.add(scan, frame, latency_ms);
      if (callbacks_.frame) {
        callbacks_.frame(i, frame);
      }
      report_progress(i + 1 - scans_.begin);
      stopped_ = i + 1 < scans_.end && callbacks_.stop && callbacks_.stop();
      if (can_resume() && i + 1 < scans_.end && (stopped_ || timer_.is_due())) {
        save_checkpoint(odometry, writer, scan, i + 1, output);
      }
      if (live_) {
        live_->add(std::move(scan), std::move(frame), latency_ms);
      }
    }
    stopped_ = stopped_ || source_.was_stopped();
    if (source_.grows()) {
      result_.scans_selected = usable_.scans();
      result_.latency = latencies_.summary();
    }
    usable_.refuse_none(recording_.path);
    return true;
  }

  /// The next scan. Where a recording that grows fails after its first, that ends the run, with the results so far:
  /// they cannot be made again. Then nothing.
  std::optional<RawScan> next_scan() {
    try {
      return source_.next();
    } catch (const DataError& error) {
      if (!source_.grows() || !is_begun_) {
        throw;
      }
      fail(fmt::format("it ended early: {}", error.what()));
      return std::nullopt;
    }
  }

  void report_progress(std::size_t done) const {
    if (callbacks_.progress) {
      callbacks_.progress(done, source_.total());
    }
  }

  /// An address that cannot be listened at is an error before the first scan.
  void open_live_view() {
    if (!settings_.live) {
      return;
    }
    live_.emplace(*settings_.live, fmt::format("dynamic-icp {}: {}", version(), source_.name()), truth_.trajectory,
                  messages_settings(settings_, check_.period_s));
    if (callbacks_.listening) {
      callbacks_.listening(live_->authority());
    }
  }

  void end_live_view() {
    if (live_) {
      if (const std::size_t left_out = live_->end("the run has ended"); left_out > 0) {
        warn(fmt::format("the live view left out {} scans: the machine is too slow for both", left_out));
      }
      live_.reset();
    }
  }

  /// What belongs beside the files of a run and cannot be made is no reason to lose the run.
  void try_to_add_files(const formats::OutputFolder& output) {
    try {
      if (callbacks_.add_files) {
        callbacks_.add_files(output.path());
      }
    } catch (const std::exception& error) {
      fail(output.in_final_names(error.what()));
    }
  }

  const Recording& recording_;
  RunSettings settings_;  ///< with the sweep that was found
  const RunCallbacks& callbacks_;
  FilesBeside beside_;
  std::optional<window::SensorCalibration> calibration_;
  ScanSource source_;
  const datasets::Dataset& dataset_;
  const datasets::ScanRange scans_;
  RunTruth truth_;
  RecordingCheck check_;
  std::optional<LiveView> live_;
  Latencies latencies_;
  UsablePoints usable_;
  std::string identity_;
  std::optional<Checkpoint> from_;  ///< where the run resumes
  std::size_t saved_ = 0;           ///< scans in the last checkpoint
  CheckpointTimer timer_{settings_.checkpoint_s};
  bool is_begun_ = false;  ///< there is a result
  bool stopped_ = false;
  RunResult result_;
};

}  // namespace

std::optional<RunResult> run_recording(const Recording& recording, const RunSettings& settings,
                                       const RunCallbacks& callbacks) {
  Run run(recording, settings, callbacks);
  return run.write() ? std::optional(run.take_result()) : std::nullopt;
}

}  // namespace dynamic_icp::runs
