// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::formats {
namespace {

[[noreturn]] void throw_error(const std::filesystem::path& path, const char* action) {
  throw DataError(fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(errno)));
}

/// Closes a descriptor when it goes out of scope.
struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor() { ::close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

void refuse_longer(const std::filesystem::path& path, std::uintmax_t bytes, std::uintmax_t max_bytes) {
  if (bytes > max_bytes) {
    throw DataError(fmt::format("{}: has {} bytes, expected at most {}", path.string(), bytes, max_bytes));
  }
}

/// What is left to be read. `expected` bytes are there in all likelihood: one more tells that the end has come, so that
/// a file that does not grow meanwhile is read without taking memory twice.
std::string read_to_end(int descriptor, const std::filesystem::path& path, std::uintmax_t expected,
                        std::uintmax_t max_bytes) {
  constexpr std::size_t kMinRoom = 4096;  // files of the system's own have no size
  std::string content(std::max<std::size_t>(kMinRoom, expected + 1), '\0');
  std::size_t used = 0;
  while (true) {
    if (used == content.size()) {
      content.resize(2 * used);
    }
    const ssize_t got = ::read(descriptor, content.data() + used, content.size() - used);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      throw_error(path, "read");
    }
    used += static_cast<std::size_t>(got);
    refuse_longer(path, used, max_bytes);
    if (got == 0) {
      content.resize(used);
      return content;
    }
  }
}

/// Fills the rest of a buffer; how much of it, less than all only at the end of the file.
std::size_t read_into(std::string& buffer, std::size_t used, int descriptor, const std::filesystem::path& path) {
  const std::size_t before = used;
  while (used < buffer.size()) {
    const ssize_t got = ::read(descriptor, buffer.data() + used, buffer.size() - used);
    if (got == 0) {
      break;
    }
    if (got < 0 && errno != EINTR) {
      throw_error(path, "read");
    }
    used += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  return used - before;
}

Descriptor open_to_read(const std::filesystem::path& path) {
  refuse_irregular(path);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    throw_error(path, "open");
  }
  return Descriptor(descriptor);
}

[[noreturn]] void refuse_zero_byte(const std::filesystem::path& path, std::size_t line) {
  throw DataError(fmt::format("{}: line {}: has a zero byte, expected text", path.string(), line));
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : OutputFile(path, path) {}

OutputFile::OutputFile(const std::filesystem::path& path, const std::filesystem::path& final_name)
    : OutputFile(path, final_name, O_CREAT | O_TRUNC) {}

OutputFile::OutputFile(const std::filesystem::path& path, const std::filesystem::path& final_name, int flags)
    : final_name_(final_name), descriptor_(::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666)) {
  if (descriptor_ < 0) {
    fail((flags & O_CREAT) != 0 ? "create" : "open");
  }
}

