// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_scans.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/figures/point_thinning.hpp"
#include "dynamic_icp/tools/report/scan_blob.hpp"
#include "dynamic_icp/tools/report/scan_budget.hpp"
#include "dynamic_icp/tools/report/static_map.hpp"
#include "dynamic_icp/tools/report/surface_residual.hpp"

namespace dynamic_icp::report {
namespace {

using runs::RunFiles;

constexpr double kMapShare = 0.1;        // of the budget
constexpr double kTracesShare = 0.02;    // of the budget
constexpr double kWholeShare = 0.25;     // of the budget, for scans that nobody asked for
constexpr double kBytesPerPoint = 10.0;  // of a thinned scan, until one tells
constexpr double kMapBytesPerPoint = 8.0;

/// The scans of a run as the page shows them, each read once when they are asked for in their order.
class ScanReader {
 public:
  ScanReader(const RunFiles& run, const datasets::Dataset& recording, const Workers& workers)
      : run_(run), recording_(recording), workers_(workers) {}

  /// With residuals, at the poses of the run.
  const figures::ShownScan& read(std::size_t frame) {
    if (now_.frame == frame) {
      return now_.scan;
    }
    if (frame > 0) {
      before_ = now_.frame == frame - 1 ? std::move(now_) : prepared(frame - 1);
    }
    now_ = prepared(frame);
    if (frame > 0) {
      const registration::PreparedTarget surface = surface_of(before_.scan.points, workers_);
      const Eigen::Isometry3d T_before_now =
          run_.trajectory[frame - 1].T_world_sensor.inverse() * run_.trajectory[frame].T_world_sensor;
      now_.scan.residual = surface_residual(surface, now_.scan.points, T_before_now, workers_);
    }
    return now_.scan;
  }

 private:
  struct Prepared {
    std::optional<std::size_t> frame;
    figures::ShownScan scan;
  };

  Prepared prepared(std::size_t frame) const {
    return {frame, figures::show_scan(run_, frame, figures::read_scan(run_, recording_, frame), workers_)};
  }

  const RunFiles& run_;
  const datasets::Dataset& recording_;
  const Workers& workers_;
  Prepared before_;
  Prepared now_;
};

/// Adds the points of a scan whose labels are wanted.
void add_points(StaticMap& map, const RunFiles& run, std::size_t frame, const figures::ShownScan& scan,
                bool (*is_wanted)(std::uint8_t label)) {
  if (run.frames[frame].status == "lost") {
    return;  // where this scan stands is a guess
  }
  std::vector<Eigen::Vector3d> wanted;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (is_wanted(scan.labels[i])) {
      wanted.push_back(scan.points[i]);
    }
  }
  map.add(wanted, run.trajectory[frame].T_world_sensor);
}

std::optional<KeptMap> finish(StaticMap& map, std::size_t budget_bytes) {
  constexpr double kLess = 0.9;
  while (true) {
    const std::vector<Eigen::Vector3d> points = map.points();
    if (points.empty()) {
      return std::nullopt;
    }
    KeptMap kept{.points = points.size(), .cell_m = map.cell_m(), .blob = blob(map_bytes(points))};
    if (kept.blob.size() <= budget_bytes) {
      return kept;
    }
    map.limit(static_cast<std::size_t>(kLess * static_cast<double>(points.size())));
    if (map.points().size() == points.size()) {
      return std::nullopt;  // not even the coarsest fits
    }
  }
}

double seconds_to_next(const RunFiles& run, std::size_t frame) {
  const std::size_t n = run.frames.size();
  return n < 2           ? 0.0
         : frame + 1 < n ? run.seconds(frame + 1) - run.seconds(frame)
                         : run.seconds(frame) - run.seconds(frame - 1);
}

/// The number of points that a frame says it has; 0 for what is no number of points.
std::size_t points_of(const runs::FrameRow& frame) {
  constexpr double kMost = 1e9;
  return frame.points >= 0.0 && frame.points < kMost ? static_cast<std::size_t>(frame.points) : 0;
}

KeptScan keep(const RunFiles& run, std::size_t frame, const figures::ShownScan& scan, std::size_t count) {
  const std::vector<std::uint32_t> rows = rows_to_keep(scan, count);
  return {.frame = frame,
          .dt_s = seconds_to_next(run, frame),
          .points = rows.size(),
          .of = points_of(run.frames[frame]),
          .whole = rows.size() == scan.size(),
          .blob = blob(scan_bytes(select(scan, rows)))};
}

/// Bytes spent and what they bought.
struct Spending {
  double bytes = 0.0;
  double points = 0.0;

