// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::bags {

/// How the bytes of messages are to be read.
enum class Encoding : std::uint8_t { kUnknown, kRos1, kCdr, kProtobuf, kJson };

/// The messages of one name in a bag.
struct Topic {
  std::string name;  ///< as in the bag: "/lidar/points"
  std::string type;  ///< "sensor_msgs/PointCloud2", in ROS 1 and 2 alike; "foxglove.PointCloud"
  Encoding encoding = Encoding::kUnknown;
  std::string encoding_name;  ///< as in the bag, for messages
  std::string schema;         ///< as stored: text of a message definition, a FileDescriptorSet, ...; may be empty
  std::uint64_t messages = 0;
};

/// Where one message is.
struct MessageEntry {
  std::int64_t recorded_ns = 0;  ///< when it was recorded, Unix time
  std::uint64_t place = 0;       ///< of its chunk, record or row: the container's own business
  std::uint32_t offset = 0;      ///< within an uncompressed chunk
  std::uint32_t topic = 0;       ///< index into topics()
  std::uint32_t file = 0;        ///< of bags of several files
};

/// A recording of messages, whatever its container. Opening reads the index, never the messages; without an index, or
/// where it is damaged, everything up to the damage is looked through once. Memory grows with the number of messages
/// that are asked for, not with their size.
///
/// Thread-safe: `read` may be called by several threads.
class Bag {
 public:
  virtual ~Bag() = default;

  /// "rosbag", "rosbag2" or "mcap", as `--format` takes it.
  [[nodiscard]] virtual std::string_view container() const = 0;

  /// In the order of their names. Those of one name but several types or definitions are several.
  [[nodiscard]] virtual const std::vector<Topic>& topics() const = 0;

  /// The messages of some topics (indices into topics()), by the time of recording; equal times in the order of the
  /// file. Throws DataError naming file and place.
  [[nodiscard]] virtual std::vector<MessageEntry> messages(std::span<const std::size_t> topics) const = 0;

  /// The bytes of a message. Throws DataError naming file and place where they are damaged.
  [[nodiscard]] virtual std::string read(const MessageEntry& entry) const = 0;

  /// At least the first `bytes` bytes of a message where it has as many: for a look at its header. Containers that need
  /// not read the rest for that override it.
  [[nodiscard]] virtual std::string read_front(const MessageEntry& entry, std::size_t /*bytes*/) const {
    return read(entry);
  }

  /// The file that holds a message, for messages to the user.
  [[nodiscard]] virtual std::filesystem::path file(const MessageEntry& entry) const = 0;

  /// What was odd but could be lived with, in sentences: no index, damaged from which byte on and what is left.
  [[nodiscard]] virtual const std::vector<std::string>& notes() const = 0;
};

/// The bag that the input is or that lies up to three levels below it: a file *.bag, *.mcap, *.db3 (by its first
/// bytes), a folder of rosbag2 (metadata.yaml beside its files) or a folder of several such files; else empty. Throws
/// DataError that lists the bags when there are several. `container` ("rosbag", "rosbag2", "mcap") narrows what is
/// looked for.
std::filesystem::path find_bag(const std::filesystem::path& input, std::string_view container);

/// Opens what `find_bag` found. Throws DataError naming file, offset and what was expected.
std::unique_ptr<Bag> open_bag(const std::filesystem::path& found);

}  // namespace dynamic_icp::bags
