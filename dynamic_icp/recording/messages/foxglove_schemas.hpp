// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace dynamic_icp::messages {

/// The description of a message by which readers without any knowledge of it decode it: the bytes of a protobuf
/// FileDescriptorSet with the file of the message and those of all that it is made of. Known are those messages of
/// Foxglove (https://docs.foxglove.dev/docs/visualization/message-schemas) that are written here, with all of their
/// fields, and `dynamic_icp.OdometryState`. Throws std::out_of_range for other names.
std::string protobuf_schema(std::string_view message);

}  // namespace dynamic_icp::messages
