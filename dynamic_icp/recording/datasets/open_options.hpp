// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace dynamic_icp::datasets {

/// What a user may say about a recording that it does not say itself. How its numbers are corrected is
/// Correction's (correction.hpp).
struct OpenOptions {
  std::string format = "auto";  ///< or one of known_formats()

  /// Of layouts whose columns have names (npz, pcd, ply, csv, bags): the column that holds x, y, z, doppler or time, or
  /// the array that holds the points, where it is not to be guessed from the names in the wild (field_names.hpp).
  std::map<std::string, std::string> fields = {};

  /// Of numbers without names, one after the other: records (dicp, bin), rows of an array (npy, npz) or of a text
  /// (csv). What each is, in names as above and in the order in which they are stored; "_" is not used. Empty: x, y, z,
  /// doppler, or what the content tells.
  std::vector<std::string> columns = {};

  /// The type of the numbers of records: a name of record_types(). Empty: float32.
  std::string dtype = {};

  /// Of recordings with several sensors: those to be merged, by their names there. Empty: the layout's own choice.
  std::vector<std::string> sensors = {};

  /// Of bags: the topics of clouds to read; several are the sensors of a rig, the first of which gives frame and times.
  /// Empty: the only one whose points have a Doppler.
  std::vector<std::string> topics = {};

  /// Of bags: the topic whose poses are ground truth, or "parent>child", a pair of frames of transforms. Empty: one
  /// whose name says so.
  std::string truth_topic = {};

  /// Time from scan to scan where the recording has no times, s.
  double period_s = 0.1;
};

/// The names of types that the numbers of records may have: float32, float64, int16, ...
std::vector<std::string> record_types();

}  // namespace dynamic_icp::datasets
