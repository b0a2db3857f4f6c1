// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/machine.hpp"

#include <charconv>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::benchmark {
namespace {

/// What follows the separator in the first line that starts with `key`; empty without such a line.
std::string value_in(const char* path, std::string_view key, char separator) {
  std::string content;
  try {
    content = formats::read_whole_file(path);
  } catch (const DataError&) {
    return {};  // not every system has the file
  }
  std::string_view rest = content;
  while (const auto line = formats::take_line(rest)) {
    const std::size_t at = line->find(separator);
    if (line->starts_with(key) && at != std::string_view::npos) {
      const std::string_view value = line->substr(at + 1);
      const std::size_t first = value.find_first_not_of(" \t\"");
      const std::size_t last = value.find_last_not_of(" \t\"\r");
      return first == std::string_view::npos ? std::string() : std::string(value.substr(first, last - first + 1));
    }
  }
  return {};
}

std::optional<double> memory_mib(std::string_view key) {
  const std::string kib = value_in("/proc/meminfo", key, ':');
  long long value = 0;
  const auto parsed = std::from_chars(kib.data(), kib.data() + kib.size(), value);
  return parsed.ec == std::errc() ? std::optional(static_cast<double>(value) / 1024.0) : std::nullopt;
}

}  // namespace

std::string describe_processor() {
  utsname system{};
  ::uname(&system);
  const std::string name = value_in("/proc/cpuinfo", "model name", ':');
  return fmt::format("{} ({}), {} processors", name.empty() ? "unknown processor" : name, system.machine,
                     std::thread::hardware_concurrency());
}

std::string describe_machine() {
  utsname system{};
  ::uname(&system);
  const auto memory = memory_mib("MemTotal");
  const std::string distribution = value_in("/etc/os-release", "PRETTY_NAME", '=');
  return fmt::format("{}, {} memory, {}", describe_processor(),
                     memory ? fmt::format("{:.0f} GiB", *memory / 1024.0) : "unknown",
                     distribution.empty() ? system.sysname : distribution);
}

std::optional<double> available_memory_mib() { return memory_mib("MemAvailable"); }

}  // namespace dynamic_icp::benchmark
