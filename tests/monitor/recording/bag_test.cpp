// Bags in every storage format of rosbag2 give the same messages. A file that is no bag gives an
// error.
#include "monitor/recording/bag.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <functional>
#include <random>

#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::vector<RosMessage> some_messages() {
  std::vector<RosMessage> messages;
  for (int i = 0; i < 60; ++i) {
    messages.push_back(joint_state(1000 + 10 * i, 5, {{"a", "b"}, {0.1 * i, -0.2}}));
    if (i % 7 == 0) messages.push_back(transforms(1001 + 10 * i, 5, {{"world", "cart"}}));
  }
  return messages;
}

struct ReadBag {
  std::vector<RosMessage> messages;
  std::string error;
  bool readable = false;
};

ReadBag read_bag(const std::filesystem::path& path) {
  const std::unique_ptr<Bag> bag = open_bag(path);
  ReadBag read;
  BagMessage message;
  while (bag->next(message)) {
    EXPECT_EQ("cdr", message.topic->encoding);
    read.messages.push_back({message.topic->name,
                             message.topic->type,
                             message.log_ns,
                             {message.payload.begin(), message.payload.end()}});
    EXPECT_GE(bag->progress(), 0.0);
    EXPECT_LE(bag->progress(), 1.0);
  }
  read.error = bag->error();
  read.readable = bag->readable();
  return read;
}

void expect_same(const std::vector<RosMessage>& expected, const std::vector<RosMessage>& found) {
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(expected[i].topic, found[i].topic) << i;
    EXPECT_EQ(expected[i].type, found[i].type) << i;
    EXPECT_EQ(expected[i].log_ns, found[i].log_ns) << i;
    EXPECT_EQ(expected[i].cdr, found[i].cdr) << i;
  }
}

// Writes half of the messages into each of two files.
void write_halves(const std::filesystem::path& folder, const std::string& extension) {
  const std::vector<RosMessage> all = some_messages();
  const std::vector<RosMessage> halves[2] = {{all.begin(), all.begin() + 30},
                                             {all.begin() + 30, all.end()}};
  for (int i = 0; i < 2; ++i) {
    const auto file = folder / ("bag_" + std::to_string(9 + i) + extension);
    extension == ".mcap" ? write_mcap_bag(file, halves[i]) : write_sqlite_bag(file, halves[i]);
  }
}

TEST(Bag, IsTheSameInMcapInSqliteAndInAFolderOfEither) {
  const ScratchFolder folder;
  write_mcap_bag(folder / "a.mcap", some_messages());
  write_sqlite_bag(folder / "a.db3", some_messages());
  for (const char* extension : {".mcap", ".db3"}) {
    const auto bag = folder / ("bag" + std::string(extension));
    std::filesystem::create_directory(bag);
    write_halves(bag, extension);
    for (const auto& path : {folder / ("a" + std::string(extension)), bag}) {
      const ReadBag read = read_bag(path);
      EXPECT_EQ("", read.error) << path;
      EXPECT_TRUE(read.readable);
      expect_same(some_messages(), read.messages);
    }
  }
}

TEST(Bag, FolderIsReadInTheOrderThatItsMetadataSay) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "bag");
  write_halves(folder / "bag", ".db3");
  // Humble wrote the names in this form; other releases put the folder in front.
  write_text(folder / "bag/metadata.yaml",
             "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
             "  relative_file_paths:\n    - bag/bag_10.db3\n    - bag_9.db3\n");
  const ReadBag read = read_bag(folder / "bag");
  EXPECT_EQ("", read.error);
  const std::vector<RosMessage> all = some_messages();
  ASSERT_EQ(all.size(), read.messages.size());
  EXPECT_EQ(all[30].log_ns, read.messages[0].log_ns);
  EXPECT_EQ(all[0].log_ns, read.messages[all.size() - 30].log_ns);
}

TEST(Bag, MessagesThatWereCompressedOneByOneAreDecompressed) {
  const ScratchFolder folder;
  std::vector<RosMessage> messages = some_messages();
  for (RosMessage& message : messages) {
    std::vector<std::byte> small(ZSTD_compressBound(message.cdr.size()));
    small.resize(
        ZSTD_compress(small.data(), small.size(), message.cdr.data(), message.cdr.size(), 1));
    message.cdr = small;
  }
  write_sqlite_bag(folder / "a.db3", messages);
  expect_same(some_messages(), read_bag(folder / "a.db3").messages);
}

TEST(Bag, FilesThatWereCompressedAsAWholeSayWhatToDo) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "bag");
  write_text(folder / "bag/bag_0.db3.zstd", "\x28\xb5\x2f\xfd and so on");
  write_text(folder / "bag/metadata.yaml",
             "rosbag2_bagfile_information:\n  relative_file_paths: [bag_0.db3.zstd]\n");
  const ReadBag refused = read_bag(folder / "bag");
  EXPECT_FALSE(refused.readable);
  EXPECT_THAT(refused.error, HasSubstr("bag_0.db3.zstd is compressed as a whole file"));
  EXPECT_THAT(refused.error, HasSubstr("zstd -d "));
  write_sqlite_bag(folder / "bag/bag_0.db3", some_messages());
  expect_same(some_messages(), read_bag(folder / "bag").messages);
  std::filesystem::remove(folder / "bag/metadata.yaml");
  expect_same(some_messages(), read_bag(folder / "bag").messages);
  std::filesystem::remove(folder / "bag/bag_0.db3.zstd");  // as zstd -d --rm does
  expect_same(some_messages(), read_bag(folder / "bag").messages);
}

