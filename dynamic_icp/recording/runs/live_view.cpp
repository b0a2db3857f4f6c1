// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/live_view.hpp"

#include <exception>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/live/low_priority.hpp"
#include "dynamic_icp/recording/messages/foxglove_schemas.hpp"

namespace dynamic_icp::runs {
namespace {

std::vector<live::Channel> live_channels(bool has_truth) {
  std::vector<live::Channel> channels;
  for (const RunTopicRow& row : run_topics()) {
    if (row.topic != RunTopic::kTruthPath || has_truth) {
      // Points are made for those who want them: the last ones may be long ago.
      channels.push_back({row.name, row.type, messages::protobuf_schema(row.type), row.topic != RunTopic::kPoints});
    }
  }
  return channels;
}

RunMessagesSettings on_one_thread(RunMessagesSettings settings) {
  settings.threads = 1;
  return settings;
}

}  // namespace

LiveView::LiveView(const LiveViewSettings& settings, const std::string& name, const formats::Trajectory& truth,
                   RunMessagesSettings messages)
    : address_(settings.access.address),
      server_({.access = settings.access, .name = name, .page = settings.page}, live_channels(!truth.empty())),
      messages_({.write =
                     [this](RunTopic topic, Stamp stamp, std::string bytes) {
                       server_.publish(static_cast<std::size_t>(topic), stamp, std::move(bytes));
                     },
                 .wants_points = [this] { return server_.is_wanted(static_cast<std::size_t>(RunTopic::kPoints)); }},
                truth, on_one_thread(std::move(messages))),
      thread_([this] { make_messages(); }) {}

LiveView::~LiveView() {
  try {
    end("the run has ended");
  } catch (const std::exception&) {
    // No memory for a farewell: the clients see the connection end.
  }
}

std::string LiveView::authority() const { return live::authority(address_, server_.port()); }

void LiveView::add(RawScan scan, odometry::Frame frame, double latency_ms) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back({std::move(scan), std::move(frame), latency_ms, {}});
  if (waiting_.size() > kMaxScansWaiting) {
    formats::Trajectory poses = std::move(waiting_.front().left_out);
    poses.push_back({waiting_.front().frame.stamp, waiting_.front().frame.T_world_sensor});
    waiting_.pop_front();
    waiting_.front().left_out = std::move(poses);
    ++left_out_;
  }
  changed_.notify_one();
}

std::size_t LiveView::end(std::string_view text) {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
      changed_.notify_one();
    }
    thread_.join();
    server_.end(std::string(text));
  }
  return left_out_;
}

void LiveView::make_messages() {
  live::lower_own_priority();
  live::name_own_thread("live messages");
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
    if (waiting_.empty()) {
      return;
    }
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    try {
      for (const formats::StampedPose& pose : next.left_out) {
        messages_.pass(pose);
      }
      messages_.add(next.scan, next.frame, next.latency_ms);
      server_.tell_time(next.frame.stamp);
    } catch (const DataError&) {
      // What no message can hold, such as a time before 1970, is not shown.
    }
    lock.lock();
  }
}

}  // namespace dynamic_icp::runs
