// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/benchmark/sequences.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kSmallFile = 64 * 1024;

/// FNV-1a, 64 bits.
class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) {
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:016x}", state_); }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// `count` bytes from `offset`, or as many as there are.
std::string read_part(const fs::path& path, std::uintmax_t offset, std::uintmax_t count) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(count, '\0');
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

/// All files in a folder and below that are not hidden, sorted.
std::vector<fs::path> files_below(const fs::path& folder, const fs::path& except) {
  std::vector<fs::path> files;
  std::error_code fault;
  auto entry = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, fault);
  for (; !fault && entry != fs::recursive_directory_iterator(); entry.increment(fault)) {
    const bool hidden = entry->path().filename().string().starts_with(".");
    std::error_code ignored;
    if (entry->is_directory(ignored) && (hidden || entry->path() == except)) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file(ignored) && !hidden) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void add_file(Checksum& checksum, const fs::path& path, bool whole) {
  const std::uintmax_t size = fs::file_size(path);
  checksum.add(fmt::format("{} bytes\n", size));
  if (size <= kSmallFile) {
    checksum.add(read_part(path, 0, size));
  } else if (whole) {
    checksum.add(read_part(path, 0, kSmallFile));
    checksum.add(read_part(path, size - kSmallFile, kSmallFile));
  }
}

fs::path normalised(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

fs::path object_truth_of(const fs::path& path, const datasets::Dataset& dataset) {
  for (const fs::path& folder : {dataset.ground_truth_file().parent_path(), path}) {
    std::error_code ignored;
    if (!folder.empty() && fs::is_regular_file(folder / "objects.jsonl", ignored)) {
      return folder / "objects.jsonl";
    }
  }
  return {};
}

std::vector<fs::path> visible_folders(const fs::path& path) {
  std::vector<fs::path> folders;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, fault)) {
    if (entry.is_directory(fault) && !entry.path().filename().string().starts_with(".")) {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void append_input(Sequences& into, const fs::path& path, const datasets::InputSettings& settings,
                  const fs::path& output) {
  try {
    into.sequences.push_back(open_sequence(path, settings, output));
    return;
  } catch (const DataError&) {
    const std::size_t before = into.sequences.size();
    std::vector<std::string> skipped;
    for (const fs::path& folder : visible_folders(path)) {
      try {
        if (folder != output) {
          into.sequences.push_back(open_sequence(folder, settings, output));
        }
      } catch (const DataError& error) {
        skipped.emplace_back(error.what());
      }
    }
    if (into.sequences.size() == before) {
      throw;
    }
    into.skipped.insert(into.skipped.end(), skipped.begin(), skipped.end());
  }
}

std::string name_of(const fs::path& path) {
  const bool scans_themselves = path.filename() == "point_clouds" && path.has_parent_path();
  return (scans_themselves ? path.parent_path() : path).filename().string();
}

void label_sequences(std::vector<Sequence>& sequences) {
  // The names of what else lies in the folder of a benchmark.
  std::set<std::string> taken = {"", "tables", "tables.md", "results.json", "benchmark.lock"};
  std::multiset<std::string> names;
  for (const Sequence& sequence : sequences) {
    names.insert(name_of(sequence.path));
  }
  for (Sequence& sequence : sequences) {
    const std::string name = name_of(sequence.path);
    const std::string parent = sequence.path.parent_path().filename().string();
    const std::string wanted = names.count(name) > 1 && !parent.empty() ? parent + "_" + name : name;
    sequence.label = wanted;
    for (int number = 2; !taken.insert(sequence.label).second; ++number) {
      sequence.label = fmt::format("{}_{}", wanted, number);
    }
  }
}

}  // namespace

Sequence open_sequence(const fs::path& path, const datasets::InputSettings& settings, const fs::path& output) {
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(path, settings);
  if (dataset->size() == 0) {
    throw DataError(fmt::format("{}: holds no scans", path.string()));
  }
  Sequence sequence;
  sequence.path = path;
  sequence.scans = dataset->size();
  sequence.first_stamp = dataset->stamp(0);
  sequence.last_stamp = dataset->stamp(dataset->size() - 1);
  sequence.content = content_checksum(path, output);
  sequence.object_truth = object_truth_of(path, *dataset);
  return sequence;
}

Sequences open_sequences(const std::vector<std::string>& inputs, const datasets::InputSettings& settings,
                         const fs::path& output) {
  Sequences opened;
  for (const std::string& input : inputs) {
    append_input(opened, normalised(input), settings, normalised(output));
  }
  std::set<fs::path> seen;
  for (const Sequence& sequence : opened.sequences) {
    if (!seen.insert(fs::weakly_canonical(sequence.path)).second) {
      throw UsageError(fmt::format("{}: given twice", sequence.path.string()));
    }
  }
  label_sequences(opened.sequences);
  return opened;
}

std::string content_checksum(const fs::path& path, const fs::path& except) {
  Checksum checksum;
  if (!fs::is_directory(path)) {
    add_file(checksum, path, true);
    return checksum.text();
  }
  const std::vector<fs::path> files = files_below(path, except);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path folder = files[i].parent_path();
    const bool first = i == 0 || files[i - 1].parent_path() != folder;
    const bool last = i + 1 == files.size() || files[i + 1].parent_path() != folder;
    checksum.add(files[i].lexically_relative(path).string() + "\n");
    add_file(checksum, files[i], first || last);
  }
  return checksum.text();
}

std::string file_checksum(const fs::path& path) {
  Checksum checksum;
  checksum.add(formats::read_whole_file(path));
  return checksum.text();
}

}  // namespace dynamic_icp::benchmark
