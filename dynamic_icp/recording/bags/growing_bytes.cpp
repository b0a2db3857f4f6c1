// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/growing_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::bags {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kBetweenLooks{5};     // at the size of a file
constexpr milliseconds kBetweenNames{250};   // whether its name still leads to it
constexpr milliseconds kLastBytes{1000};     // that may still come into a file without a name
constexpr milliseconds kAskAgain{50};        // whether a stream is still wanted
constexpr milliseconds kLongestDrain{1000};  // for the end of a stream that nobody needs
constexpr std::uint64_t kBlock = std::uint64_t{1} << 20U;
constexpr std::uint64_t kReadAhead = std::uint64_t{256} << 20U;

class GrowingFile final : public GrowingBytes {
 public:
  explicit GrowingFile(const std::filesystem::path& file) : GrowingBytes(file), file_(file) {
    grow_to(file_.size(), std::nullopt);  // came before it was followed
    watcher_ = std::thread([this] { watch(); });
  }
  ~GrowingFile() override {
    is_stopped_ = true;
    watcher_.join();
  }

  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes) const override { return file_.read(at, bytes); }

 private:
  void watch() {
    while (!is_stopped_) {
      try {
        if (!look()) {
          return;
        }
      } catch (const DataError& error) {
        fail(error.what());
        return;
      }
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }

  /// Whether to look again.
  bool look() {
    const struct ::stat status = file_.look_again();
    const std::uint64_t known = size();
    if (file_.size() < known) {
      fail(fmt::format("{}: became shorter while it was followed: had {} bytes, has {}", path().string(), known,
                       file_.size()));
      return false;
    }
    const steady_clock::time_point now = steady_clock::now();
    if (file_.size() > known) {
      const std::lock_guard lock(mutex_);
      grow_to(file_.size(), now);
      changed_.notify_all();
      grown_at_ = now;
    }
    if (now >= name_looked_at_ + kBetweenNames) {
      name_looked_at_ = now;
      look_at_name(status);
    }
    // Who moves a file away may still have something to write into it.
    if (!lost_name_.empty() && now - std::max(lost_at_, grown_at_) >= kLastBytes) {
      fail(fmt::format("{}: {} while it was followed, after {} bytes", path().string(), lost_name_, size()));
      return false;
    }
    return true;
  }

  void look_at_name(const struct ::stat& followed) {
    struct ::stat named {};
    const bool is_there = ::stat(path().c_str(), &named) == 0;
    const bool is_same = is_there && named.st_dev == followed.st_dev && named.st_ino == followed.st_ino;
    if (is_same) {
      lost_name_.clear();
    } else if (lost_name_.empty()) {
      lost_name_ = is_there ? "was replaced by another file" : "was removed or renamed";
      lost_at_ = steady_clock::now();
    }
  }

  ReadableFile file_;
  std::string lost_name_;  ///< what happened to its name; empty: nothing
  steady_clock::time_point lost_at_;
  steady_clock::time_point grown_at_;
  steady_clock::time_point name_looked_at_;
  std::atomic<bool> is_stopped_ = false;
  std::thread watcher_;
};

