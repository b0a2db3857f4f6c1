// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What must not matter, or must carry over, does: random changes of a drive that leave its motion as it is, or change
// it by a known law. Every method; RapidCheck names the seed of the case that fails.
#include <cstdlib>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

constexpr int kScans = 5;

/// A case runs a drive twice. RC_PARAMS=max_success=1000 in the environment tries more.
[[maybe_unused]] const int kCases = ::setenv("RC_PARAMS", "max_success=30", 0);

/// Random numbers from one draw of RapidCheck, which would keep in memory every number that it draws itself.
class Chance {
 public:
  std::uint64_t below(std::uint64_t end) { return source_.bits(next_++) % end; }
  double between(double low, double high) { return source_.uniform(next_++, low, high); }

  Vector3d direction() {
    const double z = between(-1.0, 1.0);
    const double angle = between(-std::numbers::pi, std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  RandomSource source_{*rc::gen::arbitrary<std::uint64_t>()};
  std::uint64_t next_ = 0;
};

const Pipeline& any_pipeline(Chance& chance) {
  const Pipeline& pipeline = pipelines()[chance.below(pipelines().size())];
  RC_LOG() << "method " << pipeline.method << " " << pipeline.preset << "\n";
  return pipeline;
}

/// Those that use the Doppler. With so few points the others find another minimum after any change, up to a metre away.
const Pipeline& any_doppler_pipeline(Chance& chance) {
  while (true) {
    const Pipeline& pipeline = any_pipeline(chance);
    if (needs_doppler(pipeline.method)) {
      return pipeline;
    }
  }
}

/// The scans of a drive along a street with two cars, at once or swept.
std::vector<RawScan> any_drive(Chance& chance) {
  Drive drive{street_with_cars(), circle(chance.between(3.0, 14.0), chance.between(-0.3, 0.3)), {}};
  drive.sensor.columns = 120;
  drive.sensor.rows = 16;
  drive.sensor.sweep_s = chance.below(2) == 0 ? 0.0 : 0.1;
  drive.seed = chance.below(1000);
  std::vector<RawScan> scans;
  for (int k = 0; k < kScans; ++k) {
    scans.push_back(drive.scan(k));
  }
  return scans;
}

std::vector<Frame> run(const Pipeline& pipeline, const std::vector<RawScan>& scans) {
  const auto odometry = make_odometry(pipeline.config, {}, 1);
  std::vector<Frame> frames;
  for (const RawScan& scan : scans) {
    frames.push_back(odometry->process(scan));
  }
  return frames;
}

/// Appends the row of another scan, or the same one again.
void append_row(RawScan& scan, const RawScan& from, std::size_t row) {
  scan.points.push_back(from.points[row]);
  scan.doppler.push_back(from.doppler[row]);
  if (!from.times.empty()) {
    scan.times.push_back(from.times[row]);
  }
}

/// That the others are the same motions and velocities seen from another frame, but for noise: points fall into other
/// cells of the grids. 3000 cases of each property differ by at most four fifths of these limits; an alignment from
/// scan to scan that was still moving when it ended may differ by any amount.
void must_be_close(const Pipeline& pipeline, const std::vector<Frame>& ones, const std::vector<Frame>& others,
                   const Eigen::Isometry3d& T_other_one = Eigen::Isometry3d::Identity()) {
  const bool is_default = pipeline.preset == "default";
  const double limit_m = is_default ? 0.004 : 0.15;
  const double limit_mps = is_default ? 0.05 : 0.9;
  const auto has_ended = [](const Frame& frame) { return frame.status != FrameStatus::kIterationLimit; };
  for (std::size_t k = 0; k < ones.size(); ++k) {
    if (!is_default && !(has_ended(ones[k]) && has_ended(others[k]))) {
      continue;
    }
    const Eigen::Isometry3d expected = T_other_one * ones[k].T_target_source * T_other_one.inverse();
    const Eigen::Isometry3d E = others[k].T_target_source * expected.inverse();
    const double limit_deg = !is_default ? 0.7 : k == 1 ? 0.3 : 0.1;  // two scans hardly show how the sensor turns
    RC_LOG() << "scan " << k << ": " << E.translation().norm() << " m\n";
    RC_ASSERT(E.translation().norm() < limit_m);
    RC_ASSERT(rotation_angle(E.linear()) < limit_deg / 180.0 * std::numbers::pi);
    RC_ASSERT((others[k].ego.velocity_sensor - T_other_one.linear() * ones[k].ego.velocity_sensor).norm() < limit_mps);
  }
}

void must_be_the_same(const std::vector<Frame>& ones, const std::vector<Frame>& others) {
  for (std::size_t k = 0; k < ones.size(); ++k) {
    RC_ASSERT(ones[k].status == others[k].status);
    RC_ASSERT(ones[k].T_world_sensor.matrix() == others[k].T_world_sensor.matrix());
    RC_ASSERT(ones[k].ego.velocity_sensor == others[k].ego.velocity_sensor);
    RC_ASSERT(ones[k].tracked.size() == others[k].tracked.size());
  }
}

RC_GTEST_PROP(Symmetry, TheTimeAtWhichARecordingBeginsDoesNotMatter, ()) {
  Chance chance;
  const Pipeline& pipeline = any_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  const auto shift_ns = static_cast<std::int64_t>(chance.below(4'000'000'000'000'000'000ULL));
  for (RawScan& scan : scans) {
    scan.stamp.ns += shift_ns;
  }
  must_be_the_same(before, run(pipeline, scans));
}

RC_GTEST_PROP(Symmetry, RowsThatAreNoMeasurementsLeaveNoTrace, ()) {
  Chance chance;
  const Pipeline& pipeline = any_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (RawScan& scan : scans) {
    RawScan with_more = scan;
    with_more.points.clear();
    with_more.doppler.clear();
    with_more.times.clear();
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      while (chance.below(10) == 0) {
        append_row(with_more, scan, i);
        switch (chance.below(5)) {
          case 0:
            with_more.points.back()[static_cast<int>(chance.below(3))] = kNan;
            break;
          case 1:
            with_more.points.back().setZero();
            break;
          case 2:
            with_more.doppler.back() = kInfinity;
            break;
          case 3:
            with_more.points.back() *= 1e30;
            break;
          default:
            with_more.doppler.back() = kNan;
        }
      }
      append_row(with_more, scan, i);
    }
    scan = with_more;
  }
  must_be_the_same(before, run(pipeline, scans));
}

RC_GTEST_PROP(Symmetry, TheOrderOfPointsHardlyMatters, ()) {
  Chance chance;
  const Pipeline& pipeline = any_doppler_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  for (RawScan& scan : scans) {
    RawScan shuffled = scan;
    std::vector<std::size_t> order(scan.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[chance.below(i)]);
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
      shuffled.points[i] = scan.points[order[i]];
      shuffled.doppler[i] = scan.doppler[order[i]];
      if (!scan.times.empty()) {
        shuffled.times[i] = scan.times[order[i]];
      }
    }
    scan = shuffled;
  }
  must_be_close(pipeline, before, run(pipeline, scans));
}

