// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace dynamic_icp::speed {

/// A fixed piece of work outside this project, run on one scan: what a scan takes us over what that takes travels
/// between machines. The program is called with one argument, a file of float32 x, y, z (m), Doppler (m/s), and prints
/// its milliseconds.
class ReferenceWork {
 public:
  /// On the scan in the middle of the recording. Throws DataError when that cannot be read.
  ReferenceWork(std::filesystem::path program, const std::filesystem::path& recording);
  ~ReferenceWork();
  ReferenceWork(const ReferenceWork&) = delete;
  ReferenceWork& operator=(const ReferenceWork&) = delete;

  /// Runs the program once: ms. Throws DataError when it fails or prints something else than a time.
  [[nodiscard]] double run() const;

  [[nodiscard]] std::size_t scan() const { return scan_; }
  [[nodiscard]] std::size_t points() const { return points_; }

 private:
  std::filesystem::path program_;
  std::filesystem::path file_;
  std::size_t scan_ = 0;
  std::size_t points_ = 0;
};

/// The milliseconds a program printed, above zero; throws DataError naming the program for anything else.
double parse_milliseconds(std::string_view printed, const std::filesystem::path& program);

}  // namespace dynamic_icp::speed
