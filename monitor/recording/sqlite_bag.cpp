// One SQL statement reads all messages, a row at a time.
#include "monitor/recording/sqlite_bag.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include "config/text/file_bytes.hpp"
#include "config/text/sentences.hpp"
#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

// Limits what a hostile file can make the library do: a message or a statement has at most 1 GiB.
// The library's memory is at most twice that.
constexpr int kLargestValue = 1 << 30;

// Converts a path to a URI; everything but letters, digits and / is escaped. The URI marks the file
// as immutable, because otherwise SQLite makes files beside it, which fails in a read-only folder.
// A file with a write-ahead log is not marked: SQLite reads the messages that a crashed recorder
// left there only without the mark.
std::string uri_of(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char character : std::filesystem::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(character);
    const bool plain = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') ||
                       (byte >= '0' && byte <= '9') || byte == '/';
    uri += plain ? std::string(1, character) : fmt::format("%{:02X}", byte);
  }
  std::error_code none;
  const bool has_log = std::filesystem::exists(path.string() + "-wal", none);
  return uri + (has_log ? "?mode=ro" : "?mode=ro&immutable=1");
}

std::string text_of(sqlite3_stmt* row, int column) {
  const unsigned char* const text = sqlite3_column_text(row, column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace

void SqliteBag::Close::operator()(sqlite3* file) const { sqlite3_close(file); }
void SqliteBag::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteBag::SqliteBag(const std::filesystem::path& file) : path_(file) {
  if (open_file(file) == nullptr) {
    error_ = cannot_read(file);
    return;
  }
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(uri_of(file).c_str(), &opened,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  file_.reset(opened);
  if (status != SQLITE_OK) {
    static_cast<void>(fail());
    return;
  }
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kLargestValue);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (has_tables()) read_topics();
}

// Requires real tables, because a view may compute forever.
bool SqliteBag::has_tables() {
  const Statement tables = prepare(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages') "
      "AND sql LIKE 'CREATE TABLE%'");
  if (!error_.empty()) return false;
  if (sqlite3_step(tables.get()) != SQLITE_ROW) return fail();
  if (sqlite3_column_int(tables.get(), 0) == 2) return true;
  error_ = fmt::format(
      "{} is an SQLite file, but no bag: it lacks the tables 'topics' and 'messages' of rosbag2",
      path_.string());
  return false;
}

bool SqliteBag::fail() {
  error_ = fmt::format("{} cannot be read as a rosbag2 file (SQLite 3): {}", path_.string(),
                       file_ ? sqlite3_errmsg(file_.get()) : "no memory");
  if (read_ > 0) error_ += fmt::format(". Before that came {}", counted(read_, "message"));
  messages_.reset();
  return false;
}

SqliteBag::Statement SqliteBag::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(file_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    static_cast<void>(fail());
  }
  return Statement(statement);
}

void SqliteBag::read_topics() {
  const Statement topics = prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!error_.empty()) return;
  int status = SQLITE_OK;
  while ((status = sqlite3_step(topics.get())) == SQLITE_ROW) {
    topics_[sqlite3_column_int64(topics.get(), 0)] = {
        text_of(topics.get(), 1), text_of(topics.get(), 2), text_of(topics.get(), 3)};
  }
  if (status != SQLITE_DONE) {
    static_cast<void>(fail());
    return;
  }
  count_messages();
  if (!error_.empty()) return;
  messages_ = prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  readable_ = error_.empty();
}

// Uses the largest id, because counting all messages would read the whole file.
void SqliteBag::count_messages() {
  const Statement last = prepare("SELECT max(id) FROM messages");
  if (error_.empty() && sqlite3_step(last.get()) == SQLITE_ROW) {
    count_ = sqlite3_column_int64(last.get(), 0);
  }
}

double SqliteBag::progress() const noexcept {
  return messages_ == nullptr || count_ <= 0 || read_ >= count_
             ? 1.0
             : static_cast<double>(read_) / static_cast<double>(count_);
}

// A message without a topic is damage, since rosbag2 never writes one.
bool SqliteBag::next(BagMessage& message) {
  if (messages_ == nullptr) return false;
  const int status = sqlite3_step(messages_.get());
  if (status == SQLITE_DONE) {
    messages_.reset();
    return false;
  }
  if (status != SQLITE_ROW) return fail();
  const auto topic = topics_.find(sqlite3_column_int64(messages_.get(), 0));
  if (topic == topics_.end()) {
    error_ = fmt::format("{} is damaged: message {} is of topic {}, which it does not have",
                         path_.string(), read_ + 1, sqlite3_column_int64(messages_.get(), 0));
    messages_.reset();
    return false;
  }
  ++read_;
  message.topic = &topic->second;
  message.log_ns = sqlite3_column_int64(messages_.get(), 1);
  const void* const data = sqlite3_column_blob(messages_.get(), 2);
  const int size = sqlite3_column_bytes(messages_.get(), 2);
  message.payload = {static_cast<const std::byte*>(data),
                     data == nullptr ? 0 : static_cast<std::size_t>(size)};
  return true;
}

}  // namespace clearance
