#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "monitor/files/reader.hpp"
#include "monitor/files/writer.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

struct Seen {
  std::string topic;
  std::uint32_t sequence;
  std::uint64_t log_time, publish_time;
  std::string payload;
  bool operator==(const Seen&) const = default;
};

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

struct ReadBack {
  std::vector<Seen> messages;
  std::string error;
  bool readable = true;
};

ReadBack read_back(McapReader& reader) {
  ReadBack all;
  McapMessage message;
  while (reader.next(message)) {
    all.messages.push_back(
        {message.channel->topic,
         message.sequence,
         message.log_time,
         message.publish_time,
         {reinterpret_cast<const char*>(message.payload.data()), message.payload.size()}});
  }
  all.error = reader.error();
  all.readable = reader.readable();
  return all;
}

ReadBack read_back(const std::filesystem::path& file, const McapWindow& window = {}) {
  McapReader reader(file, window);
  return read_back(reader);
}

ReadBack read_bytes(const std::string& bytes, const McapWindow& window = {}) {
  McapReader reader(bytes_of(bytes), "bytes", window);
  return read_back(reader);
}

// Writes two topics and `count` messages 10 ns apart, some with equal times, in chunks of 50 ns.
void write_small(const std::filesystem::path& file, int count,
                 McapCompression compression = McapCompression::kStored) {
  McapWriter writer(file, {.chunk_span_ns = 50, .compression = compression});
  writer.metadata("about", {{"who", "test"}, {"empty", ""}});
  const std::uint16_t poses = writer.add_channel({"A", "omgidl", "struct A {};"}, "poses", "cdr");
  const std::uint16_t zones =
      writer.add_channel({"B", "omgidl", "struct B {};"}, "zones", "cdr", {{"k", "v"}});
  for (int i = 0; i < count; ++i) {
    const auto time = static_cast<std::uint64_t>(1000 + 10 * (i / 2));
    const std::string payload(static_cast<std::size_t>(i % 5), static_cast<char>('a' + i % 26));
    writer.write(i % 2 == 0 ? poses : zones, time, time - 1, bytes_of(payload));
  }
  EXPECT_TRUE(writer.close()) << writer.error();
}

// Returns true if `part` contains only messages of `all`, in their order.
bool is_subsequence(const std::vector<Seen>& part, const std::vector<Seen>& all) {
  std::size_t at = 0;
  for (const Seen& message : part) {
    while (at < all.size() && !(all[at] == message)) ++at;
    if (at++ == all.size()) return false;
  }
  return true;
}

// Parameter: uncompressed and compressed chunks.
class McapOf : public testing::TestWithParam<McapCompression> {};
INSTANTIATE_TEST_SUITE_P(Mcap, McapOf,
                         testing::Values(McapCompression::kStored, McapCompression::kZstd),
                         [](const auto& of) {
                           return of.param == McapCompression::kStored ? "Stored" : "Zstd";
                         });

TEST_P(McapOf, GivesBackWhatWasWrittenInFileOrder) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 40, GetParam());
  const ReadBack back = read_back(folder / "a.mcap");
  EXPECT_EQ("", back.error);
  ASSERT_EQ(40u, back.messages.size());
  EXPECT_EQ((Seen{"poses", 0, 1000, 999, ""}), back.messages[0]);
  EXPECT_EQ((Seen{"zones", 3, 1030, 1029, "hh"}), back.messages[7]);
  EXPECT_EQ((Seen{"poses", 19, 1190, 1189, "mmm"}), back.messages[38]);
}

TEST(Mcap, KeepsMetadataSchemasAndStatistics) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 40);
  McapReader reader(folder / "a.mcap");
  ASSERT_TRUE(reader.summary());
  const McapSummary& summary = *reader.summary();
  EXPECT_EQ(40u, summary.statistics.messages);
  EXPECT_EQ(1000u, summary.statistics.start_ns);
  EXPECT_EQ(1190u, summary.statistics.end_ns);
  EXPECT_EQ(summary.chunks.size(), summary.statistics.chunks);
  EXPECT_EQ(20u, summary.statistics.channel_messages.at(2));
  EXPECT_EQ("struct B {};", summary.channels.at(2).schema.text);
  EXPECT_EQ("v", summary.channels.at(2).metadata.at("k"));
  EXPECT_EQ("test", summary.metadata.at("about").at("who"));
  McapMessage message;
  ASSERT_TRUE(reader.next(message));
  EXPECT_EQ("test", reader.metadata().at("about").at("who"));
  EXPECT_EQ("struct A {};", message.channel->schema.text);
}

TEST(Mcap, SameCallsGiveTheSameBytes) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 40);
  write_small(folder / "b.mcap", 40);
  EXPECT_EQ(read_text(folder / "a.mcap"), read_text(folder / "b.mcap"));
}

TEST(Mcap, EmptyRecordingIsSound) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 0);
  const ReadBack back = read_back(folder / "a.mcap");
  EXPECT_EQ("", back.error);
  EXPECT_THAT(back.messages, IsEmpty());
}

