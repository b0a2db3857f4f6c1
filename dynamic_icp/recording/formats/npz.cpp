// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npz.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zip.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::string_view kExtension = ".npy";
constexpr std::size_t kChunkBytes = std::size_t{1} << 16U;

// 1980-01-01 00:00, the first day zip archives know.
constexpr std::uint16_t kDosDate = (1U << 5U) | 1U;

std::string member_name(std::string_view name) { return std::string(name) + std::string(kExtension); }

std::string text_of(zip_error_t* error) {
  std::string text = zip_error_strerror(error);
  zip_error_fini(error);
  return text;
}

std::string text_of(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  return text_of(&error);
}

/// Says what a file is that is no archive.
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  std::array<char, kKindBytes> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  refuse_other_kind(path, std::string_view(head.data(), static_cast<std::size_t>(file.gcount())), FileKind::kZip);
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  if (!unknown && bytes == 0) {
    throw DataError(fmt::format("{}: empty file, expected a zip archive of arrays", path.string()));
  }
  if (kind_of(std::string_view(head.data(), head.size())) == FileKind::kZip) {
    throw DataError(fmt::format("{}: a zip archive without an end: cut short at byte {}, or damaged ({})",
                                path.string(), bytes, reason));
  }
  throw DataError(fmt::format("{}: expected a zip archive of arrays: {}", path.string(), reason));
}

struct FileCloser {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

/// Puts an archive together in memory.
class ArchiveBuilder {
 public:
  ArchiveBuilder() : source_(zip_source_buffer_create(nullptr, 0, 0, nullptr)) {
    archive_ = source_ == nullptr ? nullptr : zip_open_from_source(source_, ZIP_TRUNCATE, nullptr);
    if (archive_ == nullptr) {
      zip_source_free(source_);
      throw std::bad_alloc();
    }
    zip_source_keep(source_);  // closing the archive gives its own share of it up
  }
  ~ArchiveBuilder() {
    if (archive_ != nullptr) {
      zip_discard(archive_);
    }
    zip_source_free(source_);
  }
  ArchiveBuilder(const ArchiveBuilder&) = delete;
  ArchiveBuilder& operator=(const ArchiveBuilder&) = delete;

  /// The content must live until finish().
  void add(const std::string& name, const std::string& content) {
    zip_source_t* const member = zip_source_buffer(archive_, content.data(), content.size(), 0);
    const zip_int64_t index = member == nullptr ? -1 : zip_file_add(archive_, name.c_str(), member, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(member);
      fail(name);
    }
    const auto place = static_cast<zip_uint64_t>(index);
    if (zip_set_file_compression(archive_, place, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_dostime(archive_, place, 0, kDosDate, 0) != 0) {
      fail(name);
    }
  }

  std::string finish() {
    if (zip_close(archive_) != 0) {
      throw std::bad_alloc();  // it lies in memory: nothing else can be wrong
    }
    archive_ = nullptr;
    zip_stat_t status;
    zip_stat_init(&status);
    if (zip_source_stat(source_, &status) != 0 || zip_source_open(source_) != 0) {
      throw std::bad_alloc();
    }
    std::string content(status.size, '\0');
    const bool whole =
        zip_source_read(source_, content.data(), content.size()) == static_cast<zip_int64_t>(status.size);
    zip_source_close(source_);
    if (!whole) {
      throw std::bad_alloc();
    }
    return content;
  }

 private:
  [[noreturn]] void fail(const std::string& name) const {
    if (zip_error_code_zip(zip_get_error(archive_)) == ZIP_ER_MEMORY) {
      throw std::bad_alloc();
    }
    throw std::invalid_argument(fmt::format("{}: {}", name, zip_strerror(archive_)));
  }

  zip_source_t* source_;
  zip_t* archive_ = nullptr;
};

}  // namespace

class NpzFile::Archive {
 public:
  explicit Archive(const std::filesystem::path& path) {
    refuse_irregular(path);
    int code = 0;
    handle_ = zip_open(path.c_str(), ZIP_RDONLY, &code);
    if (handle_ == nullptr) {
      refuse(path, text_of(code));
    }
  }
  ~Archive() { zip_discard(handle_); }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  [[nodiscard]] zip_t* handle() const { return handle_; }
  [[nodiscard]] zip_uint64_t entries() const {
    return static_cast<zip_uint64_t>(std::max<zip_int64_t>(0, zip_get_num_entries(handle_, 0)));
  }

