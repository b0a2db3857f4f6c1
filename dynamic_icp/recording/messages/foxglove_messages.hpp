// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/messages/messages.hpp"

// Foxglove's schemas, as protobuf and as JSON. Each function reads a whole message and throws DataError that begins
// with `origin` where it is damaged.
namespace dynamic_icp::messages {

PointCloud read_protobuf_cloud(std::string_view bytes, const std::string& origin);
StampedTransform read_protobuf_pose(std::string_view bytes, const std::string& origin);
StampedTransform read_protobuf_transform(std::string_view bytes, const std::string& origin);
std::vector<StampedTransform> read_protobuf_transforms(std::string_view bytes, const std::string& origin);

/// Time and frame of a cloud by the front of its message, nothing where the front ends before they are known.
std::optional<Header> protobuf_cloud_header(std::string_view front);

PointCloud read_json_cloud(std::string_view text, const std::string& origin);
StampedTransform read_json_pose(std::string_view text, const std::string& origin);
StampedTransform read_json_transform(std::string_view text, const std::string& origin);
std::vector<StampedTransform> read_json_transforms(std::string_view text, const std::string& origin);

/// The type of that number of foxglove.NumericType; throws DataError that names the field for others.
FieldType foxglove_field_type(std::uint64_t number, std::string_view field, const std::string& origin);

/// Says how many points there are: Foxglove leaves it to the size of the data. Throws DataError where that is no
/// multiple of the stride.
void set_width(PointCloud& cloud, const std::string& origin);

}  // namespace dynamic_icp::messages
