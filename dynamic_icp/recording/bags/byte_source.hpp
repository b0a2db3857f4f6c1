// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <sys/stat.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::bags {

/// Bytes that are missing or contradict each other. The message names the file and the byte: "<file>: byte <n>:
/// <what>".
class Damage : public DataError {
 public:
  Damage(const std::filesystem::path& file, std::uint64_t byte, const std::string& what);

  [[nodiscard]] std::uint64_t byte() const { return byte_; }         ///< of the file
  [[nodiscard]] const std::string& reason() const { return what_; }  ///< without the place

 private:
  std::uint64_t byte_;
  std::string what_;
};

/// No message and no chunk may be longer: a length beyond that is damage, or would not fit into memory anyway.
constexpr std::uint64_t kMaxPieceBytes = std::uint64_t{1} << 30U;

/// Bytes that are read at any place, of a file or of what was kept of a stream. Thread-safe.
class ReadableBytes {
 public:
  ReadableBytes(const ReadableBytes&) = delete;
  ReadableBytes& operator=(const ReadableBytes&) = delete;
  virtual ~ReadableBytes() = default;

  /// As messages name it.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// As far as is known.
  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /// Exactly so many bytes. Throws Damage where they are not there, and before anything is allocated.
  [[nodiscard]] virtual std::string read(std::uint64_t at, std::uint64_t bytes) const = 0;

 protected:
  explicit ReadableBytes(std::filesystem::path path) : path_(std::move(path)) {}

 private:
  std::filesystem::path path_;
};

/// A regular file.
class ReadableFile final : public ReadableBytes {
 public:
  /// Throws DataError naming file and reason. `name`: how messages name it; as `path` where empty.
  explicit ReadableFile(const std::filesystem::path& path, const std::filesystem::path& name = {});
  ~ReadableFile() override;

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes) const override;

  /// The file as it is now: of one that others write to its size is looked up again. Throws DataError where that fails.
  [[nodiscard]] struct ::stat look_again();

 private:
  std::atomic<std::uint64_t> size_ = 0;
  int descriptor_ = -1;
};

/// Bytes that records are taken from, wherever they lie.
class ByteSource {
 public:
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Bytes that stay as they are until the next call. Throws Damage where they go beyond the end.
  std::string_view bytes(std::uint64_t at, std::uint64_t count);

  /// Damage that names a place in these bytes.
  [[nodiscard]] virtual Damage damage(std::uint64_t at, const std::string& what) const = 0;

 protected:
  explicit ByteSource(std::uint64_t size) : size_(size) {}

 private:
  virtual std::string_view bytes_within(std::uint64_t at, std::uint64_t count) = 0;

  std::uint64_t size_;
};

/// The bytes of a file up to a place, through a small window: for records that follow each other, most of which are
/// passed over.
class FileBytes final : public ByteSource {
 public:
  explicit FileBytes(const ReadableBytes& file, std::size_t window = kWindow) : FileBytes(file, file.size(), window) {}
  FileBytes(const ReadableBytes& file, std::uint64_t end, std::size_t window)
      : ByteSource(end), file_(file), window_(window) {}

  [[nodiscard]] Damage damage(std::uint64_t at, const std::string& what) const override;

  static constexpr std::size_t kWindow = std::size_t{1} << 16U;
  static constexpr std::size_t kOneRecord = std::size_t{1} << 10U;

 private:
  std::string_view bytes_within(std::uint64_t at, std::uint64_t count) override;

  const ReadableBytes& file_;
  std::size_t window_;
  std::uint64_t begin_ = 0;
  std::string held_;
};

/// The unpacked content of a chunk of a file.
class ChunkBytes final : public ByteSource {
 public:
  ChunkBytes(std::string_view content, const ReadableBytes& file, std::uint64_t chunk)
      : ByteSource(content.size()), content_(content), file_(file), chunk_(chunk) {}

  [[nodiscard]] Damage damage(std::uint64_t at, const std::string& what) const override;

 private:
  std::string_view bytes_within(std::uint64_t at, std::uint64_t count) override;

  std::string_view content_;
  const ReadableBytes& file_;
  std::uint64_t chunk_;
};

/// Takes numbers and texts, little-endian, from the front of some bytes of a source. Throws Damage at their end.
class ByteReader {
 public:
  /// `begin`: where in the source the bytes are.
  ByteReader(std::string_view bytes, const ByteSource& source, std::uint64_t begin)
      : bytes_(bytes), source_(source), begin_(begin) {}

  [[nodiscard]] bool is_done() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::uint64_t place() const { return begin_ + at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  template <class Number>
  Number number() {
    Number value{};
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }

  std::string_view take(std::uint64_t count);

  /// Bytes behind their number (four bytes).
  std::string_view text() { return take(number<std::uint32_t>()); }

  [[nodiscard]] Damage damage(const std::string& what) const { return source_.damage(place(), what); }

 private:
  std::string_view bytes_;
  const ByteSource& source_;
  std::uint64_t begin_;
  std::size_t at_ = 0;
};

}  // namespace dynamic_icp::bags
