// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/reference_work.hpp"

#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

#include "benchmarks/sequence/child_text.hpp"

namespace dynamic_icp::speed {

ReferenceWork::ReferenceWork(std::filesystem::path program, const std::filesystem::path& recording)
    : program_(std::move(program)),
      file_(std::filesystem::temp_directory_path() / fmt::format("dynamic_icp_reference-{}.bin", ::getpid())) {
  const auto dataset = datasets::open_dataset(recording);
  scan_ = dataset->size() / 2;
  const RawScan scan = dataset->scan(scan_);
  points_ = scan.points.size();
  formats::write_xyzd(file_, scan);
}

ReferenceWork::~ReferenceWork() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

double ReferenceWork::run() const { return parse_milliseconds(output_of_program(program_, file_.string()), program_); }

double parse_milliseconds(std::string_view printed, const std::filesystem::path& program) {
  const std::size_t begin = printed.find_first_not_of(" \t\n");
  const std::size_t end = printed.find_last_not_of(" \t\n\r");
  const std::string_view word =
      begin == std::string_view::npos ? std::string_view() : printed.substr(begin, end - begin + 1);
  double ms = 0.0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), ms);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || !std::isfinite(ms) || !(ms > 0.0)) {
    throw DataError(fmt::format("{}: printed '{}', expected its time in milliseconds", program.string(), word));
  }
  return ms;
}

}  // namespace dynamic_icp::speed