RC_GTEST_PROP(Symmetry, AMountingTurnedAboutTheVerticalTurnsTheMotion, ()) {
  Chance chance;
  const Pipeline& pipeline = any_doppler_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(chance.between(-3.1, 3.1) * Vector3d::UnitZ());
  for (RawScan& scan : scans) {
    for (Vector3d& point : scan.points) {
      point = T * point;
    }
  }
  must_be_close(pipeline, before, run(pipeline, scans), T);
}

RC_GTEST_PROP(Symmetry, FarOutliersDoNotPull, ()) {
  Chance chance;
  const Pipeline& pipeline = any_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  for (RawScan& scan : scans) {
    const std::size_t count = scan.points.size() / 50;
    for (std::size_t k = 0; k < count; ++k) {
      append_row(scan, scan, chance.below(scan.points.size()));
      scan.points.back() = chance.between(60.0, 400.0) * chance.direction();
      scan.doppler.back() = chance.between(-60.0, 60.0);
    }
  }
  must_be_close(pipeline, before, run(pipeline, scans));
}

RC_GTEST_PROP(Symmetry, ASensorMayBeCutInTwo, ()) {
  Chance chance;
  const Pipeline& pipeline = any_doppler_pipeline(chance);
  std::vector<RawScan> scans = any_drive(chance);
  const std::vector<Frame> before = run(pipeline, scans);
  const Vector3d seam = chance.direction();
  for (RawScan& scan : scans) {
    scan.mountings.resize(2, Eigen::Isometry3d::Identity());
    for (const Vector3d& point : scan.points) {
      scan.channels.sensor.push_back(point.dot(seam) > 0.0 ? 1 : 0);
    }
  }
  must_be_close(pipeline, before, run(pipeline, scans));
}

}  // namespace
}  // namespace dynamic_icp::odometry