 private:
  zip_t* handle_ = nullptr;
};

NpzFile::NpzFile(const std::filesystem::path& path) : path_(path), archive_(std::make_unique<Archive>(path)) {
  refuse_bomb();
}

NpzFile::~NpzFile() = default;

void NpzFile::refuse_bomb() const {
  std::uint64_t room = kMaxNpzBytes;
  for (zip_uint64_t i = 0; i < archive_->entries(); ++i) {
    zip_stat_t status;
    zip_stat_init(&status);
    if (zip_stat_index(archive_->handle(), i, 0, &status) != 0 || (status.valid & ZIP_STAT_SIZE) == 0 ||
        status.size > kMaxNpzMemberBytes) {
      continue;  // will not be unpacked
    }
    if (status.size > room) {
      throw DataError(fmt::format("{}: its arrays claim more than {} bytes together: no scan is that large",
                                  path_.string(), kMaxNpzBytes));
    }
    room -= status.size;
  }
}

std::vector<std::string> NpzFile::names() const {
  std::vector<std::string> names;
  for (zip_uint64_t i = 0; i < archive_->entries(); ++i) {
    const char* const entry = zip_get_name(archive_->handle(), i, 0);
    const std::string_view name = entry == nullptr ? "" : entry;
    if (name.size() > kExtension.size() && name.ends_with(kExtension)) {
      names.emplace_back(name.substr(0, name.size() - kExtension.size()));
    }
  }
  return names;
}

bool NpzFile::contains(std::string_view name) const {
  return zip_name_locate(archive_->handle(), member_name(name).c_str(), 0) >= 0;
}

std::string NpzFile::why_no_numbers(std::string_view name) const {
  const std::unique_ptr<zip_file_t, FileCloser> file(zip_fopen(archive_->handle(), member_name(name).c_str(), 0));
  std::array<char, kChunkBytes> chunk;
  const zip_int64_t got = file ? zip_fread(file.get(), chunk.data(), chunk.size()) : 0;
  try {
    parse_npy_header(std::string_view(chunk.data(), static_cast<std::size_t>(std::max<zip_int64_t>(got, 0))),
                     fmt::format("array '{}'", name));
    return "";
  } catch (const DataError& error) {
    return error.what();
  }
}

NpyArray NpzFile::read(std::string_view name) const {
  NpyArray array = with_memory_for(path_, [&] { return unpacked(name); });
  const std::size_t rows = array.shape.empty() ? 1 : array.shape.front();
  if (rows > kMaxNpzRows) {
    throw DataError(fmt::format("{}: has {} rows, expected at most {}", array.origin, rows, kMaxNpzRows));
  }
  return array;
}

NpyArray NpzFile::unpacked(std::string_view name) const {
  const std::string origin = fmt::format("{}: array '{}'", path_.string(), name);
  const zip_int64_t index = zip_name_locate(archive_->handle(), member_name(name).c_str(), 0);
  zip_stat_t status;
  zip_stat_init(&status);
  if (index < 0 || zip_stat_index(archive_->handle(), static_cast<zip_uint64_t>(index), 0, &status) != 0) {
    throw DataError(fmt::format("{}: is missing, expected it among: {}", origin, fmt::join(names(), " ")));
  }
  if ((status.valid & ZIP_STAT_SIZE) == 0 || status.size > kMaxNpzMemberBytes) {
    throw DataError(fmt::format("{}: claims {} bytes, expected at most {}", origin, status.size, kMaxNpzMemberBytes));
  }
  const std::unique_ptr<zip_file_t, FileCloser> file(
      zip_fopen_index(archive_->handle(), static_cast<zip_uint64_t>(index), 0));
  if (!file) {
    throw DataError(fmt::format("{}: cannot be unpacked: {}", origin, zip_strerror(archive_->handle())));
  }
  // The claimed size is only believed as far as there are bytes for it.
  std::string content;
  std::array<char, kChunkBytes> chunk;
  zip_int64_t got = 0;
  while (content.size() <= status.size && (got = zip_fread(file.get(), chunk.data(), chunk.size())) > 0) {
    content.append(chunk.data(), static_cast<std::size_t>(got));
  }
  if (got < 0) {
    throw DataError(fmt::format("{}: is damaged: {}", origin, zip_file_strerror(file.get())));
  }
  if (content.size() != status.size) {
    throw DataError(
        fmt::format("{}: is damaged: unpacks to {} bytes, expected {}", origin, content.size(), status.size));
  }
  return parse_npy(content, origin);
}

std::string npz_bytes(std::span<const NpzMember> members) {
  if (members.empty()) {
    throw std::invalid_argument("an NPZ archive needs at least one array");
  }
  std::vector<std::string> contents;
  contents.reserve(members.size());
  ArchiveBuilder builder;
  for (const NpzMember& member : members) {
    if (member.name.empty()) {
      throw std::invalid_argument("an array in an NPZ archive needs a name");
    }
    contents.push_back(npy_bytes(member.array));
    builder.add(member_name(member.name), contents.back());
  }
  return builder.finish();
}

void write_npz(const std::filesystem::path& path, std::span<const NpzMember> members) {
  write_whole_file(path, npz_bytes(members));
}

}  // namespace dynamic_icp::formats
