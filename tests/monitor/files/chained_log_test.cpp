// Every small tampering with a short log, listed and not sampled. The oracle knows only what was
// done to the lines.
#include "monitor/files/chained_log.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Lines from here on, each with its line break.
std::vector<std::string> lines_from(ChainEnd& end, std::size_t count, const std::string& about) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < count; ++i)
    lines.push_back(next_line(end, 1'764'000'000'000'000'123 + 1'000'000 * std::int64_t(i), "note",
                              fmt::format(R"("text":"{} {}")", about, i)));
  return lines;
}

class ChainedLogs : public testing::Test {
 protected:
  static constexpr std::size_t kLines = 5;
  ChainedLogs() : lines(lines_from(end, kLines, "as it was")) {}
  ChainedLog read(const std::vector<std::string>& of) {
    std::string text;
    for (const std::string& line : of) text += line;
    return read(text);
  }
  ChainedLog read(const std::string& text) {
    test::write_text(folder / "log", text);
    return read_chained_log(folder / "log");
  }

  test::ScratchFolder folder;
  ChainEnd end;
  std::vector<std::string> lines;
};

TEST_F(ChainedLogs, AreReadAsTheyWereWritten) {
  ChainedLog log;
  std::vector<std::string> fields;
  test::write_text(folder / "log", lines[0] + lines[1]);
  log = read_chained_log(folder / "log", [&](const ChainedLine& line) {
    EXPECT_EQ(line.number, fields.size() + 1);
    EXPECT_EQ(line.kind, "note");
    fields.emplace_back(line.fields);
    if (line.number == 1) {
      EXPECT_EQ(line.time, "2025-11-24T16:00:00.000000Z");
      EXPECT_EQ(line.before, std::string(64, '0'));
    }
  });
  EXPECT_EQ(log.fault + log.torn + log.error, "");
  EXPECT_EQ(fields,
            (std::vector<std::string>{R"("text":"as it was 0")", R"("text":"as it was 1")"}));
  EXPECT_EQ(read(lines).end.hash, end.hash);
  EXPECT_EQ(read(std::string()).end.number, 0u) << "a log without lines";
  EXPECT_THAT(read_chained_log(folder / "none").error, HasSubstr("none"));
}

TEST_F(ChainedLogs, NameTheLineInWhichAnyBitHasFlipped) {
  for (std::size_t at = 0; at < kLines; ++at) {
    for (std::size_t byte = 0; byte + 1 < lines[at].size(); ++byte) {
      for (int bit = 0; bit < 8; ++bit) {
        std::vector<std::string> changed = lines;
        changed[at][byte] = static_cast<char>(changed[at][byte] ^ (1 << bit));
        ASSERT_THAT(read(changed).fault, StartsWith(fmt::format("line {} ", at + 1)))
            << "byte " << byte << ", bit " << bit;
      }
    }
  }
}

TEST_F(ChainedLogs, NameTheFirstBreakOfEachRemovalInsertionAndMove) {
  for (std::size_t at = 0; at < kLines; ++at) {
    std::vector<std::string> removed = lines;
    removed.erase(removed.begin() + std::ptrdiff_t(at));
    const std::string fault = read(removed).fault;
    if (at + 1 < kLines) {
      EXPECT_EQ(fault, fmt::format("line {} has the number {}; expected {}: a line in front of it "
                                   "was removed",
                                   at + 1, at + 2, at + 1));
    } else {
      EXPECT_EQ(fault, "") << "whatever is cut off between two lines shows only by a hash";
      EXPECT_NE(read(removed).end.hash, end.hash);
    }
    for (std::size_t to = 0; to <= kLines; ++to) {
      std::vector<std::string> inserted = lines;
      inserted.insert(inserted.begin() + std::ptrdiff_t(to), lines[at]);
      const std::size_t first = to == at ? at + 2 : to + 1;  // of two that are alike, the second
      EXPECT_THAT(read(inserted).fault, StartsWith(fmt::format("line {} ", first)))
          << at << " to " << to;
    }
    for (std::size_t other = at + 1; other < kLines; ++other) {
      std::vector<std::string> swapped = lines;
      std::swap(swapped[at], swapped[other]);
      EXPECT_EQ(
          read(swapped).fault,
          fmt::format("line {} has the number {}; expected {}, which stands in line {}: lines "
                      "were moved",
                      at + 1, other + 1, at + 1, other + 1));
    }
  }
}

TEST_F(ChainedLogs, NameALineThatWasWrittenAnewByTheOneThatFollows) {
  for (std::size_t at = 0; at + 1 < kLines; ++at) {
    ChainEnd before;
    (void)lines_from(before, at, "as it was");
    std::vector<std::string> forged = lines;
    forged[at] = lines_from(before, 1, "as it was not").front();
    EXPECT_THAT(read(forged).fault,
                StartsWith(fmt::format("line {} follows a line with the hash", at + 2)));
  }
  ChainEnd forged_end;
  const ChainedLog forged = read(lines_from(forged_end, kLines, "as it was not"));
  EXPECT_EQ(forged.fault, "") << "a chain finds no log that was written anew as a whole";
  EXPECT_NE(forged.end.hash, end.hash) << "but a hash that is kept elsewhere does";
}

TEST_F(ChainedLogs, CutOffAtAnyByteKeepTheWholeLinesAndTheRest) {
  std::string text;
  for (const std::string& line : lines) text += line;
  std::size_t whole = 0, begins = 0;
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    if (bytes > 0 && text[bytes - 1] == '\n') ++whole, begins = bytes;
    const ChainedLog log = read(text.substr(0, bytes));
    ASSERT_EQ(log.fault, "");
    ASSERT_EQ(log.end.number, whole);
    ASSERT_EQ(log.torn, text.substr(begins, bytes - begins));
  }
}

TEST_F(ChainedLogs, GoOnBehindABreakThatStaysVisible) {
  lines[1][100] ^= 1;
  ChainedLog broken = read(lines);
  const std::string fault = broken.fault;
  ASSERT_NE(fault, "");
  EXPECT_EQ(broken.end.number, kLines);
  lines.push_back(lines_from(broken.end, 1, "later").front());
  EXPECT_EQ(read(lines).fault, fault);
  EXPECT_EQ(read(lines).end.number, kLines + 1);
}

}  // namespace
}  // namespace clearance
