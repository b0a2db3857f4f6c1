// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {

/// A recording that can be read once its user says more of it: which topic of a bag, what the numbers of a record are.
class UnclearInput : public DataError {
 public:
  /// Names and texts of settings, as `set` takes them (input_settings.hpp): {"columns", "x,y,z,_,doppler"}.
  using Settings = std::vector<std::pair<std::string, std::string>>;

  UnclearInput(const std::string& what, Settings proposal, std::vector<Settings> others = {})
      : DataError(what), proposal_(std::move(proposal)), others_(std::move(others)) {}

  /// Settings with which it may be read; not empty. The message does not speak of them: how they are stated is for the
  /// program to say.
  [[nodiscard]] const Settings& proposal() const { return proposal_; }

  /// What may be meant instead, as likely or less so.
  [[nodiscard]] const std::vector<Settings>& others() const { return others_; }

 private:
  Settings proposal_;
  std::vector<Settings> others_;
};

}  // namespace dynamic_icp::datasets
