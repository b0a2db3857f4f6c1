// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pcd_read.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <lzf.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/plain_rows.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::size_t kLzfRepeat = 264;  // bytes that LZF makes of one byte at most

/// Appends a number of that type from its text; false for text that is no such number.
template <class Number>
bool append_text(std::string& bytes, std::string_view text) {
  std::optional<Number> number = parse_number<Number>(text);
  if constexpr (std::is_same_v<Number, float>) {
    // What is too small or too large for a float32 has been written by someone who thought in doubles.
    const std::optional<double> wide = number ? std::nullopt : parse_number<double>(text);
    number = wide ? static_cast<float>(*wide) : number;
  }
  if (number) {
    append_value(bytes, *number);
  }
  return number.has_value();
}

bool append_text(std::string& bytes, NpyType type, std::string_view text) {
  return with_type(type, [&](auto zero) { return append_text<decltype(zero)>(bytes, text); });
}

/// Where a number stands in the record of a point, and its type.
struct NumberPlace {
  NpyType type = NpyType::kFloat32;
  std::size_t offset_bytes = 0;
};

std::vector<NumberPlace> number_places(const PcdHeader& header) {
  std::vector<NumberPlace> places;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) {
      places.push_back({field.type, field.offset_bytes + k * size_of(field.type)});
    }
  }
  return places;
}

std::size_t numbers_of_a_point(const PcdHeader& header) {
  std::size_t numbers = 0;
  for (const PcdField& field : header.fields) {
    numbers += field.count;
  }
  return numbers;
}

/// Reads a number of that type among the characters that follow; where it ends, or null where there is none.
const char* take_text(const char* at, const char* end, NpyType type, char* to) {
  return with_type(type, [&](auto number) {
    const char* const stop = take_number(at, end, number);
    std::memcpy(to, &number, sizeof number);
    return stop;
  });
}

/// Copies `kBytes` from the beginning of each record.
template <std::size_t kBytes>
void copy_field(const char* records, std::size_t record_bytes, std::size_t points, char* to) {
  for (std::size_t i = 0; i < points; ++i) {
    std::memcpy(to + i * kBytes, records + i * record_bytes, kBytes);
  }
}

/// The same for any number of bytes; those of one number are quick.
void copy_field(const char* records, std::size_t record_bytes, std::size_t points, char* to, std::size_t bytes) {
  if (bytes == 4) {
    copy_field<4>(records, record_bytes, points, to);
  } else if (bytes == 8) {
    copy_field<8>(records, record_bytes, points, to);
  } else {
    for (std::size_t i = 0; i < points; ++i) {
      std::copy_n(records + i * record_bytes, bytes, to + i * bytes);
    }
  }
}

}  // namespace

PcdFile::PcdFile(const std::filesystem::path& path) : PcdFile(read_whole_file(path), path) {}

PcdFile::PcdFile(std::string content, const std::filesystem::path& origin)
    : origin_(origin.string()), bytes_(std::move(content)) {
  refuse_other_kind(origin, bytes_, FileKind::kPcd);
  header_ = parse_pcd_header(bytes_, origin_);
  with_memory_for(origin, [this] { read_data(); });
}

void PcdFile::fail(std::string_view message) const { throw DataError(fmt::format("{}: {}", origin_, message)); }

void PcdFile::read_data() {
  if (header_.encoding == PcdEncoding::kAscii) {
    read_ascii();
  } else if (header_.encoding == PcdEncoding::kBinary) {
    read_binary();
  } else {
    unpack();
  }
}

void PcdFile::read_ascii() {
  std::string_view rest = std::string_view(bytes_).substr(header_.data_offset);
  const std::size_t numbers = numbers_of_a_point(header_);
  // A number takes a digit and what parts it from the next; the last line may have no end.
  if (header_.points > (rest.size() + 1) / (2 * numbers)) {
    fail(fmt::format("{} points of {} numbers each, expected at most {}: the file has {} bytes left", header_.points,
                     numbers, (rest.size() + 1) / (2 * numbers), rest.size()));
  }
  std::string records;
  records.reserve(header_.points * header_.record_bytes);
  const bool has_points = header_.points > 0;  // then the file is long enough for one
  const std::vector<NumberPlace> places = has_points ? number_places(header_) : std::vector<NumberPlace>();
  std::string record(has_points ? header_.record_bytes : 0, '\0');
  const auto take = [&](std::size_t k, const char* at, const char* end) {
    return take_text(at, end, places[k].type, record.data() + places[k].offset_bytes);
  };
  std::vector<std::string_view> words;
  std::size_t point = 0;
  for (std::size_t line = header_.lines + 1;; ++line) {
    if (point < header_.points && take_plain_row(rest, ' ', numbers, take)) {
      records += record;
      ++point;
      continue;
    }
    const std::optional<std::string_view> text = take_line(rest);
    if (!text) {
      break;
    }
    split_words(*text, words);
    if (words.empty()) {
      continue;
    }
    if (point++ == header_.points) {
      fail(fmt::format("line {}: a point after the last one, expected {} points", line, header_.points));
    }
    if (words.size() != numbers) {
      fail(fmt::format("line {}: {} numbers, expected {} for a point", line, words.size(), numbers));
    }
    std::size_t word = 0;
    for (const PcdField& field : header_.fields) {
      for (std::size_t k = 0; k < field.count; ++k, ++word) {
        if (!append_text(records, field.type, words[word])) {
          fail(fmt::format("line {}: number {} ('{}') is no {}", line, word + 1, field.name, code_of(field.type)));
        }
      }
    }
  }
  if (point != header_.points) {
    fail(fmt::format("the file ends after {} points, expected {}", point, header_.points));
  }
  bytes_ = std::move(records);
  header_.data_offset = 0;
}