OutputFile OutputFile::resume(const std::filesystem::path& path, std::uintmax_t length) {
  OutputFile file(path, path, O_NOFOLLOW | O_NONBLOCK);  // a pipe that nobody reads would be waited for
  struct stat status = {};
  if (::fstat(file.descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw DataError(fmt::format("{}: is no regular file", path.string()));
  }
  const off_t there = ::lseek(file.descriptor_, 0, SEEK_END);
  if (there < 0) {
    file.fail("read");
  }
  if (static_cast<std::uintmax_t>(there) < length) {
    throw DataError(fmt::format("{}: has {} bytes, expected at least {}", path.string(), there, length));
  }
  const auto end = static_cast<off_t>(length);
  if (::ftruncate(file.descriptor_, end) != 0 || ::lseek(file.descriptor_, end, SEEK_SET) != end) {
    file.fail("write");
  }
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : final_name_(std::move(other.final_name_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void OutputFile::fail(const char* action) const { throw_error(final_name_, action); }

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      fail("write");
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::uintmax_t OutputFile::synchronise() {
  const off_t length = ::lseek(descriptor_, 0, SEEK_CUR);
  if (::fsync(descriptor_) != 0 || length < 0) {
    fail("write");
  }
  return static_cast<std::uintmax_t>(length);
}

void OutputFile::close() {
  const bool synchronised = ::fsync(descriptor_) == 0 || errno == EINVAL;  // EINVAL: a device that cannot, e.g. a pipe
  const bool closed = ::close(descriptor_) == 0;
  descriptor_ = -1;
  if (!synchronised || !closed) {
    fail("write");
  }
}

StagedFile::StagedFile(const std::filesystem::path& path) : path_(path) {
  std::error_code unreadable;
  if (std::filesystem::is_other(path, unreadable)) {
    file_.emplace(path);  // a device or pipe: a file in its place would take it from everybody
    return;
  }
  make_partial();
  try {
    unfinished_.emplace(partial_);
    file_.emplace(partial_, path);
  } catch (...) {
    remove_partial();  // without a destructor
    throw;
  }
}

void StagedFile::make_partial() {
  for (int number = 1; partial_.empty(); ++number) {
    std::filesystem::path partial = path_;
    partial += fmt::format(".partial-{}", number);
    const Descriptor made(::open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    const bool is_new = made.number >= 0;
    if (!is_new && errno != EEXIST) {
      throw_error(path_, "create");
    }
    lock_.emplace(partial);
    // Where there are no locks nobody knows whether an earlier one is still being written.
    if (lock_->held() ? lock_->is_of(partial) : is_new && !lock_->taken()) {
      partial_ = std::move(partial);
    }
  }
}

StagedFile::~StagedFile() {
  file_.reset();
  remove_partial();
}

void StagedFile::remove_partial() const {
  if (!partial_.empty()) {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
  }
}

void StagedFile::commit() {
  file_->close();
  if (partial_.empty()) {
    return;
  }
  std::error_code fault;
  std::filesystem::rename(partial_, path_, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot create: {}", path_.string(), fault.message()));
  }
  partial_.clear();
  unfinished_.reset();
  lock_.reset();
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  StagedFile file(path);
  file.write(content);
  file.commit();
}

std::string read_whole_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  const Descriptor file = open_to_read(path);
  std::error_code unknown_size;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown_size);
  const std::uintmax_t expected = unknown_size ? 0 : size;
  refuse_longer(path, expected, max_bytes);
  return with_memory_for(path, [&] { return read_to_end(file.number, path, expected, max_bytes); });
}

std::string read_text_file(const std::filesystem::path& path) {
  std::string text = read_whole_file(path, kMaxTextBytes);
  refuse_other_kind(path, text, FileKind::kUnknown);
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
    refuse_zero_byte(path, static_cast<std::size_t>(lines) + 1);
  }
  return text;
}

void for_each_text_line(const std::filesystem::path& path,
                        const std::function<void(std::string_view line, std::size_t number)>& use) {
  constexpr std::size_t kReadBytes = std::size_t{1} << 20U;
  const Descriptor file = open_to_read(path);
  std::string buffer;
  std::size_t used = 0;  // bytes of the buffer that were read and not used yet
  std::size_t number = 0;
  const auto use_line = [&](std::string_view line) {
    ++number;
    if (line.find('\0') != std::string_view::npos) {
      refuse_zero_byte(path, number);
    }
    use(line, number);
  };
  for (bool at_end = false; !at_end;) {
    refuse_longer(path, used, kMaxTextBytes);
    with_memory_for(path, [&] { buffer.resize(used + kReadBytes); });
    const std::size_t got = read_into(buffer, used, file.number, path);
    at_end = got < kReadBytes;
    std::string_view rest = std::string_view(buffer).substr(0, used + got);
    if (number == 0) {
      refuse_other_kind(path, rest, FileKind::kUnknown);
    }
    for (std::size_t end = rest.find('\n', used); end != std::string_view::npos; end = rest.find('\n')) {
      use_line(rest.substr(0, end));
      rest.remove_prefix(end + 1);
    }
    if (at_end && !rest.empty()) {
      use_line(rest);
    }
    const std::size_t begin = used + got - rest.size();
    used = rest.size();
    buffer.erase(0, begin);
  }
}

}  // namespace dynamic_icp::formats
