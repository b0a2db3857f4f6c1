// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace dynamic_icp {
namespace {

// The loops of one scan follow each other within microseconds, and a thread that sleeps needs some tens of them to wake
// up: a helper looks around for the next loop for a while before it sleeps.
constexpr std::chrono::microseconds kLookingTime{100};
constexpr int kLooksPerClock = 64;  // reading the clock takes longer than a look

/// Tells the processor that this thread waits in a loop.
void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

int machine_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

/// Set while this thread works on a loop: a loop inside a loop runs on the thread that meets it.
thread_local bool inside_loop = false;

}  // namespace

// Threads of our own instead of a task library: all that is needed is "take the next block", and every
// synchronisation is visible to the thread sanitizer, which a packaged (not instrumented) library would hide.
class Workers::Pool {
 public:
  explicit Pool(int threads) : may_look_(threads <= machine_threads()) {
    for (int i = 1; i < threads; ++i) {
      helpers_.emplace_back([this] { help(); });
    }
  }

  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      ++generation_;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) {
      helper.join();
    }
  }

  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  void run(std::size_t blocks, const BlockCall& call) {
    if (blocks <= 1 || helpers_.empty() || inside_loop) {
      for (std::size_t block = 0; block < blocks; ++block) {
        call.call(call.callable, block);
      }
      return;
    }
    const std::lock_guard one_loop_at_a_time(caller_mutex_);
    Loop loop{call, blocks};
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      ++generation_;
    }
    if (sleeping_ > 0) {
      wake_.notify_all();
    }
    work_on(loop);
    {
      // Nobody joins from here on: who still slept is not waited for.
      const std::lock_guard lock(mutex_);
      loop_ = nullptr;
    }
    wait_for_helpers();
    if (loop.fault) {
      std::rethrow_exception(loop.fault);
    }
  }

 private:
  /// One loop: whoever has time takes the next block.
  struct Loop {
    BlockCall call;
    std::size_t blocks = 0;
    std::atomic<std::size_t> next{0};
    std::mutex fault_mutex = {};
    std::exception_ptr fault = {};

    void work() {
      for (std::size_t block = next++; block < blocks; block = next++) {
        try {
          call.call(call.callable, block);
        } catch (...) {
          const std::lock_guard lock(fault_mutex);
          if (!fault) {
            fault = std::current_exception();
          }
          next = blocks;
        }
      }
    }
  };

  static void work_on(Loop& loop) {
    inside_loop = true;
    loop.work();
    inside_loop = false;
  }

  /// Looks whether something has come true until it has, or for long enough; not where that would take the processor
  /// from the thread that is waited for.
  template <class Condition>
  void look_for(const Condition& condition) const {
    const auto end = std::chrono::steady_clock::now() + kLookingTime;
    while (may_look_ && std::chrono::steady_clock::now() < end) {
      for (int look = 0; look < kLooksPerClock; ++look) {
        if (condition()) {
          return;
        }
        relax();
      }
    }
  }

  void wait_for_helpers() {
    look_for([this] { return active_ == 0; });
    if (active_ == 0) {
      return;
    }
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return active_ == 0; });
  }

  void help() {
    std::size_t seen = 0;
    while (true) {
      look_for([&] { return generation_ != seen; });
      std::unique_lock lock(mutex_);
      ++sleeping_;
      wake_.wait(lock, [&] { return generation_ != seen; });
      --sleeping_;
      seen = generation_;
      if (stopping_) {
        return;
      }
      if (loop_ == nullptr) {
        continue;
      }
      Loop& loop = *loop_;
      ++active_;
      lock.unlock();
      work_on(loop);
      lock.lock();
      if (--active_ == 0) {
        done_.notify_one();
      }
    }
  }

  const bool may_look_;
  std::mutex caller_mutex_;
  std::mutex mutex_;  // guards all below; the atomic ones are also looked at without it
  std::condition_variable wake_;
  std::condition_variable done_;
  Loop* loop_ = nullptr;
  std::atomic<std::size_t> generation_{0};
  std::atomic<std::size_t> active_{0};
  std::atomic<std::size_t> sleeping_{0};
  bool stopping_ = false;
  std::vector<std::thread> helpers_;
};

Workers::Workers(int threads) {
  if (threads < 0) {
    throw std::invalid_argument("number of threads is " + std::to_string(threads) + ", expected 0 (all) or more");
  }
  pool_ = std::make_unique<Pool>(threads == 0 ? machine_threads() : threads);
}

Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::threads() const { return pool_->threads(); }

void Workers::run(std::size_t blocks, const BlockCall& call) const { pool_->run(blocks, call); }

}  // namespace dynamic_icp