TEST_P(McapOf, WindowGivesTheSameMessagesWithAndWithoutAnIndex) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 100, GetParam());
  const std::string whole = read_text(folder / "a.mcap");
  // no closing magic and therefore no index
  write_text(folder / "cut.mcap", whole.substr(0, whole.size() - 8));
  for (std::uint64_t start = 990; start < 1520; start += 17) {
    const McapWindow window{start, start + 60};
    const ReadBack indexed = read_back(folder / "a.mcap", window);
    EXPECT_EQ("", indexed.error);
    EXPECT_EQ(indexed.messages, read_back(folder / "cut.mcap", window).messages);
    for (const Seen& message : indexed.messages) {
      EXPECT_GE(message.log_time, window.start_ns);
      EXPECT_LE(message.log_time, window.end_ns);
    }
  }
}

TEST(Mcap, WindowIsReadThroughTheIndexAndPastDamageElsewhere) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 100);
  McapFile file(folder / "a.mcap");
  const auto summary = read_mcap_summary(file);
  ASSERT_TRUE(summary);
  std::string bytes = read_text(folder / "a.mcap");
  bytes[static_cast<std::size_t>(summary->chunks.front().offset) + 60] ^= 1;
  write_text(folder / "b.mcap", bytes);
  EXPECT_THAT(read_back(folder / "b.mcap").error, HasSubstr("checksum"));
  const ReadBack late = read_back(folder / "b.mcap", {.start_ns = 1200});
  EXPECT_EQ("", late.error);
  EXPECT_EQ(60u, late.messages.size());
}

TEST_P(McapOf, FileCutOffAtAnyByteGivesItsFirstMessagesAndSaysWhere) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 30, GetParam());
  const std::string whole = read_text(folder / "a.mcap");
  const std::vector<Seen> all = read_back(folder / "a.mcap").messages;
  std::size_t most = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const ReadBack back = read_bytes(whole.substr(0, length));
    EXPECT_THAT(back.error, Not(IsEmpty())) << length;
    EXPECT_GE(back.messages.size(), most) << length;  // more bytes never give fewer messages
    most = back.messages.size();
    ASSERT_LE(most, all.size());
    EXPECT_TRUE(std::equal(back.messages.begin(), back.messages.end(), all.begin())) << length;
  }
  EXPECT_EQ(all.size(), most);
}

TEST(Mcap, CutOffFileNamesItsEndAndHowMuchWasRead) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 30);
  const std::string whole = read_text(folder / "a.mcap");
  const std::size_t third = whole.size() / 3;
  write_text(folder / "cut.mcap", whole.substr(0, third));
  const ReadBack back = read_back(folder / "cut.mcap");
  EXPECT_TRUE(back.readable);
  EXPECT_THAT(back.error, HasSubstr("cut.mcap is damaged at byte"));
  EXPECT_THAT(back.error, HasSubstr(" of " + std::to_string(third)));
  EXPECT_THAT(back.error, HasSubstr("cut off"));
  EXPECT_THAT(back.error, HasSubstr("came " + std::to_string(back.messages.size()) + " messages"));
}

// Oracle: the file before the flip. A flipped bit may hide messages. It never alters one, and is
// always noticed, wherever it is.
TEST_P(McapOf, NoFlippedBitGoesUnnoticed) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 30, GetParam());
  const std::string whole = read_text(folder / "a.mcap");
  const std::vector<Seen> all = read_back(folder / "a.mcap").messages;
  std::mt19937_64 random(11);
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = whole;
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
    const ReadBack back = read_bytes(bytes);
    EXPECT_TRUE(is_subsequence(back.messages, all)) << "byte " << at;
    EXPECT_FALSE(back.error.empty()) << "byte " << at;
    read_bytes(bytes, {.start_ns = 1050, .end_ns = 1100});  // only needs to survive
  }
}

TEST(Mcap, WhatFollowsBehindTheEndIsTold) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 30);
  const std::string whole = read_text(folder / "a.mcap");
  const std::vector<Seen> all = read_back(folder / "a.mcap").messages;
  for (const std::string& more : {std::string("x"), whole}) {
    const ReadBack back = read_bytes(whole + more);
    EXPECT_EQ(all, back.messages);
    EXPECT_THAT(back.error, HasSubstr("more follows behind its end"));
  }
}

TEST_P(McapOf, NoGarbageIsFollowed) {
  const ScratchFolder folder;
  write_small(folder / "a.mcap", 30, GetParam());
  const std::string whole = read_text(folder / "a.mcap");
  std::mt19937_64 random(12);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = whole;
    const std::size_t from = 8 + random() % (bytes.size() - 8);
    const std::size_t length = std::min<std::size_t>(1 + random() % 64, bytes.size() - from);
    for (std::size_t k = 0; k < length; ++k) bytes[from + k] = static_cast<char>(random());
    read_bytes(bytes);
    read_bytes(bytes, {.start_ns = 1050, .end_ns = 1100});
  }
}

