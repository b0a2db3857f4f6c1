// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/mcap_recorder.hpp"

#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/messages/foxglove_schemas.hpp"

namespace dynamic_icp::runs {
namespace {

bags::McapSettings recorder_settings() {
  bags::McapSettings settings;
  settings.library = fmt::format("dynamic-icp {}", version());
  return settings;
}

}  // namespace

McapRecorder::McapRecorder(const std::filesystem::path& file, const formats::Trajectory& truth,
                           RunMessagesSettings settings)
    : file_(file),
      writer_([this](std::string_view bytes) { file_.write(bytes); }, recorder_settings()),
      messages_({.write =
                     [this](RunTopic topic, Stamp stamp, const std::string& bytes) {
                       writer_.write(channels_[static_cast<std::size_t>(topic)], stamp, bytes);
                     },
                 .wants_points = {}},
                truth, std::move(settings)) {
  std::map<std::string, std::uint16_t> schemas;
  for (const RunTopicRow& row : run_topics()) {
    if (row.topic == RunTopic::kTruthPath && truth.empty()) {
      continue;
    }
    const auto [schema, is_new] = schemas.try_emplace(row.type);
    if (is_new) {
      schema->second = writer_.add_schema({row.type, "protobuf", messages::protobuf_schema(row.type)});
    }
    channels_.push_back(writer_.add_channel({schema->second, row.name, "protobuf", {}}));
  }
  writer_.add_metadata("dynamic_icp.run", {{"version", std::string(version())}});
}

void McapRecorder::commit() {
  writer_.finish();
  file_.commit();
}

}  // namespace dynamic_icp::runs
