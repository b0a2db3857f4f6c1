// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <limits>
#include <map>
#include <mutex>
#include <span>

#include <fmt/format.h>
#include <sqlite3.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"
#include "dynamic_icp/recording/bags/file_bag.hpp"

namespace dynamic_icp::bags {
namespace {

/// One pass over the rows of a query.
class SqliteQuery {
 public:
  SqliteQuery(sqlite3* database, const std::filesystem::path& path, std::string_view text)
      : database_(database), path_(path) {
    if (sqlite3_prepare_v2(database, text.data(), static_cast<int>(text.size()), &statement_, nullptr) != SQLITE_OK) {
      throw error();
    }
  }
  ~SqliteQuery() { sqlite3_finalize(statement_); }
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;

  void bind(int place, std::int64_t value) { sqlite3_bind_int64(statement_, place, value); }

  /// Whether there is one more row.
  bool next() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) {
      throw error();
    }
    return code == SQLITE_ROW;
  }

  [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

  [[nodiscard]] std::string bytes(int column) const {
    const void* const data = sqlite3_column_blob(statement_, column);  // before the size, says the manual
    const int size = sqlite3_column_bytes(statement_, column);
    if (data == nullptr) {
      if (sqlite3_errcode(database_) == SQLITE_NOMEM) {
        throw error();
      }
      return {};
    }
    return {static_cast<const char*>(data), static_cast<std::size_t>(size)};
  }

 private:
  [[nodiscard]] DataError error() const {
    return DataError(fmt::format("{}: damaged, or no bag of ROS 2: {}", path_.string(), sqlite3_errmsg(database_)));
  }

  sqlite3* database_;
  const std::filesystem::path& path_;
  sqlite3_stmt* statement_ = nullptr;
};

/// A path as SQLite takes it where it is to be opened in a certain way.
std::string sqlite_uri(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' ||
                          c == '.' || c == '-' || c == '_';
    uri += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?mode=ro&immutable=1";
}

/// Throws Damage where the file is shorter than its header says: SQLite takes zeros for what is missing of a page.
void check_size(const ReadableFile& file) {
  constexpr std::uint64_t kHeaderBytes = 100;  // sqlite.org/fileformat2.html, all numbers big-endian
  const std::string header = file.read(0, kHeaderBytes);
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < bytes; ++k) {
      value = value << 8U | static_cast<unsigned char>(header[at + k]);
    }
    return value;
  };
  const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2);
  const std::uint64_t pages = number(28, 4);
  const bool is_valid = pages > 0 && number(24, 4) == number(92, 4);  // old versions do not keep it up
  if (is_valid && file.size() < page * pages) {
    throw Damage(file.path(), file.size(), fmt::format("cut short: expected {} bytes", page * pages));
  }
}

class SqliteBag final : public FileBag {
 public:
  SqliteBag(const std::filesystem::path& path, const std::filesystem::path& name) : FileBag("rosbag2", name) {
    check_size(ReadableFile(path, name));
    open(path);
    try {
      note_journals();
      read_topics();
      read_span();
    } catch (...) {
      sqlite3_close(database_);
      throw;
    }
  }
  ~SqliteBag() override { sqlite3_close(database_); }
  SqliteBag(const SqliteBag&) = delete;
  SqliteBag& operator=(const SqliteBag&) = delete;

