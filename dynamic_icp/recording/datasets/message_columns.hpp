// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

namespace dynamic_icp::datasets {

/// The points of a message, by the names of their fields.
class MessageColumns final : public NamedColumns {
 public:
  explicit MessageColumns(messages::CloudColumns columns) : columns_(std::move(columns)) {}

  [[nodiscard]] const std::vector<std::string>& names() const override { return columns_.names(); }
  [[nodiscard]] formats::NpyArray read(const std::string& name) const override { return columns_.column(name); }

 private:
  messages::CloudColumns columns_;
};

}  // namespace dynamic_icp::datasets
