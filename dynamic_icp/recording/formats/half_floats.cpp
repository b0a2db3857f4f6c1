// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/half_floats.hpp"

#include <cstdint>

#include <Eigen/Core>

#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::formats {

std::string widened_halves(std::string_view halves) {
  std::string floats;
  floats.reserve(halves.size() / kHalfBytes * sizeof(float));
  for (std::size_t at = 0; at + kHalfBytes <= halves.size(); at += kHalfBytes) {
    append_value(floats, static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(value_at<std::uint16_t>(halves, at))));
  }
  return floats;
}

}  // namespace dynamic_icp::formats
