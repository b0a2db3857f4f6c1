// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Bags of 20 GB, nearly all of it holes in files, of a topic that nobody asks for.
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/recording/bags/bag.hpp"

#include "testing/bag_contents.hpp"
#include "testing/bags_by_hand.hpp"
#include "testing/temporary_folder.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DYNAMIC_ICP_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DYNAMIC_ICP_SANITIZED
#endif
#endif

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;
using by_hand::number;
using by_hand::text;

constexpr std::uint32_t kImageBytes = 1'000'000'000;
constexpr std::uint32_t kCloudBytes = 1'000'000;
constexpr int kImages = 20;
constexpr int kCloudsPerImage = 20;
constexpr long kMaxRssKb = 200 * 1000;

const by_hand::Channel kImage{1, "/image", "sensor_msgs/Image", "x", "cdr"};
const by_hand::Channel kCloud{2, "/points", "sensor_msgs/PointCloud2", "x", "cdr"};

/// A file that takes no room where nothing was written.
class SparseFile {
 public:
  explicit SparseFile(const fs::path& path) : descriptor_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {}
  ~SparseFile() { ::close(descriptor_); }
  SparseFile(const SparseFile&) = delete;
  SparseFile& operator=(const SparseFile&) = delete;

  void write(const std::string& bytes) {
    write_at(size_, bytes);
    size_ += bytes.size();
  }
  void write_at(std::uint64_t at, const std::string& bytes) const {
    if (::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at)) !=
        static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("cannot write");
    }
  }
  /// Zeros.
  void skip(std::uint64_t bytes) { size_ += bytes; }
  /// Whether files of this size can be here.
  [[nodiscard]] bool can_be_large() const {
    return ::ftruncate(descriptor_, off_t{1} << 35) == 0 && ::ftruncate(descriptor_, 0) == 0;
  }
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// All messages of both topics, one a chunk: calls add(channel, time, bytes of data); these begin with the time.
void for_each_message(const std::function<void(std::uint16_t, std::int64_t, std::uint32_t)>& add) {
  std::int64_t time = 1'000'000'000;
  for (int image = 0; image < kImages; ++image) {
    add(kImage.id, time++, kImageBytes);
    for (int cloud = 0; cloud < kCloudsPerImage; ++cloud) {
      add(kCloud.id, time++, kCloudBytes);
    }
  }
}

std::string u32(std::uint64_t value) { return number(static_cast<std::uint32_t>(value)); }

void write_ros1(SparseFile& file) {
  const std::string magic = "#ROSBAG V2.0\n";
  file.write(magic + by_hand::ros1_bag_header(0, 0, 0));
  std::string infos;
  std::uint32_t chunks = 0;
  for_each_message([&](std::uint16_t channel, std::int64_t time, std::uint32_t bytes) {
    const std::uint64_t chunk_at = file.size();
    const std::string connection = u32(channel);
    const std::string stamp = by_hand::ros1_time(time);
    // A message without its data is what stands in front of them, with the length 0 at its end.
    std::string head = by_hand::ros1_message({channel, time, ""});
    head.replace(head.size() - 4, 4, u32(bytes));
    std::string chunk = by_hand::ros1_record(
        '\x05', by_hand::ros1_field("compression", "none") + by_hand::ros1_field("size", u32(head.size() + bytes)), "");
    chunk.replace(chunk.size() - 4, 4, u32(head.size() + bytes));
    file.write(chunk + head + number(time));
    file.skip(bytes - 8);
    const std::string fields = by_hand::ros1_field("ver", u32(1));
    file.write(by_hand::ros1_record(
        '\x04', fields + by_hand::ros1_field("conn", connection) + by_hand::ros1_field("count", u32(1)),
        stamp + u32(0)));
    infos += by_hand::ros1_record('\x06',
                                  fields + by_hand::ros1_field("chunk_pos", number(chunk_at)) +
                                      by_hand::ros1_field("start_time", stamp) +
                                      by_hand::ros1_field("end_time", stamp) + by_hand::ros1_field("count", u32(1)),
                                  connection + u32(1));
    ++chunks;
  });
  const std::uint64_t index_at = file.size();
  file.write(by_hand::ros1_connection(kImage) + by_hand::ros1_connection(kCloud) + infos);
  file.write_at(magic.size(), by_hand::ros1_bag_header(index_at, 2, chunks));
}

