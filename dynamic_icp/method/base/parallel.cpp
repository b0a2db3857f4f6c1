// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp {
namespace {

// The loops of one scan follow each other within microseconds, and a thread that sleeps needs some tens of them to wake
// up: a helper looks around for the next loop for a while before it sleeps.
constexpr std::chrono::microseconds kLookingTime{100};
constexpr std::size_t kDeepest = 64;  // loops in loops and of several callers; more of them are only slower
constexpr int kLooksPerClock = 64;    // reading the clock takes longer than a look

/// Tells the processor that this thread waits in a loop.
void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

int machine_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

}  // namespace

// Threads of our own instead of a task library: all that is needed is "take the next block", and every
// synchronisation is visible to the thread sanitizer, which a packaged (not instrumented) library would hide.
class Workers::Pool {
 public:
  explicit Pool(int threads) : may_look_(threads <= machine_threads()) {
    open_.reserve(kDeepest);
    helpers_.reserve(static_cast<std::size_t>(threads));
    try {
      for (int i = 1; i < threads; ++i) {
        helpers_.emplace_back([this] { help(); });
      }
    } catch (const std::system_error& error) {
      const std::size_t started = helpers_.size() + 1;
      stop();
      throw DataError("the machine starts " + std::to_string(started) + " of " + std::to_string(threads) +
                      " threads and no more: " + error.code().message());
    }
  }

  ~Pool() { stop(); }

  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  void run(std::size_t blocks, const BlockCall& call) {
    if (blocks <= 1 || helpers_.empty()) {
      for (std::size_t block = 0; block < blocks; ++block) {
        call.call(call.callable, block);
      }
      return;
    }
    Loop loop{.call = call, .blocks = blocks};
    open(loop);
    loop.work();
    finish(loop);
    if (loop.fault) {
      std::rethrow_exception(loop.fault);
    }
  }

 private:
  /// One loop: whoever has time takes the next block.
  struct Loop {
    BlockCall call;
    std::size_t blocks = 0;
    std::size_t number = 0;  ///< in the order of opening
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> active{0};  ///< helpers at work on it
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

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      ++opened_;
    }
    changed_.notify_all();
    for (std::thread& helper : helpers_) {
      helper.join();
    }
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

  /// Lets others join a loop.
  void open(Loop& loop) {
    {
      const std::lock_guard lock(mutex_);
      loop.number = ++opened_;
      open_.push_back(&loop);
    }
    if (sleeping_ > 0) {
      changed_.notify_all();
    }
  }

  /// Closes a loop, whose blocks are all taken, and waits for those who still work on one. The time is used to help
  /// with what they have opened meanwhile.
  void finish(Loop& loop) {
    std::unique_lock lock(mutex_);
    std::erase(open_, &loop);  // nobody joins from here on: who still slept is not waited for
    while (loop.active > 0) {
      if (join(lock, loop.number)) {
        continue;
      }
      const std::size_t seen = opened_;
      lock.unlock();
      const auto is_news = [&] { return loop.active == 0 || opened_ != seen; };
      look_for(is_news);
      lock.lock();
      sleep(lock, is_news);
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      if (join(lock, 0)) {
        continue;
      }
      const std::size_t seen = opened_;
      lock.unlock();
      const auto is_news = [&] { return opened_ != seen; };
      look_for(is_news);
      lock.lock();
      sleep(lock, is_news);
    }
  }

  template <class Condition>
  void sleep(std::unique_lock<std::mutex>& lock, const Condition& until) {
    ++sleeping_;
    changed_.wait(lock, until);
    --sleeping_;
  }

  /// Works on the loop opened last that has blocks left; false when there is none newer than `number`: who waits inside
  /// a loop goes deeper, never out of it and in again. Called and left with the lock held.
  bool join(std::unique_lock<std::mutex>& lock, std::size_t number) {
    const auto found = std::find_if(open_.rbegin(), open_.rend(), [&](const Loop* loop) {
      return loop->number > number && loop->next < loop->blocks;
    });
    if (found == open_.rend()) {
      return false;
    }
    Loop& loop = **found;
    ++loop.active;
    lock.unlock();
    loop.work();
    lock.lock();
    if (--loop.active == 0 && sleeping_ > 0) {
      changed_.notify_all();
    }
    return true;
  }

  const bool may_look_;
  std::mutex mutex_;  // guards all below; the atomic ones are also looked at without it
  std::condition_variable changed_;
  std::vector<Loop*> open_;
  std::atomic<std::size_t> opened_{0};  ///< counts, so that news are told from what is known
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