void PcdFile::read_binary() {
  const std::size_t room = bytes_.size() - header_.data_offset;
  const std::size_t whole = room / header_.record_bytes;
  if (header_.points > whole) {
    fail(fmt::format("{} points of {} bytes each after the header, expected at most {}: the file has {} bytes left",
                     header_.points, header_.record_bytes, whole, room));
  }
  const std::size_t rest = room - header_.points * header_.record_bytes;
  if (rest >= header_.record_bytes) {
    fail(fmt::format("{} bytes after the last of {} points of {} bytes each, expected the end of the file", rest,
                     header_.points, header_.record_bytes));
  }
  if (rest > 0) {
    warning_ = fmt::format("{}: {} bytes after the last of {} points are left out", origin_, rest, header_.points);
  }
}

void PcdFile::unpack() {
  const std::string_view data = std::string_view(bytes_).substr(header_.data_offset);
  constexpr std::size_t kSizes = 2 * sizeof(std::uint32_t);
  if (data.size() < kSizes) {
    fail(
        fmt::format("{} bytes after the header, expected the sizes of the compressed data in {}", data.size(), kSizes));
  }
  const std::size_t packed = value_at<std::uint32_t>(data, 0);
  const std::size_t unpacked = value_at<std::uint32_t>(data, sizeof(std::uint32_t));
  if (packed > data.size() - kSizes) {
    fail(fmt::format("{} bytes of compressed data, expected at most {}: the file ends there", packed,
                     data.size() - kSizes));
  }
  if (unpacked % header_.record_bytes != 0 || unpacked / header_.record_bytes != header_.points) {
    fail(fmt::format("compressed data of {} bytes, expected {} points of {} bytes each", unpacked, header_.points,
                     header_.record_bytes));
  }
  if (const std::size_t rest = data.size() - kSizes - packed; rest > 0) {
    warning_ = fmt::format("{}: {} bytes after the compressed data are left out", origin_, rest);
  }
  if (unpacked / kLzfRepeat > packed) {  // before memory is taken
    fail(fmt::format("{} bytes of compressed data cannot hold {}", packed, unpacked));
  }
  std::string bytes(unpacked, '\0');
  const unsigned written = packed == 0 ? 0
                                       : lzf_decompress(data.data() + kSizes, static_cast<unsigned>(packed),
                                                        bytes.data(), static_cast<unsigned>(unpacked));
  if (written != unpacked) {
    fail(fmt::format("damaged compressed data: they do not unpack to {} bytes", unpacked));
  }
  bytes_ = std::move(bytes);
  header_.data_offset = 0;
}

std::vector<std::string> PcdFile::names() const {
  std::vector<std::string> names;
  for (const PcdField& field : header_.fields) {
    if (!field.is_padding()) {
      names.push_back(field.name);
    }
  }
  return names;
}

NpyArray PcdFile::read(std::string_view name) const {
  const auto field = std::find_if(header_.fields.begin(), header_.fields.end(),
                                  [&](const PcdField& f) { return f.name == name && !f.is_padding(); });
  if (field == header_.fields.end()) {
    fail(fmt::format("field '{}' is missing, expected it among: {}", name, fmt::join(names(), " ")));
  }
  NpyArray array{field->type, {header_.points}, {}, fmt::format("{}: field '{}'", origin_, name)};
  if (field->count != 1) {
    array.shape.push_back(field->count);
  }
  const std::string_view data = std::string_view(bytes_).substr(header_.data_offset);
  const std::size_t bytes = field->bytes();
  if (header_.encoding == PcdEncoding::kBinaryCompressed) {
    array.bytes = data.substr(field->offset_bytes * header_.points, bytes * header_.points);
    return array;
  }
  array.bytes.resize(bytes * header_.points);
  copy_field(data.data() + field->offset_bytes, header_.record_bytes, header_.points, array.bytes.data(), bytes);
  return array;
}

}  // namespace dynamic_icp::formats
