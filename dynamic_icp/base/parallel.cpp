// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace dynamic_icp {
namespace {

/// One loop: whoever has time takes the next block.
struct Loop {
  const std::function<void(std::size_t)>* run_block = nullptr;
  std::size_t blocks = 0;
  std::atomic<std::size_t> next{0};
  std::mutex fault_mutex;
  std::exception_ptr fault;

  void work() {
    for (std::size_t block = next++; block < blocks; block = next++) {
      try {
        (*run_block)(block);
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

/// Set while this thread works on a loop: a loop inside a loop runs on the thread that meets it.
thread_local bool inside_loop = false;

}  // namespace

// Threads of our own instead of a task library: all that is needed is "take the next block", and every
// synchronisation is visible to the thread sanitizer, which a packaged (not instrumented) library would hide.
class Workers::Pool {
 public:
  explicit Pool(int threads) {
    for (int i = 1; i < threads; ++i) {
      helpers_.emplace_back([this] { help(); });
    }
  }

  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) {
      helper.join();
    }
  }

  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  void run(std::size_t blocks, const std::function<void(std::size_t)>& run_block) {
    if (blocks <= 1 || helpers_.empty() || inside_loop) {
      for (std::size_t block = 0; block < blocks; ++block) {
        run_block(block);
      }
      return;
    }
    const std::lock_guard one_loop_at_a_time(caller_mutex_);
    Loop loop;
    loop.run_block = &run_block;
    loop.blocks = blocks;
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      busy_ = helpers_.size();
      ++generation_;
    }
    wake_.notify_all();
    work_on(loop);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    loop_ = nullptr;
    if (loop.fault) {
      std::rethrow_exception(loop.fault);
    }
  }

 private:
  static void work_on(Loop& loop) {
    inside_loop = true;
    loop.work();
    inside_loop = false;
  }

  void help() {
    std::size_t seen = 0;
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [&] { return stopping_ || generation_ != seen; });
      if (stopping_) {
        return;
      }
      seen = generation_;
      Loop& loop = *loop_;
      lock.unlock();
      work_on(loop);
      lock.lock();
      if (--busy_ == 0) {
        done_.notify_one();
      }
    }
  }

  std::mutex caller_mutex_;
  std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  std::condition_variable done_;
  Loop* loop_ = nullptr;
  std::size_t busy_ = 0;
  std::size_t generation_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> helpers_;
};

Workers::Workers(int threads) {
  if (threads < 0) {
    throw std::invalid_argument("number of threads is " + std::to_string(threads) + ", expected 0 (all) or more");
  }
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  pool_ = std::make_unique<Pool>(threads == 0 ? all : threads);
}

Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::threads() const { return pool_->threads(); }

void Workers::for_blocks(std::size_t n, std::size_t block_size,
                         const std::function<void(std::size_t, std::size_t, std::size_t)>& body) const {
  pool_->run(block_count(n, block_size),
             [&](std::size_t block) { body(block, block * block_size, std::min(n, (block + 1) * block_size)); });
}

}  // namespace dynamic_icp
