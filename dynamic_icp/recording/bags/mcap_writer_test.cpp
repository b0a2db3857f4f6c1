// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The bytes are taken apart here by the specification (https://mcap.dev/spec), without the project's reader. Whole
// files are read by @mcap/core in tests/interop.
#include "dynamic_icp/recording/bags/mcap_writer.hpp"

#include <filesystem>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zstd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::bags {
namespace {

using formats::value_at;

/// Reads a record's content from front to back.
class WrittenContent {
 public:
  explicit WrittenContent(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  Number number() {
    EXPECT_GE(bytes_.size(), sizeof(Number));
    const auto value = value_at<Number>(bytes_, 0);
    bytes_.remove_prefix(sizeof(Number));
    return value;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view take(std::size_t size) {
    EXPECT_GE(bytes_.size(), size);
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

struct WrittenRecord {
  int opcode = 0;
  std::size_t offset = 0;  ///< of its opcode
  std::size_t size = 0;    ///< with opcode and length
  std::string_view content;
};

std::vector<WrittenRecord> written_records(std::string_view bytes, std::size_t begin = 0) {
  std::vector<WrittenRecord> records;
  std::size_t at = begin;
  while (at < bytes.size()) {
    const auto length = value_at<std::uint64_t>(bytes, at + 1);
    records.push_back({static_cast<std::uint8_t>(bytes[at]), at, 9 + length, bytes.substr(at + 9, length)});
    at += 9 + length;
  }
  EXPECT_EQ(at, bytes.size());
  return records;
}

constexpr std::string_view kWrittenMagic{"\x89MCAP0\r\n", 8};

std::vector<WrittenRecord> file_records(const std::string& file) {
  EXPECT_EQ(file.substr(0, 8), kWrittenMagic);
  EXPECT_EQ(file.substr(file.size() - 8), kWrittenMagic);
  return written_records(std::string_view(file).substr(0, file.size() - 8), 8);
}

/// CRC-32 bit by bit, as the standard defines it.
std::uint32_t slow_crc(std::string_view bytes) {
  std::uint32_t state = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    state ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      state = (state >> 1U) ^ ((state & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~state;
}

/// Two channels, many messages, small chunks.
std::string sample_file(const McapSettings& settings) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, settings);
  const std::uint16_t schema = writer.add_schema({"a.Type", "protobuf", std::string("\0\1\2", 3)});
  const std::uint16_t first = writer.add_channel({schema, "/first", "protobuf", {{"key", "value"}}});
  const std::uint16_t second = writer.add_channel({schema, "/second", "protobuf", {}});
  for (int k = 0; k < 40; ++k) {
    const Stamp stamp{1'724'479'779'384'729'506 + 7 * k};
    writer.write(k % 3 == 0 ? second : first, stamp, std::string(static_cast<std::size_t>(k), 'x'));
    if (k == 20) {
      writer.add_metadata("about", {{"b", "2"}, {"a", "1"}});
    }
  }
  writer.finish();
  return file;
}

McapSettings small_chunks(int zstd_level) {
  McapSettings settings;
  settings.library = "test";
  settings.chunk_bytes = 300;
  settings.zstd_level = zstd_level;
  return settings;
}

std::vector<WrittenRecord> with_opcode(const std::vector<WrittenRecord>& records, int opcode) {
  std::vector<WrittenRecord> found;
  std::copy_if(records.begin(), records.end(), std::back_inserter(found),
               [opcode](const WrittenRecord& record) { return record.opcode == opcode; });
  return found;
}

TEST(McapWriter, AnEmptyFileByHand) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, small_chunks(1));
  writer.finish();
  const std::vector<WrittenRecord> records = file_records(file);
  ASSERT_EQ(records.size(), 5U);  // header, end of data, statistics, offset of these, footer
  EXPECT_EQ(records[0].opcode, 0x01);
  EXPECT_EQ(records[0].content, std::string_view("\0\0\0\0\4\0\0\0test", 12));
  EXPECT_EQ(records[1].opcode, 0x0F);
  EXPECT_EQ(value_at<std::uint32_t>(records[1].content, 0), slow_crc(std::string_view(file).substr(0, 8 + 9 + 12)));
  EXPECT_EQ(records[2].opcode, 0x0B);
  EXPECT_EQ(records[2].content, std::string(46, '\0'));
  EXPECT_EQ(records[3].opcode, 0x0E);
  EXPECT_EQ(records[4].opcode, 0x02);
}

TEST(McapWriter, EveryMessageIsWhereTheIndexSays) {
  for (const int level : {0, 1}) {
    const std::string file = sample_file(small_chunks(level));
    const std::vector<WrittenRecord> records = file_records(file);
    const std::vector<WrittenRecord> chunks = with_opcode(records, 0x06);
    const std::vector<WrittenRecord> indexes = with_opcode(records, 0x08);
    ASSERT_GT(chunks.size(), 3U);
    ASSERT_EQ(indexes.size(), chunks.size());
    std::size_t found = 0;
    std::uint64_t last_time = 0;
    for (std::size_t k = 0; k < chunks.size(); ++k) {
      WrittenContent chunk(chunks[k].content);
      const auto start = chunk.number<std::uint64_t>();
      const auto end = chunk.number<std::uint64_t>();
      const auto size = chunk.number<std::uint64_t>();
      const auto crc = chunk.number<std::uint32_t>();
      EXPECT_EQ(chunk.text(), level == 0 ? "" : "zstd");
      const std::string_view packed = chunk.take(chunk.number<std::uint64_t>());
      EXPECT_TRUE(chunk.at_end());
      std::string inside(size, '\0');
      if (level == 0) {
        inside = packed;
      } else {
        ASSERT_EQ(ZSTD_decompress(inside.data(), inside.size(), packed.data(), packed.size()), size);
      }
      ASSERT_EQ(inside.size(), size);
      EXPECT_EQ(crc, slow_crc(inside));
      EXPECT_GT(start, last_time);
      last_time = end;

      WrittenContent index(indexes[k].content);
      EXPECT_EQ(index.number<std::uint64_t>(), start);
      EXPECT_EQ(index.number<std::uint64_t>(), end);
      EXPECT_EQ(index.number<std::uint64_t>(), chunks[k].offset);
      EXPECT_EQ(index.number<std::uint64_t>(), chunks[k].size);
      WrittenContent offsets(index.text());
      const auto index_length = index.number<std::uint64_t>();
      EXPECT_EQ(index.text(), level == 0 ? "" : "zstd");
      EXPECT_EQ(index.number<std::uint64_t>(), packed.size());
      EXPECT_EQ(index.number<std::uint64_t>(), size);
      EXPECT_TRUE(index.at_end());

      std::size_t index_bytes = 0;
      while (!offsets.at_end()) {
        const auto channel = offsets.number<std::uint16_t>();
        const auto at = offsets.number<std::uint64_t>();
        ASSERT_EQ(file[at], 0x07);
        const auto length = value_at<std::uint64_t>(file, at + 1);
        index_bytes += 9 + length;
        WrittenContent messages(std::string_view(file).substr(at + 9, length));
        EXPECT_EQ(messages.number<std::uint16_t>(), channel);
        WrittenContent pairs(messages.text());
        while (!pairs.at_end()) {
          const auto time = pairs.number<std::uint64_t>();
          const auto offset = pairs.number<std::uint64_t>();
          ASSERT_EQ(inside[offset], 0x05);
          WrittenContent message(
              std::string_view(inside).substr(offset + 9, value_at<std::uint64_t>(inside, offset + 1)));
          EXPECT_EQ(message.number<std::uint16_t>(), channel);
          message.number<std::uint32_t>();
          EXPECT_EQ(message.number<std::uint64_t>(), time);
          EXPECT_EQ(message.number<std::uint64_t>(), time);
          const std::uint64_t place = (time - 1'724'479'779'384'729'506U) / 7;
          EXPECT_EQ(message.rest(), std::string(place, 'x'));
          EXPECT_EQ(channel, place % 3 == 0 ? 1 : 0);
          EXPECT_GE(time, start);
          EXPECT_LE(time, end);
          ++found;
        }
      }
      EXPECT_EQ(index_bytes, index_length);
    }
    EXPECT_EQ(found, 40U);
  }
}

TEST(McapWriter, TheSummaryRepeatsAndCounts) {
  const std::string file = sample_file(small_chunks(1));
  const std::vector<WrittenRecord> records = file_records(file);
  ASSERT_EQ(records.back().opcode, 0x02);
  WrittenContent footer(records.back().content);
  const auto summary_start = footer.number<std::uint64_t>();
  const auto offsets_start = footer.number<std::uint64_t>();
  EXPECT_EQ(footer.number<std::uint32_t>(),
            slow_crc(std::string_view(file).substr(summary_start, file.size() - 8 - 4 - summary_start)));

  const WrittenRecord data_end = with_opcode(records, 0x0F).front();
  EXPECT_EQ(data_end.offset + data_end.size, summary_start);
  EXPECT_EQ(value_at<std::uint32_t>(data_end.content, 0), slow_crc(std::string_view(file).substr(0, data_end.offset)));

  // Each group lies where the summary's offsets say, and holds records of one kind.
  std::size_t at = summary_start;
  for (const WrittenRecord& record : with_opcode(records, 0x0E)) {
    WrittenContent offset(record.content);
    const auto opcode = offset.number<std::uint8_t>();
    EXPECT_EQ(offset.number<std::uint64_t>(), at);
    const auto length = offset.number<std::uint64_t>();
    for (const WrittenRecord& inside : written_records(std::string_view(file).substr(at, length))) {
      EXPECT_EQ(inside.opcode, opcode);
    }
    at += length;
  }
  EXPECT_EQ(at, offsets_start);

  WrittenContent schema(with_opcode(records, 0x03).back().content);
  EXPECT_EQ(schema.number<std::uint16_t>(), 1);
  EXPECT_EQ(schema.text(), "a.Type");
  EXPECT_EQ(schema.text(), "protobuf");
  EXPECT_EQ(schema.text(), std::string("\0\1\2", 3));
  WrittenContent channel(with_opcode(records, 0x04).front().content);
  EXPECT_EQ(channel.number<std::uint16_t>(), 0);
  EXPECT_EQ(channel.number<std::uint16_t>(), 1);
  EXPECT_EQ(channel.text(), "/first");
  EXPECT_EQ(channel.text(), "protobuf");
  EXPECT_EQ(channel.text(), std::string_view("\3\0\0\0key\5\0\0\0value", 16));

  WrittenContent statistics(with_opcode(records, 0x0B).front().content);
  EXPECT_EQ(statistics.number<std::uint64_t>(), 40U);
  EXPECT_EQ(statistics.number<std::uint16_t>(), 1U);
  EXPECT_EQ(statistics.number<std::uint32_t>(), 2U);
  EXPECT_EQ(statistics.number<std::uint32_t>(), 0U);
  EXPECT_EQ(statistics.number<std::uint32_t>(), 1U);
  EXPECT_EQ(statistics.number<std::uint32_t>(), with_opcode(records, 0x06).size());
  EXPECT_EQ(statistics.number<std::uint64_t>(), 1'724'479'779'384'729'506U);
  EXPECT_EQ(statistics.number<std::uint64_t>(), 1'724'479'779'384'729'506U + 7 * 39);
  WrittenContent counts(statistics.text());
  EXPECT_EQ(counts.number<std::uint16_t>(), 0U);
  EXPECT_EQ(counts.number<std::uint64_t>(), 26U);
  EXPECT_EQ(counts.number<std::uint16_t>(), 1U);
  EXPECT_EQ(counts.number<std::uint64_t>(), 14U);

  WrittenContent metadata_index(with_opcode(records, 0x0D).front().content);
  const auto place = metadata_index.number<std::uint64_t>();
  EXPECT_EQ(with_opcode(records, 0x0C).front().offset, place);
  EXPECT_EQ(with_opcode(records, 0x0C).front().size, metadata_index.number<std::uint64_t>());
  EXPECT_EQ(metadata_index.text(), "about");
}

TEST(McapWriter, TheSameCallsGiveTheSameBytes) {
  EXPECT_EQ(sample_file(small_chunks(1)), sample_file(small_chunks(1)));
}

TEST(McapWriter, RefusesTimesBefore1970) {
  McapWriter writer([](std::string_view) {});
  const std::uint16_t channel = writer.add_channel({0, "/points", "json", {}});
  try {
    writer.write(channel, Stamp{-1}, "{}");
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("/points is at -0.000000001 s"), std::string::npos) << error.what();
  }
}

TEST(McapWriter, AFullDiskIsNamed) {
  formats::StagedFile full("/dev/full");
  try {
    McapWriter writer([&](std::string_view bytes) { full.write(bytes); });
    writer.finish();
    full.commit();
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()), "/dev/full: cannot write: No space left on device");
  }
}