// A file that McapBytes writes record by record.
class HandMade {
 public:
  HandMade() {
    bytes_.put_raw(std::as_bytes(std::span(kMcapMagic)));
    record(McapKind::kHeader, [](McapBytes& out) {
      out.put_text("");
      out.put_text("hand");
    });
  }
  template <class Fill>
  HandMade& record(McapKind kind, const Fill& fill) {
    const std::size_t begin = bytes_.begin_record(kind);
    fill(bytes_);
    bytes_.end_record(begin);
    return *this;
  }
  HandMade& schema_and_channel() {
    record(McapKind::kSchema, [](McapBytes& out) {
      out.put(std::uint16_t{1});
      for (const char* text : {"A", "omgidl", "struct A {};"}) out.put_text(text);
      out.put(std::uint16_t{0xdead});  // padding
    });
    return record(McapKind::kChannel, [](McapBytes& out) {
      out.put(std::uint16_t{7});
      out.put(std::uint16_t{1});
      out.put_text("poses");
      out.put_text("cdr");
      out.put_map({});
      out.put(std::uint8_t{0xad});  // padding
    });
  }
  HandMade& message(std::uint16_t channel) {
    return record(McapKind::kMessage, [channel](McapBytes& out) {
      out.put(channel);
      out.put(std::uint32_t{0});
      out.put(std::uint64_t{5});
      out.put(std::uint64_t{5});
      out.put_raw(bytes_of("payload"));
    });
  }
  void end(const std::filesystem::path& file) {
    record(McapKind::kDataEnd, [](McapBytes& out) { out.put(std::uint32_t{0}); });
    record(McapKind::kFooter, [](McapBytes& out) {
      out.put(std::uint64_t{0});
      out.put(std::uint64_t{0});
      out.put(std::uint32_t{0});
    });
    bytes_.put_raw(std::as_bytes(std::span(kMcapMagic)));
    save(file);
  }
  void save(const std::filesystem::path& file) {
    const auto view = bytes_.view();
    write_text(file, {reinterpret_cast<const char*>(view.data()), view.size()});
  }

 private:
  McapBytes bytes_;
};

TEST(Mcap, PassesOverPaddingAndUnknownRecordsAndReadsFilesWithoutChunks) {
  const ScratchFolder folder;
  HandMade()
      .schema_and_channel()
      .record(static_cast<McapKind>(0x9c), [](McapBytes& out) { out.put_text("private"); })
      .record(McapKind::kAttachment, [](McapBytes& out) { out.put_text("whatever"); })
      .message(7)
      .end(folder / "a.mcap");
  const ReadBack back = read_back(folder / "a.mcap");
  EXPECT_EQ("", back.error);
  ASSERT_EQ(1u, back.messages.size());
  EXPECT_EQ("payload", back.messages[0].payload);
}

TEST(Mcap, DoesNotBelieveALengthBeyondTheFile) {
  const ScratchFolder folder;
  McapBytes bytes;
  bytes.put_raw(std::as_bytes(std::span(kMcapMagic)));
  bytes.put(static_cast<std::uint8_t>(McapKind::kMessage));
  bytes.put(std::numeric_limits<std::uint64_t>::max() - 3);
  const auto view = bytes.view();
  write_text(folder / "a.mcap", {reinterpret_cast<const char*>(view.data()), view.size()});
  EXPECT_THAT(read_back(folder / "a.mcap").error, HasSubstr("damaged at byte 8"));
}

TEST(Mcap, MessageOfAnUndeclaredChannelIsDamage) {
  const ScratchFolder folder;
  HandMade().schema_and_channel().message(7).message(8).end(folder / "a.mcap");
  const ReadBack back = read_back(folder / "a.mcap");
  EXPECT_EQ(1u, back.messages.size());
  EXPECT_THAT(back.error, HasSubstr("damaged"));
}

TEST(Mcap, OtherFilesAreRefusedByName) {
  const ScratchFolder folder;
  write_text(folder / "cell.yaml", "name: a cell, not a recording\n");
  EXPECT_THAT(read_back(folder / "cell.yaml").error, HasSubstr("cell.yaml is not an MCAP file"));
  EXPECT_THAT(read_back(folder / "none.mcap").error, HasSubstr("none.mcap: No such file"));
  write_text(folder / "empty.mcap", "");
  EXPECT_THAT(read_back(folder / "empty.mcap").error, HasSubstr("is empty"));
}

TEST(McapWriter, WhatIsFlushedSurvivesWithoutClosing) {
  const ScratchFolder folder;
  McapWriter writer(folder / "a.mcap");
  const std::uint16_t channel = writer.add_channel({"A", "omgidl", ""}, "a", "cdr");
  writer.write(channel, 1, 1, bytes_of("kept"));
  writer.flush();
  writer.write(channel, 2, 2, bytes_of("still in memory"));
  const ReadBack back = read_back(folder / "a.mcap");
  ASSERT_EQ(1u, back.messages.size());
  EXPECT_EQ("kept", back.messages[0].payload);
}

}  // namespace
}  // namespace clearance::test
