// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"

// What the containers share.
namespace dynamic_icp::bags {

/// From the first to the last message, by the times of recording.
struct TimeSpan {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

/// A bag of one file.
class FileBag : public Bag {
 public:
  [[nodiscard]] std::string_view container() const override { return container_; }
  [[nodiscard]] const std::vector<Topic>& topics() const override { return topics_; }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return notes_; }
  [[nodiscard]] std::filesystem::path file(const MessageEntry& /*entry*/) const override { return path_; }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Keeps something alive as long as the bag: the temporary file that it reads.
  void keep(std::shared_ptr<const void> something) { kept_ = std::move(something); }
  void add_note(std::string note) { notes_.push_back(std::move(note)); }

  /// Empty where there are no messages.
  [[nodiscard]] virtual std::optional<TimeSpan> span() const = 0;

 protected:
  FileBag(std::string_view container, std::filesystem::path path) : container_(container), path_(std::move(path)) {}

  // Set by the constructor of what derives from this.
  std::vector<Topic> topics_;
  std::vector<std::string> notes_;

 private:
  std::shared_ptr<const void> kept_;  // the last to go
  std::string_view container_;
  std::filesystem::path path_;
};

// One for each container: of a file, and how messages name it. They throw DataError naming file and place.
std::unique_ptr<FileBag> open_ros1_bag(const std::filesystem::path& path, const std::filesystem::path& name);
std::unique_ptr<FileBag> open_mcap(const std::filesystem::path& path, const std::filesystem::path& name);
std::unique_ptr<FileBag> open_sqlite_bag(const std::filesystem::path& path, const std::filesystem::path& name);

/// Topics in the order of Bag::topics(), and which of them each channel (connection, row of a table) belongs to:
/// several senders may share one.
struct TopicTable {
  std::vector<Topic> topics;
  std::map<std::uint64_t, std::uint32_t> topic_of;  ///< by the container's number of a channel
};

/// The same topics that several channels have become one.
TopicTable table_of(const std::map<std::uint64_t, Topic>& channels);

/// "sensor_msgs/PointCloud2" for "sensor_msgs/msg/PointCloud2" and "sensor_msgs::msg::dds_::PointCloud2_";
/// "foxglove.PointCloud" for "foxglove::PointCloud".
std::string plain_type(std::string_view type);

/// Whether a topic is among those that are asked for, by its index.
std::vector<bool> chosen(std::span<const std::size_t> wanted, std::size_t topics);

/// The messages of topics that are asked for.
std::vector<MessageEntry> of_topics(std::span<const MessageEntry> entries, const std::vector<bool>& is_wanted);

/// Sorts by time, then by place in the file.
void sort_by_time(std::vector<MessageEntry>& entries);

}  // namespace dynamic_icp::bags
