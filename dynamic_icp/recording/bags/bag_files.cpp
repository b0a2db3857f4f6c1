// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/bag_files.hpp"

#include <atomic>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/compression.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/unfinished.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/formats/yaml_node.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;
using formats::FileKind;

constexpr std::string_view kMetadata = "metadata.yaml";
constexpr const char* kMetadataKey = "rosbag2_bagfile_information";

/// A file that is removed with this object, or when the program is ended by a signal.
class TemporaryFile {
 public:
  TemporaryFile() : path_(new_name()), unfinished_(path_) { remove(); }
  ~TemporaryFile() { remove(); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  static fs::path new_name() {
    static std::atomic<unsigned> number = 0;
    return fs::temp_directory_path() / fmt::format(".dynamic-icp-bag-{}-{}", ::getpid(), ++number);
  }

  void remove() const {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }

  fs::path path_;
  formats::Unfinished unfinished_;
};

FileKind unpacked_kind(const fs::path& file) {
  const FileKind kind = formats::kind_of_file(file);
  return kind == FileKind::kZstd ? formats::kind_of(zstd_file_head(file, formats::kKindBytes)) : kind;
}

std::unique_ptr<FileBag> open_unpacked(const fs::path& file, FileKind kind, const fs::path& name) {
  switch (kind) {
    case FileKind::kRosBag:
      return open_ros1_bag(file, name);
    case FileKind::kMcap:
      return open_mcap(file, name);
    case FileKind::kSqlite:
      return open_sqlite_bag(file, name);
    case FileKind::kUnknown:
      throw DataError(fmt::format("{}: expected a ROS 1 bag, an MCAP file or a .db3 file of ROS 2", name.string()));
    default:
      throw DataError(fmt::format("{}: {}", name.string(), formats::sentence(kind)));
  }
}

/// Of metadata.yaml; empty where it is missing.
std::string text_of(const YAML::Node& node, const char* key) {
  const YAML::Node value = node[key];
  return value && value.IsScalar() ? value.Scalar() : std::string();
}

}  // namespace

std::string_view container_of(const fs::path& file) {
  switch (unpacked_kind(file)) {
    case FileKind::kRosBag:
    case FileKind::kOldRosBag:
      return "rosbag";
    case FileKind::kMcap:
      return "mcap";
    case FileKind::kSqlite:
      return "rosbag2";
    default:
      return {};
  }
}

bool has_bag_name(const fs::path& file) {
  fs::path name = file.filename();
  if (name.string().front() == '.') {
    return false;
  }
  if (const std::string last = name.extension().string(); last == ".zst" || last == ".zstd" || last == ".active") {
    name = name.stem();
  }
  const std::string extension = name.extension().string();
  return extension == ".bag" || extension == ".mcap" || extension == ".db3";
}

std::unique_ptr<FileBag> open_file(const fs::path& file) {
  if (const FileKind kind = formats::kind_of_file(file); kind != FileKind::kZstd) {
    return open_unpacked(file, kind, file);
  }
  const auto unpacked = std::make_shared<const TemporaryFile>();
  const std::string fault = unpack_zstd_file(file, unpacked->path());
  std::unique_ptr<FileBag> bag;
  try {
    bag = open_unpacked(unpacked->path(), formats::kind_of_file(unpacked->path()), file);
  } catch (const DataError&) {
    if (fault.empty()) {
      throw;
    }
    throw DataError(fmt::format("{}: {}", file.string(), fault));
  }
  bag->keep(unpacked);
  if (!fault.empty()) {
    bag->add_note(fmt::format("{}: {}; what comes before is read", file.string(), fault));
  }
  return bag;
}

bool has_metadata(const fs::path& folder) {
  std::error_code ignored;
  const fs::path path = folder / kMetadata;
  if (!fs::is_regular_file(path, ignored)) {
    return false;
  }
  try {
    return formats::read_text_file(path).find(kMetadataKey) != std::string::npos;
  } catch (const DataError&) {
    return false;
  }
}

Rosbag2Metadata read_metadata(const fs::path& folder) {
  const fs::path path = folder / kMetadata;
  const YAML::Node document = formats::parse_document(formats::read_text_file(path), path);
  const YAML::Node about = document && document.IsMap() ? document[kMetadataKey] : YAML::Node();
  const YAML::Node files = about && about.IsMap() ? about["relative_file_paths"] : YAML::Node();
  if (!files || !files.IsSequence() || files.size() == 0) {
    throw DataError(fmt::format("{}: expected '{}' with a list 'relative_file_paths'", path.string(), kMetadataKey));
  }
  Rosbag2Metadata metadata;
  for (const YAML::Node& file : files) {
    if (!file.IsScalar()) {
      throw DataError(fmt::format("{}: expected the name of a file, found {}",
                                  formats::place(path, formats::line_of(file)), formats::found(file)));
    }
    // Early versions of ROS 2 put the name of the folder in front.
    std::error_code ignored;
    const fs::path name = file.Scalar();
    const fs::path there = fs::is_regular_file(folder / name, ignored) ? folder / name : folder / name.filename();
    (fs::is_regular_file(there, ignored) ? metadata.files : metadata.missing).push_back(there);
  }
  const std::string mode = text_of(about, "compression_mode");
  metadata.packed_messages = mode == "MESSAGE" || mode == "message";
  const std::string format = text_of(about, "compression_format");
  if (metadata.packed_messages && format != "zstd") {
    throw DataError(fmt::format("{}: its messages are packed with '{}', expected zstd", path.string(), format));
  }
  if (metadata.files.empty()) {
    throw DataError(fmt::format("{}: none of its files is there; the first is {}", path.string(),
                                metadata.missing.front().filename().string()));
  }
  return metadata;
}

}  // namespace dynamic_icp::bags