  void add(const KeptScan& scan) {
    bytes += static_cast<double>(scan.blob.size());
    points += static_cast<double>(scan.points);
  }
  [[nodiscard]] std::optional<double> bytes_per_point() const {
    return points > 0.0 ? std::optional(bytes / points) : std::nullopt;
  }
};

/// What a point takes in a scan of so many: the more there are, the smaller their differences.
double bytes_per_point_at(std::size_t count, const RunFiles& run, ScanReader& reader) {
  const std::size_t middle = run.frames.size() / 2;
  Spending spent;
  spent.add(keep(run, middle, reader.read(middle), std::max<std::size_t>(count, 1)));
  return spent.bytes_per_point().value_or(kBytesPerPoint);
}

void check_frames(const RunFiles& run, const std::vector<std::size_t>& frames) {
  for (const std::size_t frame : frames) {
    if (frame >= run.frames.size()) {
      throw UsageError(fmt::format("scan {} is asked for, expected 0 to {}", frame,
                                   std::max<std::size_t>(run.frames.size(), 1) - 1));
    }
  }
}

/// Those asked for and, as far as the budget has room, telling ones. Ascending.
std::vector<std::size_t> frames_kept_whole(const RunFiles& run, const std::optional<figures::RunTruth>& truth,
                                           const ScanChoice& choice, double budget_bytes) {
  std::vector<std::size_t> whole = choice.whole;
  if (choice.choose_whole) {
    double room = kWholeShare * budget_bytes;
    for (const std::size_t frame : informative_frames(run, truth)) {
      room -= kBytesPerPoint * run.frames[frame].points;
      if (room >= 0.0) {
        whole.push_back(frame);
      }
    }
  }
  std::sort(whole.begin(), whole.end());
  whole.erase(std::unique(whole.begin(), whole.end()), whole.end());
  return whole;
}

std::string megabytes(double bytes) { return fmt::format("{:.1f} MB", 1e-6 * bytes); }

/// "12, 40 and 77".
std::string listed(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    text += fmt::format("{}{}", k == 0 ? "" : k + 1 == indices.size() ? " and " : ", ", indices[k]);
  }
  return text;
}

/// What was left out, in words.
std::vector<std::string> notes_of(const RunFiles& run, const RunScans& kept, const ScanChoice& choice) {
  std::vector<std::string> notes;
  double points = 0.0;
  double of = 0.0;
  double bytes = 0.0;
  std::vector<std::size_t> whole;
  std::size_t unlabelled = 0;
  for (const KeptScan& scan : kept.scans) {
    unlabelled += runs::lacks_labels(run, scan.frame) ? 1 : 0;
    points += static_cast<double>(scan.points);
    of += static_cast<double>(scan.of);
    bytes += static_cast<double>(scan.blob.size());
    if (scan.whole) {
      whole.push_back(run.frames[scan.frame].index);
    }
  }
  if (unlabelled > 0) {
    notes.push_back(
        fmt::format("labels/ lacks {} of the {} scans shown: their points count as moving by their Doppler, and as "
                    "an object's when they lie where it is.",
                    unlabelled, kept.scans.size()));
  }
  constexpr std::size_t kNamed = 20;
  if (whole.size() < kept.scans.size()) {
    notes.push_back(
        fmt::format("Scans are thinned to keep the page small: {:.0f} % of the points are shown, spread over "
                    "space{}. What was measured and computed is not touched by this.",
                    100.0 * points / of,
                    whole.empty()            ? ""
                    : whole.size() <= kNamed ? fmt::format("; scan{} {} {} whole", whole.size() == 1 ? "" : "s",
                                                           listed(whole), whole.size() == 1 ? "is" : "are")
                                             : fmt::format("; {} scans are whole", whole.size())));
  }
  if (kept.scans.size() < run.frames.size()) {
    notes.push_back(
        fmt::format("{} of {} scans are kept; the others show the nearest one before them. Path, objects and "
                    "plots hold every scan.",
                    kept.scans.size(), run.frames.size()));
  }
  if (bytes > static_cast<double>(choice.budget_bytes)) {
    notes.push_back(fmt::format("The scans asked for take {}, more than the {} they were given.", megabytes(bytes),
                                megabytes(static_cast<double>(choice.budget_bytes))));
  }
  return notes;
}

/// Fills a page with scans, the map of their static points and the traces of moving ones, within a budget.
class PageScans {
 public:
  PageScans(const RunFiles& run, const datasets::Dataset& recording, double budget_bytes, const Workers& workers)
      : run_(run),
        reader_(run, recording, workers),
        map_bytes_(kMapShare * budget_bytes),
        traces_bytes_(kTracesShare * budget_bytes),
        scan_bytes_(budget_bytes - map_bytes_ - traces_bytes_),
        map_(static_cast<std::size_t>(map_bytes_ / kMapBytesPerPoint)),
        traces_(static_cast<std::size_t>(traces_bytes_ / kMapBytesPerPoint)) {
    for (const runs::FrameRow& frame : run.frames) {
      points_.push_back(points_of(frame));
    }
  }

  void keep_whole(const std::vector<std::size_t>& frames) {
    for (const std::size_t frame : frames) {
      const figures::ShownScan& scan = reader_.read(frame);
      on_whole_.add(kept_[frame] = keep(run_, frame, scan, scan.size()));
    }
  }