class GrowingStream final : public GrowingBytes {
 public:
  GrowingStream(int descriptor, const std::string& name) : GrowingBytes(name), descriptor_(descriptor) {
    reader_ = std::thread([this] { pump(); });
  }
  ~GrowingStream() override {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, is_drained_ ? kLongestDrain : milliseconds(0),
                        [&] { return has_ended() || fault_.has_value(); });
    }
    is_stopped_ = true;
    reader_.join();
  }

  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes) const override {
    const std::lock_guard lock(mutex_);
    if (at < begin_) {
      throw DataError(fmt::format("{}: byte {} is no longer there: a stream is read once", path().string(), at));
    }
    if (at > size() || bytes > size() - at) {
      throw Damage(path(), at, fmt::format("the stream ends at byte {}, expected {} more bytes", size(), bytes));
    }
    std::string content = formats::with_memory_for(path(), [&] { return std::string(bytes, '\0'); });
    for (std::uint64_t done = 0; done < bytes;) {
      const std::uint64_t place = at + done - begin_;
      const std::string& block = blocks_[place / kBlock];
      const std::uint64_t count = std::min(bytes - done, block.size() - place % kBlock);
      std::memcpy(content.data() + done, block.data() + place % kBlock, count);
      done += count;
    }
    return content;
  }

  void forget_before(std::uint64_t place) override {
    const std::lock_guard lock(mutex_);
    while (!blocks_.empty() && begin_ + kBlock <= std::min(place, size())) {
      blocks_.pop_front();
      begin_ += kBlock;
    }
    changed_.notify_all();
  }

  [[nodiscard]] std::uint64_t kept() const override {
    const std::lock_guard lock(mutex_);
    return size() - begin_;
  }

  void drain() override { is_drained_ = true; }

 private:
  void pump() {
    std::string piece(kBlock, '\0');
    while (!is_stopped_ && !has_ended()) {
      if (!has_room()) {
        continue;
      }
      ::pollfd ready = {descriptor_, POLLIN, 0};
      const int count = ::poll(&ready, 1, static_cast<int>(kAskAgain.count()));
      if (count == 0 || (count < 0 && errno == EINTR)) {
        continue;
      }
      const ssize_t got = ::read(descriptor_, piece.data(), piece.size());
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) {
        continue;
      }
      if (got < 0) {
        fail(fmt::format("{}: cannot read at byte {}: {}", path().string(), size(), std::strerror(errno)));
        return;
      }
      const std::lock_guard lock(mutex_);
      if (got == 0) {
        end();
      } else if (!is_drained_) {
        append(std::string_view(piece).substr(0, static_cast<std::size_t>(got)));
      }
      changed_.notify_all();
    }
  }

  /// Waits a while for it. What somebody waits for is read in any case: a record may be longer than the limit.
  bool has_room() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kAskAgain,
                             [&] { return is_drained_ || size() - begin_ < kReadAhead || size() < wanted_; });
  }

  void append(std::string_view bytes) {
    std::uint64_t size_now = size();
    while (!bytes.empty()) {
      if (blocks_.empty() || blocks_.back().size() == kBlock) {
        blocks_.emplace_back().reserve(kBlock);
      }
      const std::uint64_t count = std::min<std::uint64_t>(bytes.size(), kBlock - blocks_.back().size());
      blocks_.back().append(bytes.substr(0, count));
      bytes.remove_prefix(count);
      size_now += count;
    }
    grow_to(size_now, steady_clock::now());
  }

  int descriptor_;
  std::uint64_t begin_ = 0;  ///< of the bytes that are kept
  std::deque<std::string> blocks_;
  std::atomic<bool> is_drained_ = false;
  std::atomic<bool> is_stopped_ = false;
  std::thread reader_;
};

}  // namespace

bool GrowingBytes::wait_for(std::uint64_t bytes, milliseconds longest) {
  std::unique_lock lock(mutex_);
  wanted_ = bytes;
  changed_.notify_all();
  changed_.wait_for(lock, longest, [&] { return size_ >= bytes || has_ended_ || fault_; });
  if (size_ < bytes && fault_) {
    throw DataError(*fault_);
  }
  return size_ >= bytes;
}

std::optional<Arrival> GrowingBytes::arrival(std::uint64_t place) {
  const std::lock_guard lock(mutex_);
  while (!growth_.empty() && growth_.front().size < place) {
    growth_.pop_front();
  }
  if (!growth_.empty()) {
    last_arrival_ = growth_.front().at;
  }
  return last_arrival_;
}

void GrowingBytes::grow_to(std::uint64_t bytes, std::optional<Arrival> at) {
  size_ = bytes;
  growth_.push_back({bytes, at});
}

void GrowingBytes::fail(const std::string& why) {
  const std::lock_guard lock(mutex_);
  fault_ = why;
  changed_.notify_all();
}

std::unique_ptr<GrowingBytes> growing_file(const std::filesystem::path& path) {
  return std::make_unique<GrowingFile>(path);
}

std::unique_ptr<GrowingBytes> growing_stream(int descriptor, const std::string& name) {
  return std::make_unique<GrowingStream>(descriptor, name);
}

}  // namespace dynamic_icp::bags
