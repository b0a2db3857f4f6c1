// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <sqlite3.h>

#include "testing/bags_by_hand.hpp"

// For tests: databases with the tables of rosbag2.
namespace dynamic_icp::by_hand {

/// Opens or makes a database and executes statements.
inline void execute(const std::filesystem::path& path, const std::string& statements) {
  std::filesystem::create_directories(path.parent_path());
  sqlite3* database = nullptr;
  const bool done = sqlite3_open(path.c_str(), &database) == SQLITE_OK &&
                    sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  const std::string reason = sqlite3_errmsg(database);
  sqlite3_close(database);
  if (!done) {
    throw std::runtime_error(reason);
  }
}

/// `before`: statements that come first.
inline void write_db3(const std::filesystem::path& path, const std::vector<Channel>& channels,
                      const std::vector<Message>& messages, const std::string& before = "") {
  std::string statements =
      before +
      "PRAGMA synchronous = OFF; BEGIN;"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT "
      "NULL,offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB "
      "NOT NULL);"
      "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
  for (const Channel& channel : channels) {
    statements += "INSERT INTO topics VALUES (" + std::to_string(channel.id) + ",'" + channel.topic + "','" +
                  channel.type + "','" + channel.encoding + "','');";
  }
  for (const Message& message : messages) {
    std::string hex;
    for (const char byte : message.data) {
      constexpr const char* kDigits = "0123456789abcdef";
      hex += kDigits[static_cast<unsigned char>(byte) >> 4U];
      hex += kDigits[static_cast<unsigned char>(byte) & 15U];
    }
    statements += "INSERT INTO messages (topic_id, timestamp, data) VALUES (" + std::to_string(message.channel) + "," +
                  std::to_string(message.time_ns) + ",x'" + hex + "');";
  }
  execute(path, statements + "COMMIT;");
}

}  // namespace dynamic_icp::by_hand
