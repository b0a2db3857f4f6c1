// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::messages {

/// The bytes of one number.
std::size_t size_of(FieldType type);

/// "float32", as PointField's constants are called.
std::string_view name_of(FieldType type);

/// Takes a cloud apart by its fields, whatever their order, type, count, padding and byte order.
class CloudColumns {
 public:
  /// `origin` names the message. Throws DataError when fields do not lie in a point, or there are fewer data than the
  /// points take: nothing is read beyond what is there. More of them are left out.
  CloudColumns(PointCloud cloud, std::string origin);

  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }

  /// Rows of all columns.
  [[nodiscard]] std::size_t points() const { return points_; }

  /// Of the fields, each once; padding without a name is none.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// One of them, of the type that it has: (N,), or (N, count) where a field has several numbers. Throws DataError
  /// where there is none of that name.
  [[nodiscard]] formats::NpyArray column(std::string_view name) const;

  /// One number of each point, converted to double.
  [[nodiscard]] std::vector<double> values(std::string_view name, std::size_t element = 0) const;

 private:
  PointCloud cloud_;
  std::string origin_;
  std::size_t points_ = 0;
  std::vector<std::string> names_;
};

}  // namespace dynamic_icp::messages
