// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_queue.hpp"

#include <algorithm>
#include <deque>
#include <map>

#include "dynamic_icp/tools/benchmark/cell_run.hpp"
#include "dynamic_icp/tools/benchmark/child_process.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"

namespace dynamic_icp::benchmark {
namespace {

constexpr double kMemoryReserve = 2.0;  // times the largest cell so far

class Queue {
 public:
  Queue(const std::vector<CellPlan>& plans, const QueueOptions& options, const QueueEvents& events)
      : plans_(plans), options_(options), events_(events) {}

  void run() {
    take_saved();
    while (!waiting_.empty() || !running_.empty()) {
      while (may_start()) {
        start_next();
      }
      finish_one();
    }
  }

 private:
  void take_saved() {
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      const auto saved = options_.repeat ? std::nullopt : saved_result(options_.folder, plans_[i]);
      if (saved) {
        report(i, *saved, true);
      } else {
        waiting_.push_back(i);
      }
    }
  }

  [[nodiscard]] bool may_start() const {
    if (waiting_.empty() || running_.size() >= static_cast<std::size_t>(options_.jobs)) {
      return false;
    }
    const auto available_mib = running_.empty() ? std::nullopt : available_memory_mib();
    return !available_mib || *available_mib >= kMemoryReserve * largest_mib_;
  }

  void start_next() {
    const std::size_t plan = waiting_.front();
    waiting_.pop_front();
    running_[start_cell(options_.folder, options_.program, plans_[plan])] = plan;
    events_.started(plan);
  }

  void finish_one() {
    const EndedChild child = wait_for_child();
    const auto cell = running_.find(child.pid);
    if (cell != running_.end()) {
      const std::size_t plan = cell->second;
      running_.erase(cell);
      report(plan, finish_cell(options_.folder, plans_[plan], child, options_.jobs), false);
    }
  }

  void report(std::size_t plan, const CellResult& result, bool saved) {
    largest_mib_ = std::max(largest_mib_, result.peak_memory_mib.value_or(0.0));
    events_.ended(plan, result, saved);
  }

  const std::vector<CellPlan>& plans_;
  const QueueOptions& options_;
  const QueueEvents& events_;
  std::deque<std::size_t> waiting_;
  std::map<pid_t, std::size_t> running_;
  double largest_mib_ = 0.0;
};

}  // namespace

void run_cells(const std::vector<CellPlan>& plans, const QueueOptions& options, const QueueEvents& events) {
  Queue(plans, options, events).run();
}

}  // namespace dynamic_icp::benchmark
