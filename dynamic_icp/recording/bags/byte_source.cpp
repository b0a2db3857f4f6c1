// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/byte_source.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::bags {
namespace {

DataError cannot_read(const std::filesystem::path& path) {
  return DataError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
}

}  // namespace

Damage::Damage(const std::filesystem::path& file, std::uint64_t byte, const std::string& what)
    : DataError(fmt::format("{}: byte {}: {}", file.string(), byte, what)), byte_(byte), what_(what) {}

ReadableFile::ReadableFile(const std::filesystem::path& path, const std::filesystem::path& name)
    : ReadableBytes(name.empty() ? path : name) {
  formats::refuse_irregular(path);
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw cannot_read(this->path());
  }
  try {
    static_cast<void>(look_again());
  } catch (const DataError&) {
    ::close(descriptor_);
    throw;
  }
}

struct ::stat ReadableFile::look_again() {
  struct ::stat status {};
  if (::fstat(descriptor_, &status) != 0) {
    throw cannot_read(path());
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
  return status;
}

ReadableFile::~ReadableFile() { ::close(descriptor_); }

std::string ReadableFile::read(std::uint64_t at, std::uint64_t bytes) const {
  const auto ends = [&](std::uint64_t end) {
    return Damage(path(), at, fmt::format("the file ends at byte {}, expected {} more bytes", end, bytes));
  };
  const std::uint64_t size = size_;
  if (at > size || bytes > size - at) {
    throw ends(size);
  }
  std::string content = formats::with_memory_for(path(), [&] { return std::string(bytes, '\0'); });
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t got =
        ::pread(descriptor_, content.data() + done, content.size() - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      throw DataError(fmt::format("{}: cannot read at byte {}: {}", path().string(), at + done, std::strerror(errno)));
    }
    if (got == 0) {  // the file became shorter
      throw ends(at + done);
    }
    done += static_cast<std::size_t>(got);
  }
  return content;
}

std::string_view ByteSource::bytes(std::uint64_t at, std::uint64_t count) {
  if (at > size_ || count > size_ - at) {
    throw damage(at, fmt::format("ends {} bytes on, expected {}", at > size_ ? 0 : size_ - at, count));
  }
  return bytes_within(at, count);
}

Damage FileBytes::damage(std::uint64_t at, const std::string& what) const { return {file_.path(), at, what}; }

std::string_view FileBytes::bytes_within(std::uint64_t at, std::uint64_t count) {
  if (at < begin_ || at + count > begin_ + held_.size()) {
    held_ = file_.read(at, std::min(std::max<std::uint64_t>(count, window_), size() - at));
    begin_ = at;
  }
  return std::string_view(held_).substr(at - begin_, count);
}

Damage ChunkBytes::damage(std::uint64_t at, const std::string& what) const {
  return {file_.path(), chunk_, fmt::format("chunk, byte {} of its content: {}", at, what)};
}

std::string_view ChunkBytes::bytes_within(std::uint64_t at, std::uint64_t count) { return content_.substr(at, count); }

std::string_view ByteReader::take(std::uint64_t count) {
  if (count > left()) {
    throw damage(fmt::format("{} bytes left, expected {}", left(), count));
  }
  at_ += count;
  return bytes_.substr(at_ - count, count);
}

}  // namespace dynamic_icp::bags
