// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/shown_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/recording/runs/scan_as_run.hpp"
#include "dynamic_icp/tools/figures/scan_view.hpp"

namespace dynamic_icp::figures {
namespace {

using runs::FrameRow;
using runs::RunFiles;

/// The Doppler compensated for the ego motion and the bias that the run found.
std::vector<double> compensated_doppler(const FrameRow& row, const runs::ScanAsRun& seen, const Workers& workers) {
  const Scan& scan = seen.scan;
  ego_motion::EgoVelocity ego;
  ego.bias_mps = std::isfinite(row.doppler_bias) ? row.doppler_bias : 0.0;
  if (scan.doppler_kind() == DopplerKind::kRelative) {
    const bool in_sweep = seen.motion && scan.has_times();
    ego.velocity_sensor = in_sweep ? seen.motion->velocity : row.ego_velocity;
    ego.acceleration_sensor = in_sweep ? seen.motion->acceleration : Eigen::Vector3d::Zero();
  }
  std::vector<double> compensated;
  ego_motion::compensated_doppler(scan, ego, workers, compensated);
  return compensated;
}

std::uint8_t object_label(std::size_t place) {
  return place + kFirstObject <= std::numeric_limits<std::uint8_t>::max()
             ? static_cast<std::uint8_t>(place + kFirstObject)
             : kDynamic;
}

/// Whether the method of the run tells moving points from static ones at all.
bool shows_motion(const RunFiles& run) { return runs::text_of(run.run, "method") == "dynamic-icp"; }

bool moves(double compensated) { return std::abs(compensated) > kMoving_mps; }

/// Of a run that wrote them. What moves without an object is "not used" there: the Doppler tells it apart.
std::vector<std::uint8_t> saved_labels(const RunFiles& run, std::size_t frame, const Scan& scan,
                                       const std::vector<std::int32_t>& saved, const std::vector<double>& compensated) {
  std::unordered_map<std::int64_t, std::uint8_t> label_of_object;
  for (std::size_t k = 0; k < run.objects[frame].size(); ++k) {
    label_of_object.emplace(run.objects[frame][k].id, object_label(k));
  }
  const bool tells = shows_motion(run);
  std::vector<std::uint8_t> labels(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::int32_t label = saved[scan.records()[i]];
    const auto object = label > 0 ? label_of_object.find(label) : label_of_object.end();
    labels[i] = object != label_of_object.end()  ? object->second
                : label >= 0                     ? (label == 0 ? kStatic : kDynamic)
                : tells && moves(compensated[i]) ? kDynamic
                                                 : kNotUsed;
  }
  return labels;
}

std::vector<std::uint8_t> guessed_labels(const RunFiles& run, std::size_t frame, const Scan& scan,
                                         const std::vector<double>& compensated) {
  std::vector<std::uint8_t> labels(scan.size(), kStatic);
  if (!shows_motion(run)) {
    return labels;
  }
  std::transform(compensated.begin(), compensated.end(), labels.begin(),
                 [](double value) { return moves(value) ? kDynamic : kStatic; });
  const ScanView view{.title = {},
                      .scan = scan,
                      .ego_velocity = run.frames[frame].ego_velocity,
                      .objects = run.objects[frame],
                      .labels = {}};
  for (std::size_t k = 0; k < view.objects.size(); ++k) {
    for (const std::uint32_t row : rows_on_object(view, compensated, view.objects[k])) {
      labels[row] = object_label(k);
    }
  }
  return labels;
}

/// Undoes what the objects themselves moved between the stamp and the time of each of their points: where the boxes
/// are.
void put_objects_at_stamp(const RunFiles& run, std::size_t frame, const std::vector<double>& times, ShownScan& shown) {
  const std::vector<runs::ObjectRow>& objects = run.objects[frame];
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::size_t object = shown.labels[i] - std::size_t{kFirstObject};
    if (shown.labels[i] >= kFirstObject && objects[object].velocity.allFinite()) {
      shown.points[i] -= times[i] * objects[object].velocity;
    }
  }
}

/// Motions that nobody made, in a damaged file, must not carry points to where they cannot be shown.
ShownScan within_reach(const ShownScan& scan) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    if (scan.points[row].norm() <= kFarthestShown_m) {
      rows.push_back(row);
    }
  }
  return rows.size() == scan.size() ? scan : select(scan, rows);
}

}  // namespace

ShownScan select(const ShownScan& scan, std::span<const std::uint32_t> rows) {
  ShownScan part;
  const auto pick = [&](const auto& column, auto& into) {
    into.reserve(rows.size());
    for (const std::uint32_t row : rows) {
      into.push_back(column[row]);
    }
  };
  pick(scan.points, part.points);
  pick(scan.doppler, part.doppler);
  pick(scan.compensated, part.compensated);
  pick(scan.labels, part.labels);
  pick(scan.residual, part.residual);
  return part;
}

ShownScan show_scan(const RunFiles& run, std::size_t frame, const RawScan& raw, const Workers& workers) {
  const runs::ScanAsRun seen = runs::scan_as_run(run, frame, raw, kFarthestShown_m, workers);
  const Scan& scan = seen.scan;
  ShownScan shown;
  shown.compensated = compensated_doppler(run.frames[frame], seen, workers);
  const std::optional<std::vector<std::int32_t>> saved = runs::read_labels(run, frame, raw.points.size());
  shown.labels = saved ? saved_labels(run, frame, scan, *saved, shown.compensated)
                       : guessed_labels(run, frame, scan, shown.compensated);
  shown.points = scan.points();
  if (seen.is_deskewed && scan.has_times()) {
    put_objects_at_stamp(run, frame, scan.times(), shown);
  }
  shown.doppler = scan.doppler();
  shown.residual.assign(scan.size(), std::numeric_limits<double>::quiet_NaN());
  return within_reach(shown);
}

}  // namespace dynamic_icp::figures
