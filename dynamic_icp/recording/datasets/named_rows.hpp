// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/datasets/open_options.hpp"

namespace dynamic_icp::datasets {

/// An array of shape (N, k) whose columns are taken for columns with names.
struct NamedRows {
  std::string array;               ///< its name; empty: there is none to be taken so
  std::vector<std::string> names;  ///< of its columns; "_": not used
};

/// How the arrays of a recording are to be read.
struct ArrayReading {
  NamedRows rows;
  std::map<std::string, std::string> fields;  ///< as in OpenOptions, completed
  std::vector<std::string> assumptions;
};

/// Finds how the arrays of a scan hold points and Doppler where names alone do not say it: `fields` may name the array
/// of the points ("points"), which else is one of a known name or arr_0, as numpy.savez has it. One of four columns is
/// x, y, z and Doppler unless another array has a Doppler's name; wider ones are as the options state. Two arrays
/// without names, arr_0 of shape (N, 3) and arr_1 of shape (N,), are points and Doppler.
///
/// Throws UnclearInput where nobody says what the columns of a wide array are, or the options state another number of
/// them, or state columns of arrays that have names; UsageError where those are not as many.
ArrayReading read_arrays_as(const NamedColumns& scan, const OpenOptions& options, const std::filesystem::path& origin);

/// Throws UsageError where columns are stated by their order and the names of those of a file say that they are
/// spherical coordinates: what is stated would be taken of what is cartesian already.
void refuse_stated_columns(const FieldMap& fields, const OpenOptions& options, const std::filesystem::path& origin);

/// The scan with the columns of an array among its own columns, in place of the array.
std::unique_ptr<NamedColumns> with_rows(std::unique_ptr<NamedColumns> scan, const NamedRows& rows);

/// Finds the columns as map_fields does; where it finds none, UnclearInput proposes those of the scan that may be
/// meant, if there are any.
FieldMap map_columns(const NamedColumns& scan, const std::map<std::string, std::string>& fields,
                     const std::string& origin, const std::vector<std::string>& unusable);

}  // namespace dynamic_icp::datasets
