// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace dynamic_icp::simulation {

// Which random number is for what: streams of a RandomSource, or forks of it.

/// Of one ray.
enum RayStream : std::uint64_t {
  kDropout,
  kRangeNoise,
  kDopplerNoise,
  kOutlier,
  kOutlierValue,
  kScatterAcross,
  kScatterUp,
  kBeamRadius,
  kBeamAngle,
  kBeamShare,
  kRain,
  kRainRange,
  kRainVelocity,  // three normal numbers
  kDetection = kRainVelocity + 3,
  kAngleNoiseAcross,
  kAngleNoiseUp,
  kDuplicate,
  kWindow,
  kWindowRange,
  kMultipath,
  kSpray,
  kSprayRange,
  kSprayVelocity  // three normal numbers
};

/// Of one scan. Its forks are the rays.
enum ScanStream : std::uint64_t {
  kPeriodJitter,
  kStampJitter,
  kMissingScan,
  kDopplerDrift,
  kScanDoppler,
  kFiringDoppler  // and following: one for each firing
};

/// Forks of one unit of a sensor.
enum UnitPart : std::uint64_t {
  kSensorDoppler,
  kLineDoppler,
  kBeamDoppler,
  kFaceDoppler,
  kDirectionDoppler,
  kLinePointing,
  kFacePointing,
  kBeamRange
};

}  // namespace dynamic_icp::simulation
