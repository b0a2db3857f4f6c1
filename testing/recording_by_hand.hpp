// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

// For tests: folders of recordings, made byte by byte from the published layouts.
namespace dynamic_icp::datasets {

inline std::string bytes_of(std::uint32_t bits) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) {
    bytes.push_back(static_cast<char>(bits >> (8 * k) & 0xff));
  }
  return bytes;
}

/// Little-endian float32.
inline std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float value : values) {
    bytes += bytes_of(std::bit_cast<std::uint32_t>(value));
  }
  return bytes;
}

/// A record of HeRCULES (29 bytes) of which HeLiPR's older ones are the first 25.
inline std::string aeva_record(float x, float y, float z, float velocity, std::int32_t time_ns, std::uint8_t line = 7) {
  return floats({x, y, z, 20.5F, velocity}) + bytes_of(static_cast<std::uint32_t>(time_ns)) + static_cast<char>(line) +
         floats({-57.0F});
}

/// The bytes of every number of four turned round.
inline std::string swapped(std::string bytes) {
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    std::swap(bytes[at], bytes[at + 3]);
    std::swap(bytes[at + 1], bytes[at + 2]);
  }
  return bytes;
}

/// The message of the DataError that an action throws, else "no error".
template <class Action>
std::string fault_of(const Action& action) {
  try {
    action();
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

/// What opening a recording and reading all of it says that fails.
inline std::string fault_of_reading(const std::filesystem::path& recording, const OpenOptions& options = {}) {
  return fault_of([&] {
    const std::unique_ptr<Dataset> dataset = open_dataset(recording, options);
    for (std::size_t i = 0; i < dataset->size(); ++i) {
      (void)dataset->scan(i);
      (void)dataset->columns(i);
    }
  });
}

/// Whether one of the assumptions holds these words.
inline bool said(const Dataset& dataset, const std::string& part) {
  const std::vector<std::string>& sentences = dataset.assumptions();
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(part) != std::string::npos; });
}

class RecordingByHand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(above_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(above_); }

  /// Writes a file below the folder of the recording.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// What opening says that fails.
  [[nodiscard]] std::string fault(const OpenOptions& options = {}) const {
    return fault_of([&] { (void)open_dataset(folder_, options); });
  }

  /// What reading this scan says that fails.
  [[nodiscard]] std::string scan_fault(std::size_t index) const {
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    return fault_of([&] { (void)dataset->scan(index); });
  }

  std::filesystem::path above_ =
      std::filesystem::temp_directory_path() / ("dynamic_icp_recording-" + std::to_string(::getpid()));
  std::filesystem::path folder_ = above_ / "recording";  ///< nothing beside it
};

inline void expect_within(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// The column of this name, as numbers; fails without it.
inline std::vector<double> column(const Dataset& dataset, std::size_t scan, const std::string& name) {
  for (const PointColumn& column : dataset.columns(scan)) {
    if (column.name == name) {
      return column.values;
    }
  }
  ADD_FAILURE() << "no column " << name;
  return {};
}

}  // namespace dynamic_icp::datasets
