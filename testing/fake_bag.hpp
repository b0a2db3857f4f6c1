// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"

#include "testing/ros_bytes.hpp"

namespace dynamic_icp::bags {

/// For tests: a bag in memory.
class FakeBag final : public Bag {
 public:
  /// Adds a message; those of one topic in the order of their times.
  void add(const std::string& name, const std::string& type, std::int64_t recorded_ns, std::string bytes,
           Encoding encoding = Encoding::kRos1) {
    auto found = std::find_if(topics_.begin(), topics_.end(), [&](const Topic& topic) { return topic.name == name; });
    if (found == topics_.end()) {
      topics_.push_back({name, type, encoding, "by hand", "", 0});
      found = std::prev(topics_.end());
    }
    ++found->messages;
    entries_.push_back({recorded_ns, messages_.size(), 0, static_cast<std::uint32_t>(found - topics_.begin()), 0});
    messages_.push_back(std::move(bytes));
  }

  /// Transforms in one message of tf2_msgs/TFMessage.
  struct Transform {
    std::string parent;
    std::string child;
    Eigen::Isometry3d T;
  };
  void add_transforms(const std::string& name, std::int64_t stamp_ns, const std::vector<Transform>& transforms) {
    ros::Writer writer(ros::Wire::kRos1);
    writer.put(static_cast<std::uint32_t>(transforms.size()));
    for (const Transform& one : transforms) {
      writer.header(stamp_ns, one.parent).text(one.child).pose(one.T);
    }
    add(name, "tf2_msgs/TFMessage", stamp_ns, writer.bytes());
  }

  /// The bytes of message `number` of all; to be damaged.
  std::string& message(std::size_t number) { return messages_.at(number); }

  [[nodiscard]] std::string_view container() const override { return "rosbag"; }
  [[nodiscard]] const std::vector<Topic>& topics() const override { return topics_; }
  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> topics) const override {
    std::vector<MessageEntry> found;
    std::copy_if(entries_.begin(), entries_.end(), std::back_inserter(found), [&](const MessageEntry& entry) {
      return std::find(topics.begin(), topics.end(), entry.topic) != topics.end();
    });
    std::stable_sort(found.begin(), found.end(),
                     [](const MessageEntry& a, const MessageEntry& b) { return a.recorded_ns < b.recorded_ns; });
    return found;
  }
  [[nodiscard]] std::string read(const MessageEntry& entry) const override { return messages_.at(entry.place); }
  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    return messages_.at(entry.place).substr(0, bytes);
  }
  [[nodiscard]] std::filesystem::path file(const MessageEntry& /*entry*/) const override { return "fake.bag"; }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return notes_; }

 private:
  std::vector<Topic> topics_;
  std::vector<MessageEntry> entries_;
  std::vector<std::string> messages_;
  std::vector<std::string> notes_;
};

}  // namespace dynamic_icp::bags