TEST(Bag, MessagesOfAnSqliteFileComeInTheOrderOfTheirTimes) {
  const ScratchFolder folder;
  std::vector<RosMessage> messages = some_messages();
  std::swap(messages[3], messages[40]);
  write_sqlite_bag(folder / "a.db3", messages);
  expect_same(some_messages(), read_bag(folder / "a.db3").messages);
}

TEST(Bag, IsNotTouched) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "bag");
  write_sqlite_bag(folder / "bag/a.db3", some_messages());
  const std::string before = read_text(folder / "bag/a.db3");
  std::filesystem::permissions(
      folder / "bag", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_EQ("", read_bag(folder / "bag/a.db3").error);
  std::filesystem::permissions(folder / "bag", std::filesystem::perms::owner_all);
  EXPECT_EQ(before, read_text(folder / "bag/a.db3"));
  EXPECT_EQ(1, std::distance(std::filesystem::directory_iterator(folder / "bag"),
                             std::filesystem::directory_iterator{}));
}

// Files that are no bags, and the error of each.
TEST(Bag, WhatIsNoneSaysWhyAndWhatIsExpected) {
  const ScratchFolder folder;
  const auto error_of = [&](const std::string& name) {
    const ReadBag read = read_bag(folder / name);
    EXPECT_FALSE(read.readable) << name;
    EXPECT_THAT(read.messages, IsEmpty());
    EXPECT_THAT(read.error, HasSubstr((folder / name).string()));
    return read.error;
  };
  std::filesystem::create_directory(folder / "empty");
  EXPECT_THAT(error_of("empty"), HasSubstr("neither metadata.yaml nor .mcap or .db3 files"));
  std::filesystem::create_directory(folder / "odd");
  write_text(folder / "odd/metadata.yaml", "rosbag2_bagfile_information: {}\n");
  EXPECT_THAT(error_of("odd"), HasSubstr("names no files; expected"));
  write_text(folder / "odd/metadata.yaml", "a: [\n");
  EXPECT_THAT(error_of("odd"), HasSubstr("metadata.yaml:2:1"));
  write_text(folder / "odd/metadata.yaml",
             "rosbag2_bagfile_information: {relative_file_paths: [gone.db3]}\n");
  EXPECT_THAT(error_of("odd"), HasSubstr("gone.db3: No such file"));
  write_text(folder / "a.txt", "text");
  EXPECT_THAT(error_of("a.txt"), HasSubstr("is not an MCAP file"));
  EXPECT_THAT(error_of("none.db3"), HasSubstr("No such file"));
  SqliteWriter(folder / "other.db3").run("CREATE TABLE topics(id INTEGER)");
  EXPECT_THAT(error_of("other.db3"), HasSubstr("lacks the tables 'topics' and 'messages'"));
  SqliteWriter endless(folder / "endless.db3");
  endless.run(
      "CREATE TABLE topics(id, name, type, serialization_format);"
      "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id FROM n)"
      " SELECT id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM n");
  EXPECT_THAT(error_of("endless.db3"), HasSubstr("lacks the tables"));
}

TEST(Bag, MessageOfNoTopicIsDamage) {
  const ScratchFolder folder;
  write_sqlite_bag(folder / "a.db3", some_messages());
  SqliteWriter(folder / "a.db3").run("UPDATE messages SET topic_id = 99 WHERE id = 11");
  const ReadBag read = read_bag(folder / "a.db3");
  EXPECT_EQ(10u, read.messages.size());
  EXPECT_TRUE(read.readable);
  EXPECT_THAT(read.error, HasSubstr("message 11 is of topic 99, which it does not have"));
}

// Whatever the file contains, reading it ends, without a fault that a sanitizer would report.
TEST(Bag, NoGarbageIsFollowed) {
  const ScratchFolder folder;
  write_sqlite_bag(folder / "a.db3", some_messages());
  const std::string whole = read_text(folder / "a.db3");
  std::mt19937_64 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    for (std::uint64_t flips = 1 + random() % 40; flips > 0; --flips) {
      bytes[16 + random() % (bytes.size() - 16)] = static_cast<char>(random());
    }
    if (i % 3 == 0) bytes.resize(random() % bytes.size());
    write_text(folder / "b.db3", bytes);
    const std::unique_ptr<Bag> bag = open_bag(folder / "b.db3");
    BagMessage message;
    for (int count = 0; count < 1000 && bag->next(message); ++count) {
    }
  }
}

}  // namespace
}  // namespace clearance::test
