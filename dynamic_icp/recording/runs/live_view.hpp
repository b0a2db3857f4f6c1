// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/live/live_server.hpp"
#include "dynamic_icp/recording/runs/live_view_settings.hpp"
#include "dynamic_icp/recording/runs/run_messages.hpp"

namespace dynamic_icp::runs {

/// Sends the messages of a run (run_messages.hpp) to all who watch it (live/live_server.hpp).
///
/// The run hands over what it has done with; messages are made on a thread of low priority. Where that falls behind, or
/// a client does, scans are left out of the view, but for their poses; the run waits for nobody, and what it computes
/// is the same bits.
class LiveView {
 public:
  static constexpr std::size_t kMaxScansWaiting = 2;

  /// `truth` may be empty and must outlive the object. `name`: what clients show. Throws what LiveServer throws.
  LiveView(const LiveViewSettings& settings, const std::string& name, const formats::Trajectory& truth,
           RunMessagesSettings messages);

  /// Ends the view where `end` did not.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// "127.0.0.1:8765"
  [[nodiscard]] std::string authority() const;

  void add(RawScan scan, odometry::Frame frame, double latency_ms);

  /// Sends what is left, tells all clients that nothing more comes, and disconnects them; that takes a second or two at
  /// most. How many scans were left out.
  std::size_t end(std::string_view text);

 private:
  struct Waiting {
    RawScan scan;
    odometry::Frame frame;
    double latency_ms;
    formats::Trajectory left_out;  ///< the poses of the scans just before it that nobody sees
  };
  void make_messages();

  std::string address_;
  live::LiveServer server_;
  RunMessages messages_;
  std::mutex mutex_;  ///< of the next three
  std::deque<Waiting> waiting_;
  std::size_t left_out_ = 0;
  bool is_over_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace dynamic_icp::runs
