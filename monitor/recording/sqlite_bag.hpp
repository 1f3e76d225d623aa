// A bag that is one SQLite 3 file, as rosbag2's sqlite3 storage writes it.
//
// It reads the tables topics (id, name, type, serialization_format, ...) and messages (id,
// topic_id, timestamp in ns, data). Additional columns of newer versions are ignored.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "monitor/recording/bag.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace clearance {

// Reads the file without writing anything beside it, and without waiting for programs that have it
// open. Messages come in the order of their times.
class SqliteBag final : public Bag {
 public:
  explicit SqliteBag(const std::filesystem::path& file);

  [[nodiscard]] bool next(BagMessage& message) override;
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] bool readable() const noexcept override { return readable_; }
  [[nodiscard]] double progress() const noexcept override;

 private:
  struct Close {
    void operator()(sqlite3* file) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  // Both set error().
  [[nodiscard]] bool fail();
  [[nodiscard]] Statement prepare(const char* sql);
  [[nodiscard]] bool has_tables();
  void read_topics();
  void count_messages();

  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> file_;
  Statement messages_;
  std::map<std::int64_t, BagTopic> topics_;  // by id
  std::int64_t count_ = 0, read_ = 0;
  bool readable_ = false;
  std::string error_;
};

}  // namespace clearance
