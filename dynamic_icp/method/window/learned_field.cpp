// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/learned_field.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::window {
namespace {

// More is no sensor; a field for them would fill the memory.
constexpr std::size_t kMaxFileSensors = 64;
constexpr std::size_t kMaxFileLines = 1024;
constexpr std::size_t kMaxFileFaces = 256;

/// Whether there is a number for each unknown of the field.
bool fits(const SensorCalibration& calibration, const DopplerErrorField& field) {
  bool result = calibration.parts.size() == field.groups().size() && calibration.information.size() == field.size() &&
                calibration.gradient.size() == field.size() && calibration.stamp_sigma_s > 0.0 &&
                calibration.stamp_sigma_s < 1.0 && calibration.period_sigma_s > 0.0 &&
                calibration.period_sigma_s < 1.0 && calibration.scan_error_mps > 0.0 &&
                calibration.scan_error_mps < 10.0;
  for (std::size_t k = 0; result && k < field.groups().size(); ++k) {
    const SensorCalibration::Part& part = calibration.parts[k];
    result = part.error_mps.size() == field.groups()[k].size() && part.name == field.groups()[k].name &&
             part.scale_mps > 0.0;
  }
  for (std::size_t k = 0; result && k < field.size(); ++k) {
    result = calibration.information[k].size() == k + 1;
  }
  return result;
}

}  // namespace

bool is_possible(const FieldShape& shape) {
  return !shape.views.empty() && shape.views.size() <= kMaxFileSensors && shape.lines() <= kMaxFileLines &&
         shape.faces > 0 && shape.faces <= kMaxFileFaces;
}

LearnedField learned_field(const SensorCalibration& calibration) {
  const FieldShape& shape = calibration.shape;
  if (!is_possible(shape)) {
    throw UsageError(
        fmt::format("a calibration of {} sensors, {} lines and {} faces; expected 1 to {}, 0 to {} and 1 to {}",
                    shape.views.size(), shape.lines(), shape.faces, kMaxFileSensors, kMaxFileLines, kMaxFileFaces));
  }
  LearnedField learned{DopplerErrorField(shape), {}, {}, {}};
  if (!fits(calibration, learned.field)) {
    throw UsageError("the parts of the calibration do not fit its sensors, lines and faces");
  }
  const auto n = static_cast<Eigen::Index>(learned.field.size());
  learned.theta.resize(n);
  learned.gradient.resize(n);
  learned.information.resize(n, n);
  for (std::size_t k = 0; k < learned.field.groups().size(); ++k) {
    DopplerErrorField::Group& group = learned.field.groups()[k];
    group.tau = calibration.parts[k].scale_mps;
    for (std::size_t i = 0; i < group.size(); ++i) {
      learned.theta[static_cast<Eigen::Index>(group.begin + i)] = calibration.parts[k].error_mps[i];
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    learned.gradient[i] = calibration.gradient[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j) {
      learned.information(i, j) = learned.information(j, i) =
          calibration.information[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  Eigen::MatrixXd with_prior = learned.information;
  learned.field.add_prior_information(with_prior);
  if (!with_prior.allFinite() || !learned.gradient.allFinite() || !learned.theta.allFinite() ||
      with_prior.llt().info() != Eigen::Success) {
    throw UsageError("the information of the calibration is no positive definite matrix of finite numbers");
  }
  return learned;
}

}  // namespace dynamic_icp::window
