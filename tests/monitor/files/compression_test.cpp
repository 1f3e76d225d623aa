// Chunks that other programs compressed: their content, and the handling of hostile ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cstring>
#include <random>

#include "monitor/files/reader.hpp"
#include "monitor/files/writer.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

using Bytes = std::vector<std::byte>;

// Compressible text, longer than a block of either library.
Bytes some_bytes(std::size_t size) {
  Bytes bytes(size);
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = std::byte(i % 97 < 60 ? i % 13 : random() % 7);
  return bytes;
}

Bytes as_lz4(std::span<const std::byte> bytes) {
  Bytes out(LZ4F_compressFrameBound(bytes.size(), nullptr));
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}

Bytes as_zstd(std::span<const std::byte> bytes) {
  Bytes out(ZSTD_compressBound(bytes.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

Bytes compressed(McapCompression how, std::span<const std::byte> bytes) {
  return how == McapCompression::kLz4 ? as_lz4(bytes) : as_zstd(bytes);
}

constexpr McapCompression kCompressions[] = {McapCompression::kZstd, McapCompression::kLz4};

TEST(Compression, GivesBackWhatTheLibrariesCompressed) {
  for (const McapCompression how : kCompressions) {
    for (const std::size_t size : {0u, 1u, 1000u, 6'000'000u}) {
      const Bytes bytes = some_bytes(size);
      Bytes out;
      decompress(how, compressed(how, bytes), size, out);
      EXPECT_EQ(bytes, out) << name(how) << size;
    }
  }
  Bytes ours, out;
  compress_zstd(some_bytes(300'000), ours);
  decompress(McapCompression::kZstd, ours, 300'000, out);
  EXPECT_EQ(some_bytes(300'000), out);
}

TEST(Compression, WhatIsCutOffGivesItsBeginning) {
  const Bytes bytes = some_bytes(1'000'000);
  for (const McapCompression how : kCompressions) {
    const Bytes whole = compressed(how, bytes);
    Bytes out;
    decompress(how, std::span(whole).first(whole.size() / 2), bytes.size(), out);
    EXPECT_GT(out.size(), bytes.size() / 4) << name(how);
    EXPECT_LT(out.size(), bytes.size());
    EXPECT_TRUE(std::equal(out.begin(), out.end(), bytes.begin()));
  }
}

// A megabyte of zeros is compressed into a few dozen bytes. The requested size is the limit.
TEST(Compression, NeverGivesMoreThanIsAskedFor) {
  const Bytes zeros(1'000'000);
  for (const McapCompression how : kCompressions) {
    Bytes out;
    decompress(how, compressed(how, zeros), 1000, out);
    EXPECT_EQ(1000u, out.size());
  }
}

TEST(Compression, GarbageGivesSomethingOrNothingAndEnds) {
  std::mt19937_64 random(6);
  const Bytes bytes = some_bytes(20'000);
  for (const McapCompression how : kCompressions) {
    const Bytes whole = compressed(how, bytes);
    for (int i = 0; i < 2000; ++i) {
      Bytes damaged = whole;
      for (std::uint64_t flips = 1 + random() % 8; flips > 0; --flips) {
        damaged[random() % damaged.size()] ^= std::byte(1 << random() % 8);
      }
      Bytes out;
      decompress(how, damaged, bytes.size(), out);
      EXPECT_LE(out.size(), bytes.size());
    }
  }
}

// One chunk that contains one message, built from these parts.
struct Chunk {
  std::string compression;
  Bytes stored;
  std::uint64_t uncompressed;
};

void write_chunk(const std::filesystem::path& file, const Chunk& chunk) {
  McapBytes bytes;
  bytes.put_raw(std::as_bytes(std::span(kMcapMagic)));
  const std::size_t record = bytes.begin_record(McapKind::kChunk);
  for (int i = 0; i < 2; ++i) bytes.put(std::uint64_t{5});
  bytes.put(chunk.uncompressed);
  bytes.put(std::uint32_t{0});
  bytes.put_text(chunk.compression);
  bytes.put(std::uint64_t{chunk.stored.size()});
  bytes.put_raw(chunk.stored);
  bytes.end_record(record);
  const auto view = bytes.view();
  write_text(file, {reinterpret_cast<const char*>(view.data()), view.size()});
}

Bytes records_of_one_message() {
  McapBytes bytes;
  const std::size_t channel = bytes.begin_record(McapKind::kChannel);
  bytes.put(std::uint16_t{7});
  bytes.put(std::uint16_t{0});
  bytes.put_text("poses");
  bytes.put_text("cdr");
  bytes.put_map({});
  bytes.end_record(channel);
  const std::size_t message = bytes.begin_record(McapKind::kMessage);
  bytes.put(std::uint16_t{7});
  bytes.put(std::uint32_t{0});
  for (int i = 0; i < 2; ++i) bytes.put(std::uint64_t{5});
  bytes.put_text("payload");
  bytes.end_record(message);
  return {bytes.view().begin(), bytes.view().end()};
}

struct Outcome {
  int messages = 0;
  std::string error;
  bool readable = true;
};

Outcome outcome_of(const Chunk& chunk) {
  const ScratchFolder folder;
  write_chunk(folder / "a.mcap", chunk);
  McapReader reader(folder / "a.mcap");
  McapMessage message;
  Outcome outcome;
  while (reader.next(message)) ++outcome.messages;
  outcome.error = reader.error();
  outcome.readable = reader.readable();
  return outcome;
}

TEST(CompressedChunk, IsReadHoweverItIsCompressed) {
  const Bytes records = records_of_one_message();
  for (const McapCompression how : kCompressions) {
    const Outcome outcome =
        outcome_of({std::string(name(how)), compressed(how, records), records.size()});
    EXPECT_EQ(1, outcome.messages);
    EXPECT_THAT(outcome.error, HasSubstr("cut off"));  // nothing follows the chunk
  }
}

TEST(CompressedChunk, ThatLiesAboutItsSizeIsDamage) {
  const Bytes records = records_of_one_message();
  for (const McapCompression how : kCompressions) {
    const std::string method(name(how));
    for (const std::uint64_t size :
         {records.size() - 1, records.size() + 1, std::size_t{100'000'000}}) {
      const Outcome outcome = outcome_of({method, compressed(how, records), size});
      EXPECT_THAT(outcome.error, HasSubstr("damaged at byte"));
    }
    EXPECT_THAT(outcome_of({method, compressed(how, records), ~std::uint64_t{0}}).error,
                HasSubstr("is more than this reader takes (256 MiB)"));
    EXPECT_THAT(outcome_of({method, compressed(how, records), kLargestMcapChunk + 1}).error,
                HasSubstr("is more than this reader takes (256 MiB)"));
    EXPECT_THAT(outcome_of({method, records, records.size()}).error,
                HasSubstr("a chunk whose " + method + " data makes no sense"));
  }
}

// Ten thousand times as large as it is in the file.
TEST(CompressedChunk, OfNothingIsDamageAtItsFirstRecord) {
  const Bytes nothing(std::size_t{1} << 24);
  for (const McapCompression how : kCompressions) {
    const Outcome outcome =
        outcome_of({std::string(name(how)), compressed(how, nothing), nothing.size()});
    EXPECT_EQ(0, outcome.messages);
    EXPECT_THAT(outcome.error, HasSubstr("a record of kind 0"));
  }
}

TEST(CompressedChunk, OfAnotherMethodIsRefusedByNameWithWhatToDo) {
  const Outcome outcome = outcome_of({"snappy", records_of_one_message(), 1});
  EXPECT_FALSE(outcome.readable);
  EXPECT_THAT(outcome.error, HasSubstr("compressed by 'snappy'; expected zstd, lz4 or none"));
  EXPECT_THAT(outcome.error, HasSubstr("mcap compress IN.mcap -o OUT.mcap"));
}

}  // namespace
}  // namespace clearance::test