void write_mcap(SparseFile& file) {
  const std::string magic = "\x89MCAP0\r\n";
  const std::string channels = by_hand::mcap_schema(kImage) + by_hand::mcap_channel(kImage) +
                               by_hand::mcap_schema(kCloud) + by_hand::mcap_channel(kCloud);
  file.write(magic + by_hand::mcap_record('\x01', text("") + text("")) + channels);
  std::string indices;
  std::uint32_t chunks = 0;
  for_each_message([&](std::uint16_t channel, std::int64_t time, std::uint32_t bytes) {
    const std::uint64_t chunk_at = file.size();
    const std::uint64_t message_size = std::uint64_t{22} + bytes;
    const std::string message = "\x05" + number(message_size) + number(channel) + u32(0) + number(time) + number(time);
    const std::uint64_t size = 9 + message_size;
    const std::string head =
        number(time) + number(time) + number(size) + u32(0) + text("") + number(size);  // no checksum
    file.write("\x06" + number(head.size() + size) + head + message + number(time));
    file.skip(bytes - 8);
    const std::uint64_t index_at = file.size();
    file.write(by_hand::mcap_record('\x07', number(channel) + text(number(time) + number(std::uint64_t{0}))));
    indices +=
        by_hand::mcap_record('\x08', number(time) + number(time) + number(chunk_at) + number(index_at - chunk_at) +
                                         text(number(channel) + number(index_at)) + number(file.size() - index_at) +
                                         text("") + number(size) + number(size));
    ++chunks;
  });
  file.write(by_hand::mcap_record('\x0F', u32(0)));
  const std::uint64_t summary_at = file.size();
  const std::uint64_t images = kImages;
  const std::uint64_t clouds = std::uint64_t{kImages} * kCloudsPerImage;
  file.write(
      channels + indices +
      by_hand::mcap_record('\x0B', number(images + clouds) + number(std::uint16_t{2}) + u32(2) + u32(0) + u32(0) +
                                       u32(chunks) + number(std::uint64_t{0}) + number(std::uint64_t{0}) +
                                       text(number(kImage.id) + number(images) + number(kCloud.id) + number(clouds))) +
      "\x02" + number(std::uint64_t{20}) + number(summary_at) + number(std::uint64_t{0}) + u32(0) + magic);
}

/// Reads all clouds; whether they are what was written.
bool reads_clouds(const fs::path& path) {
  const std::unique_ptr<Bag> bag = open_bag(path);
  const std::vector<MessageEntry> entries = bag->messages({{1}});
  if (!bag->notes().empty() || bag->topics().at(1).name != kCloud.topic ||
      entries.size() != std::size_t{kImages} * kCloudsPerImage) {
    return false;
  }
  for (const MessageEntry& entry : entries) {
    const std::string data = bag->read(entry);
    if (data.size() != kCloudBytes || formats::number_in<std::int64_t>(data, 0) != entry.recorded_ns) {
      return false;
    }
  }
  return true;
}

class LargeFile : public benchmark::FolderTest {
 protected:
  /// In a process of its own, whose memory is seen.
  void check(const std::function<void(SparseFile&)>& write) {
    const fs::path path = folder_ / "large";
    {
      SparseFile file(path);
      if (!file.can_be_large()) {
        GTEST_SKIP() << "no files of 20 GB can be in " << folder_;
      }
      write(file);
    }
    EXPECT_GT(fs::file_size(path), 20'000'000'000U);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool is_right = false;
      try {
        is_right = reads_clouds(path);
      } catch (...) {
      }
      std::_Exit(is_right ? 0 : 1);
    }
    int status = 0;
    rusage usage{};
    ASSERT_EQ(::wait4(child, &status, 0, &usage), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
#ifndef DYNAMIC_ICP_SANITIZED  // sanitizers keep what was freed
    EXPECT_LT(usage.ru_maxrss, kMaxRssKb);
#endif
    RecordProperty("max_rss_kb", static_cast<int>(usage.ru_maxrss));
  }
};

TEST_F(LargeFile, OfRos1IsReadByItsIndex) { check(write_ros1); }

TEST_F(LargeFile, OfMcapIsReadByItsIndex) { check(write_mcap); }

}  // namespace
}  // namespace dynamic_icp::bags
