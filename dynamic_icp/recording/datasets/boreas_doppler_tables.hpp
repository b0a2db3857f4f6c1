// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"

namespace dynamic_icp::datasets {

// The systematic error of the Doppler of Boreas-Aeva's sensor, an Aeries I, as its authors measured it: a folder
// aeva_calib/ of text files, numbers between commas, whose format is known from the readers they published (steam_icp,
// and a variant of Doppler-ICP):
//   rt_part.csv             a line per beam: where each part of the scan begins, 0 to 1 of the scan's duration; the end
//                           of the last part may follow
//   azi_minmax_<beam>.csv   a line per part: least and greatest azimuth, rad
//   vel_mean_<beam>.csv     a line per part: mean error, m/s, in cells of equal width between these azimuths
// The tables themselves have not been at hand.

constexpr std::size_t kBoreasBeams = 4;

/// What a beam's Doppler says too much in one part of a scan, by azimuth: about one line of the scan.
struct BoreasDopplerPart {
  double begin = 0.0;  ///< share of the scan's duration
  double min_azimuth_rad = 0.0;
  double max_azimuth_rad = 0.0;
  std::vector<double> bias_mps;  ///< of cells of equal width, at least one
};

/// By beam: its parts, in the order of time, at least one.
using BoreasDopplerTables = std::array<std::vector<BoreasDopplerPart>, kBoreasBeams>;

/// The folder in which tables of a recording lie, or some of their files: aeva_calib/ or calib/ in its folder, that
/// folder itself, or aeva_calib/ in the one above, which serves several recordings. Empty when there is none.
std::filesystem::path find_boreas_doppler_tables(const std::filesystem::path& recording);

/// A file of the models that doppler_odom of the same authors uses instead (lines by elevation and a regression by
/// range; or polynomials in range, intensity and the scan's median Doppler), in the same places. They are not read: the
/// settings they go with are not beside them. Empty when there is none.
std::filesystem::path find_doppler_odom_model(const std::filesystem::path& recording);

/// Reads the nine files of a folder. Throws DataError naming file and line, and what was expected.
BoreasDopplerTables read_boreas_doppler_tables(const std::filesystem::path& folder);

/// The error of the Doppler of one beam. As in the published readers the first and the last part, and the outermost
/// cells, reach on without end.
double boreas_doppler_bias_mps(const std::vector<BoreasDopplerPart>& beam, double scan_share, double azimuth_rad);

/// Takes the error out of the Doppler of a scan, whose lines are its beams. The scan lasts from the earliest to the
/// latest time of its points, as in the published readers. Points without finite coordinates or time, and those of
/// another beam, keep their Doppler; of the latter, and of scans without beams or times, the scan's warning says so.
void subtract_boreas_doppler_bias(const BoreasDopplerTables& tables, const std::filesystem::path& file, RawScan& scan);

}  // namespace dynamic_icp::datasets
