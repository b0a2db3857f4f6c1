// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/lost_scans.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::runs {
namespace {

using odometry::FrameStatus;

constexpr double kFewPoints = 500.0;  // a scan of a LiDAR that planes can be found in has thousands
constexpr double kFewUsed = 0.5;      // of the points as read: what was left out is part of the cause

/// Why most of the points that were left out were, and what to look at.
std::string left_out(const Scan::Dropped& dropped) {
  const std::pair<std::size_t, const char*> counts[] = {
      {dropped.out_of_range, "most others are out of range: are coordinates in m?"},
      {dropped.non_finite, "most others are not finite"},
      {dropped.implausible,
       "most others have numbers that no sensor measures: are these x, y, z, Doppler in m and m/s?"},
      {dropped.zero_range, "most others are at the origin"},
      {dropped.flagged, "most others are flagged as unusable by the sensor"}};
  const auto* const most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.first; });
  return most->first > 0 ? most->second : "thinning leaves no more: are coordinates in m?";
}

/// "41 points a scan", "12 of 5000 points a scan"; what was left out goes to `note`.
std::string points_text(double read, double used, const Scan::Dropped& dropped, std::string& note) {
  if (used >= kFewUsed * read || read < kFewPoints) {
    return fmt::format("{:.0f} points a scan", read);
  }
  note = fmt::format(" ({})", left_out(dropped));
  return fmt::format("{:.0f} usable points a scan of {:.0f}", used, read);
}

}  // namespace

void LostScans::add(const ScanRecord& scan) {
  const double interval_s = last_ ? seconds_between(*last_, scan.stamp) : 0.0;
  last_ = scan.stamp;
  ++scans_;
  if (odometry::verdict(scan.status) != "lost") {
    return;
  }
  ++lost_;
  Reason& reason = reasons_[scan.status];
  reason.points.push_back(static_cast<double>(scan.points));
  reason.points_used.push_back(static_cast<double>(scan.points_used));
  reason.intervals_s.push_back(interval_s);
  reason.dropped += scan.dropped;
}

std::string LostScans::cause(FrameStatus status, const Reason& reason) {
  const double used = median(reason.points_used);
  std::string note;
  const std::string points = points_text(median(reason.points), used, reason.dropped, note);
  switch (status) {
    case FrameStatus::kTooFewPoints:
      return fmt::format("{} are too few to work with{}", points, note);
    case FrameStatus::kTimeGap:
      return fmt::format("{:.3g} s from scan to scan are too long to predict the motion; are timestamps in s?",
                         median(reason.intervals_s));
    case FrameStatus::kTooSoon:
      return fmt::format("{:.3g} s from scan to scan are no time to move; are timestamps in s?",
                         median(reason.intervals_s));
    default:
      break;
  }
  if (used < kFewPoints) {
    return fmt::format("{} {}{}", points, status == FrameStatus::kLost ? "give no planes" : "are too few to match",
                       note);
  }
  return fmt::format(
      "with {:.0f} points a scan, scans do not fit those before; the diagnosis of the recording tells wrong units, "
      "signs, columns and timestamps",
      used);
}

std::optional<std::string> LostScans::failure() const {
  if (2 * lost_ <= scans_) {
    return std::nullopt;
  }
  const auto most =
      std::ranges::max_element(reasons_, {}, [](const auto& reason) { return reason.second.points.size(); });
  return fmt::format("ODOMETRY FAILED on {} of {} scans: {}", lost_, scans_, cause(most->first, most->second));
}

}  // namespace dynamic_icp::runs