  [[nodiscard]] std::optional<TimeSpan> span() const override { return span_; }

  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    const std::vector<bool> is_wanted = chosen(wanted, topics_.size());
    std::vector<MessageEntry> entries;
    const std::lock_guard lock(mutex_);
    SqliteQuery rows(database_, path(), "SELECT id, topic_id, timestamp FROM messages");
    while (rows.next()) {
      const auto topic = topic_of_.find(static_cast<std::uint64_t>(rows.number(1)));
      if (topic != topic_of_.end() && is_wanted[topic->second]) {
        entries.push_back({rows.number(2), static_cast<std::uint64_t>(rows.number(0)), 0, topic->second, 0});
      }
    }
    sort_by_time(entries);
    return entries;
  }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override {
    return read_by("SELECT data FROM messages WHERE id = ?", entry);
  }

  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    return read_by(fmt::format("SELECT substr(data, 1, {}) FROM messages WHERE id = ?", bytes), entry);
  }

 private:
  [[nodiscard]] std::string read_by(std::string_view query, const MessageEntry& entry) const {
    const std::lock_guard lock(mutex_);
    SqliteQuery row(database_, path(), query);
    row.bind(1, static_cast<std::int64_t>(entry.place));
    if (!row.next()) {
      throw DataError(
          fmt::format("{}: message {} of {} is missing", path().string(), entry.place, topics_[entry.topic].name));
    }
    return row.bytes(0);
  }

  void open(const std::filesystem::path& file) {
    const int code = sqlite3_open_v2(sqlite_uri(file).c_str(), &database_,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
    if (code != SQLITE_OK) {
      const std::string reason = database_ != nullptr ? sqlite3_errmsg(database_) : sqlite3_errstr(code);
      sqlite3_close(database_);
      throw DataError(fmt::format("{}: cannot be opened as a database: {}", path().string(), reason));
    }
    // The file may come from anywhere: nothing in its schema is run.
    sqlite3_db_config(database_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_limit(database_, SQLITE_LIMIT_LENGTH,
                  static_cast<int>(std::min<std::uint64_t>(kMaxPieceBytes, std::numeric_limits<int>::max())));
    sqlite3_exec(database_, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
  }

  /// What a recorder that was killed leaves beside the file. It is not written back: the file stays as it is.
  void note_journals() {
    for (const char* const ending : {"-wal", "-journal"}) {
      std::error_code missing;
      const std::filesystem::path journal = path().string() + ending;
      if (const std::uintmax_t size = std::filesystem::file_size(journal, missing); !missing && size > 0) {
        notes_.push_back(
            fmt::format("{}: the recording was not closed: what stands only in {} is not read; 'sqlite3 {} \"PRAGMA "
                        "wal_checkpoint\"' brings it in",
                        path().string(), journal.filename().string(), path().filename().string()));
      }
    }
  }

  bool has_column(std::string_view table, std::string_view column) {
    SqliteQuery columns(database_, path(), fmt::format("PRAGMA table_info({})", table));
    while (columns.next()) {
      if (columns.bytes(1) == column) {
        return true;
      }
    }
    return false;
  }

  void read_topics() {
    for (const auto& [table, column] :
         {std::pair("topics", "id"), std::pair("topics", "name"), std::pair("topics", "type"),
          std::pair("topics", "serialization_format"), std::pair("messages", "id"), std::pair("messages", "topic_id"),
          std::pair("messages", "timestamp"), std::pair("messages", "data")}) {
      if (!has_column(table, column)) {
        throw DataError(fmt::format("{}: is a database but no bag of ROS 2: there is no column '{}' in a table '{}'",
                                    path().string(), column, table));
      }
    }
    std::map<std::string, std::string> definitions;  // by the name of the type, since ROS 2 Iron
    if (has_column("message_definitions", "encoded_message_definition") &&
        has_column("message_definitions", "topic_type")) {
      SqliteQuery rows(database_, path(), "SELECT topic_type, encoded_message_definition FROM message_definitions");
      while (rows.next()) {
        definitions[rows.bytes(0)] = rows.bytes(1);
      }
    }
    std::map<std::uint64_t, Topic> channels;
    SqliteQuery rows(database_, path(), "SELECT id, name, type, serialization_format FROM topics");
    while (rows.next()) {
      Topic topic;
      topic.name = rows.bytes(1);
      const std::string type = rows.bytes(2);
      topic.type = plain_type(type);
      topic.encoding_name = rows.bytes(3);
      topic.encoding = topic.encoding_name == "cdr" ? Encoding::kCdr : Encoding::kUnknown;
      topic.schema = definitions[type];
      channels[static_cast<std::uint64_t>(rows.number(0))] = std::move(topic);
    }
    SqliteQuery counts(database_, path(), "SELECT topic_id, count(*) FROM messages GROUP BY topic_id");
    std::uint64_t strays = 0;
    while (counts.next()) {
      const auto channel = channels.find(static_cast<std::uint64_t>(counts.number(0)));
      (channel != channels.end() ? channel->second.messages : strays) += static_cast<std::uint64_t>(counts.number(1));
    }
    if (strays > 0) {
      notes_.push_back(
          fmt::format("{}: {} messages of topics that do not exist are left out", path().string(), strays));
    }
    TopicTable table = table_of(channels);
    topics_ = std::move(table.topics);
    topic_of_ = std::move(table.topic_of);
  }

  void read_span() {
    SqliteQuery row(database_, path(), "SELECT min(timestamp), max(timestamp) FROM messages");
    if (row.next() && !row.is_null(0)) {
      span_ = TimeSpan{row.number(0), row.number(1)};
    }
  }

  sqlite3* database_ = nullptr;
  mutable std::mutex mutex_;  // a connection is used by one thread at a time
  std::map<std::uint64_t, std::uint32_t> topic_of_;
  std::optional<TimeSpan> span_;
};

}  // namespace

std::unique_ptr<FileBag> open_sqlite_bag(const std::filesystem::path& path, const std::filesystem::path& name) {
  return std::make_unique<SqliteBag>(path, name);
}

}  // namespace dynamic_icp::bags
