// Bags in rosbag2's formats: messages of ROS 2 in an MCAP file, or in an SQLite file made with
// SQLite's own library.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "monitor/files/writer.hpp"

namespace clearance::test {

// Little-endian CDR by its rules: each number is aligned to its size, counted from the end of the
// header.
class RosCdr {
 public:
  RosCdr& number(auto value) {
    while ((bytes_.size() - 4) % sizeof(value) != 0) bytes_.push_back(std::byte{0});
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + sizeof(value));
    std::memcpy(bytes_.data() + begin, &value, sizeof(value));
    return *this;
  }
  RosCdr& text(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
    bytes_.push_back(std::byte{0});
    return *this;
  }
  RosCdr& numbers(const std::vector<double>& values) {
    number(static_cast<std::uint32_t>(values.size()));
    for (const double value : values) number(value);
    return *this;
  }
  RosCdr& header(std::int64_t stamp_ns, const std::string& frame) {
    number(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
    number(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    return text(frame);
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
};

struct RosMessage {
  std::string topic, type;
  std::int64_t log_ns = 0;
  std::vector<std::byte> cdr;
};

struct JointStateText {
  std::vector<std::string> name;
  std::vector<double> position;
  std::vector<double> velocity = {};
  std::vector<double> effort = {};
};

inline RosMessage joint_state(std::int64_t log_ns, std::int64_t stamp_ns,
                              const JointStateText& state,
                              const std::string& topic = "/joint_states") {
  RosCdr cdr;
  cdr.header(stamp_ns, "").number(static_cast<std::uint32_t>(state.name.size()));
  for (const std::string& name : state.name) cdr.text(name);
  cdr.numbers(state.position).numbers(state.velocity).numbers(state.effort);
  return {topic, "sensor_msgs/msg/JointState", log_ns, cdr.bytes()};
}

struct FrameText {
  std::string parent, child;
  std::vector<double> position = {0, 0, 0};
  std::vector<double> xyzw = {0, 0, 0, 1};
};

inline RosMessage transforms(std::int64_t log_ns, std::int64_t stamp_ns,
                             const std::vector<FrameText>& frames,
                             const std::string& topic = "/tf") {
  RosCdr cdr;
  cdr.number(static_cast<std::uint32_t>(frames.size()));
  for (const FrameText& frame : frames) {
    cdr.header(stamp_ns, frame.parent).text(frame.child);
    for (const double value : frame.position) cdr.number(value);
    for (const double value : frame.xyzw) cdr.number(value);
  }
  return {topic, "tf2_msgs/msg/TFMessage", log_ns, cdr.bytes()};
}

inline RosMessage ros_text(std::int64_t log_ns, const std::string& text,
                           const std::string& topic = "/robot_description") {
  return {topic, "std_msgs/msg/String", log_ns, RosCdr().text(text).bytes()};
}

inline void write_mcap_bag(const std::filesystem::path& file,
                           const std::vector<RosMessage>& messages) {
  McapWriter writer(file);
  std::map<std::string, std::uint16_t> channels;
  for (const RosMessage& message : messages) {
    const auto [channel, added] = channels.try_emplace(message.topic);
    if (added) {
      channel->second =
          writer.add_channel({message.type, "ros2msg", "# of no use here"}, message.topic, "cdr");
    }
    const auto time = static_cast<std::uint64_t>(message.log_ns);
    writer.write(channel->second, time, time, message.cdr);
  }
  EXPECT_TRUE(writer.close()) << writer.error();
}

// The tables of rosbag2_storage_sqlite3, schema version 4.
class SqliteWriter {
 public:
  explicit SqliteWriter(const std::filesystem::path& file) {
    EXPECT_EQ(SQLITE_OK, sqlite3_open(file.c_str(), &file_));
  }
  ~SqliteWriter() { sqlite3_close(file_); }
  SqliteWriter(const SqliteWriter&) = delete;
  SqliteWriter& operator=(const SqliteWriter&) = delete;

  void run(const std::string& sql) {
    EXPECT_EQ(SQLITE_OK, sqlite3_exec(file_, sql.c_str(), nullptr, nullptr, nullptr))
        << sqlite3_errmsg(file_);
  }
  void make_tables() {
    run("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
        "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
        "metadata TEXT NOT NULL);"
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, "
        "type_description_hash TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
        "INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
  }
  void add(int topic, const RosMessage& message) {
    sqlite3_stmt* row = nullptr;
    sqlite3_prepare_v2(file_, "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
                       -1, &row, nullptr);
    sqlite3_bind_int(row, 1, topic);
    sqlite3_bind_int64(row, 2, message.log_ns);
    sqlite3_bind_blob(row, 3, message.cdr.data(), static_cast<int>(message.cdr.size()),
                      SQLITE_TRANSIENT);
    EXPECT_EQ(SQLITE_DONE, sqlite3_step(row));
    sqlite3_finalize(row);
  }

 private:
  sqlite3* file_ = nullptr;
};

inline void write_sqlite_bag(const std::filesystem::path& file,
                             const std::vector<RosMessage>& messages) {
  SqliteWriter writer(file);
  writer.make_tables();
  writer.run("BEGIN");
  std::map<std::string, int> topics;
  for (const RosMessage& message : messages) {
    const auto [topic, added] = topics.try_emplace(message.topic);
    if (added) {
      topic->second = static_cast<int>(topics.size());
      writer.run("INSERT INTO topics VALUES (" + std::to_string(topic->second) + ", '" +
                 message.topic + "', '" + message.type + "', 'cdr', '', '')");
    }
    writer.add(topic->second, message);
  }
  writer.run("COMMIT");
}

}  // namespace clearance::test