  /// Thins the others to what is left, and adds the static points of all to the map.
  void keep_thinned() {
    const std::size_t usual_share = even_share(points_, static_cast<std::size_t>(scan_bytes_ / kBytesPerPoint));
    bytes_per_point_ = bytes_per_point_at(usual_share, run_, reader_);
    std::vector<std::size_t> whole;
    for (const auto& [frame, scan] : kept_) {
      whole.push_back(frame);
    }
    const KeptFrames plan = kept_frames(points_, whole, points_for(bytes_left()));
    std::vector<std::size_t> to_come;  // points of the scans to be thinned
    for (const std::size_t frame : plan.frames) {
      if (!kept_.contains(frame)) {
        to_come.push_back(points_[frame]);
      }
    }
    constexpr std::size_t kScansPerShare = 32;
    std::size_t done = 0;
    std::size_t share = 0;
    for (const std::size_t frame : plan.frames) {
      const figures::ShownScan& scan = reader_.read(frame);
      add_points(map_, run_, frame, scan, [](std::uint8_t label) { return label == figures::kStatic; });
      add_points(traces_, run_, frame, scan, [](std::uint8_t label) { return label > figures::kStatic; });
      if (kept_.contains(frame)) {
        continue;
      }
      // What scans really take shows as they are made: the rest is divided anew every now and then, at the end each
      // time.
      if (done % kScansPerShare == 0 || to_come.size() - done < kScansPerShare) {
        share = even_share(std::span(to_come).subspan(done), points_for(bytes_left()));
      }
      ++done;
      keep_fitting(frame, scan, share);
    }
  }

  RunScans take() {
    RunScans result;
    for (auto& [frame, scan] : kept_) {
      result.scans.push_back(std::move(scan));
    }
    result.map = finish(map_, static_cast<std::size_t>(map_bytes_));
    result.traces = finish(traces_, static_cast<std::size_t>(traces_bytes_));
    return result;
  }

 private:
  [[nodiscard]] double bytes_left() const { return scan_bytes_ - on_whole_.bytes - on_thinned_.bytes; }

  [[nodiscard]] std::size_t points_for(double bytes) const {
    return static_cast<std::size_t>(std::max(0.0, bytes) / on_thinned_.bytes_per_point().value_or(bytes_per_point_));
  }

  /// At most `count` points of the scan; fewer where they take more than is left, none where not even few fit.
  void keep_fitting(std::size_t frame, const figures::ShownScan& scan, std::size_t count) {
    constexpr std::size_t kTooFew = 100;
    KeptScan attempt = keep(run_, frame, scan, count);
    while (static_cast<double>(attempt.blob.size()) > bytes_left() && count > kTooFew) {
      count = std::min(count, attempt.points) * 3 / 4;
      attempt = keep(run_, frame, scan, count);
    }
    if (static_cast<double>(attempt.blob.size()) <= bytes_left() && attempt.points > 0) {
      on_thinned_.add(attempt);
      kept_[frame] = std::move(attempt);
    }
  }

  const RunFiles& run_;
  ScanReader reader_;
  double map_bytes_;
  double traces_bytes_;
  double scan_bytes_;
  StaticMap map_;
  StaticMap traces_;                 ///< of what moves
  std::vector<std::size_t> points_;  ///< of each scan in the recording
  double bytes_per_point_ = kBytesPerPoint;
  Spending on_whole_;
  Spending on_thinned_;
  std::map<std::size_t, KeptScan> kept_;
};

}  // namespace

std::vector<std::uint32_t> rows_to_keep(const figures::ShownScan& scan, std::size_t count) {
  if (scan.size() <= count) {
    return figures::spread_rows(scan.points, count);
  }
  std::vector<Eigen::Vector3d> on_objects;
  std::vector<Eigen::Vector3d> others;
  std::vector<std::uint32_t> rows_on_objects;
  std::vector<std::uint32_t> rows_of_others;
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    const bool is_on_object =
        scan.labels[row] >= figures::kFirstObject;  // single points that seem to move are mostly noise
    (is_on_object ? on_objects : others).push_back(scan.points[row]);
    (is_on_object ? rows_on_objects : rows_of_others).push_back(row);
  }
  const std::size_t of_objects = std::min(on_objects.size(), count / 2);
  const std::size_t of_others = std::min(others.size(), count - of_objects);
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t k : figures::spread_rows(on_objects, count - of_others)) {
    chosen.push_back(rows_on_objects[k]);
  }
  for (const std::uint32_t k : figures::spread_rows(others, of_others)) {
    chosen.push_back(rows_of_others[k]);
  }
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t row : chosen) {
    points.push_back(scan.points[row]);
  }
  std::vector<std::uint32_t> rows;
  for (const std::uint32_t k : figures::spread_rows(points, points.size())) {
    rows.push_back(chosen[k]);
  }
  return rows;
}

RunScans keep_scans(const RunFiles& run, const std::optional<figures::RunTruth>& truth,
                    const datasets::Dataset& recording, const ScanChoice& choice, const Workers& workers) {
  check_frames(run, choice.whole);
  const double budget_bytes = static_cast<double>(choice.budget_bytes);
  PageScans page(run, recording, budget_bytes, workers);
  page.keep_whole(frames_kept_whole(run, truth, choice, budget_bytes));
  page.keep_thinned();
  RunScans result = page.take();
  result.notes = notes_of(run, result, choice);
  return result;
}

}  // namespace dynamic_icp::report