TEST(McapWriter, KeepsOneChunkInMemory) {
  std::size_t largest = 0;
  std::size_t written = 0;
  McapSettings settings;
  settings.zstd_level = 0;
  McapWriter writer(
      [&](std::string_view bytes) {
        largest = std::max(largest, bytes.size());
        written += bytes.size();
      },
      settings);
  const std::uint16_t channel = writer.add_channel({0, "/points", "json", {}});
  const std::string message(1U << 20U, 'x');
  for (int k = 0; k < 40; ++k) {
    writer.write(channel, Stamp{k}, message);
    EXPECT_LT(static_cast<std::size_t>(k) * message.size(), written + settings.chunk_bytes);
  }
  writer.finish();
  EXPECT_LT(largest, settings.chunk_bytes + message.size() + 1000);
}

// 4 MB that would become 64 GB: each channel has a copy of the description of its type.
TEST(McapReader, DescriptionsOfTopicsTakeABoundedAmountOfMemory) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("mcap_descriptions-" + std::to_string(::getpid()) + ".mcap");
  for (const std::size_t channels : {200U, 300U}) {
    std::string file;
    McapWriter writer([&](std::string_view bytes) { file += bytes; }, small_chunks(0));
    const std::uint16_t schema = writer.add_schema({"a.Type", "protobuf", std::string(1U << 20U, 'x')});
    for (std::size_t k = 0; k < channels; ++k) {
      writer.add_channel({schema, "/topic" + std::to_string(k), "protobuf", {}});
    }
    writer.finish();
    formats::write_whole_file(path, file);
    if (channels == 200U) {
      EXPECT_EQ(open_bag(path)->topics().size(), channels);
      continue;
    }
    try {
      open_bag(path);
      ADD_FAILURE() << "must throw";
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find("descriptions of its topics have more than 256 MiB"), std::string::npos)
          << error.what();
    }
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dynamic_icp::bags
