// The log of interventions on real files. A full disk is a limit of the process on the size of
// files.
#include "monitor/app/intervention_log.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "monitor/app/log_line.hpp"
#include "tests/shared/logged.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::eventually;
using testing::ElementsAre;
using testing::HasSubstr;

class Interventions : public testing::Test {
 protected:
  // The kinds of the lines; expects that no line is broken.
  std::vector<std::string> kinds() {
    std::vector<std::string> kinds;
    fields.clear();
    const ChainedLog log = read_chained_log(file, [&](const ChainedLine& line) {
      kinds.emplace_back(line.kind);
      fields.emplace_back(line.fields);
    });
    EXPECT_EQ(log.fault + log.torn + log.error, "");
    return kinds;
  }
  void write(const std::string& kind) { InterventionLog(file).note(kind, {}); }

  test::ScratchFolder folder;
  const std::filesystem::path file = folder / "log";
  std::vector<std::string> fields;
};

TEST_F(Interventions, GoOnBehindTheLastLineOfTheRunBefore) {
  write("first");
  write("second");
  EXPECT_THAT(kinds(), ElementsAre("first", "second"));
}

TEST_F(Interventions, KeepALineThatWasNotWholeInTheNextOne) {
  write("first");
  test::write_text(file, test::read_text(file) + R"({"number":2,"ti)");
  write("second");
  EXPECT_THAT(kinds(), ElementsAre("first", "torn", "second"));
  EXPECT_EQ(fields[1], R"("bytes":15,"text":"{\"number\":2,\"ti")");
}

TEST_F(Interventions, SayThatTheLogWasBrokenAndGoOn) {
  write("first");
  write("second");
  std::string text = test::read_text(file);
  text.erase(0, text.find('\n') + 1);
  test::write_text(file, text);
  write("third");
  const ChainedLog log = read_chained_log(file);
  EXPECT_THAT(log.fault, HasSubstr("line 1 has the number 2"));
  EXPECT_THAT(test::read_text(file), HasSubstr(R"("kind":"broken","text":"line 1 has)"));
}

TEST_F(Interventions, HaveOneWriter) {
  const InterventionLog log(file);
  try {
    const InterventionLog other(file);
    FAIL() << "a second writer";
  } catch (const InterventionError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is written by another program"));
  }
}

TEST_F(Interventions, AreRefusedWhereThereIsNoRegularFile) {
  for (const std::filesystem::path& wrong :
       {folder / "no_folder/log", std::filesystem::path("/dev/null"), folder / "."})
    EXPECT_THROW(InterventionLog{wrong}, InterventionError) << wrong;
}

TEST_F(Interventions, GetTheLogLinesThatTellOfOneWhateverTheirLevelAndWhateverTheirBytes) {
  {
    const InterventionLog log(file);
    log_line(lines::kSourceTakenOver, "a\xff\"b", "2", "1");
    log_line(lines::kPosesBack, "hand");
  }
  log_line(lines::kSourceTakenOver, "too late", "2", "1");
  EXPECT_THAT(kinds(), ElementsAre("source-taken-over"));
  const auto read = nlohmann::json::parse("{" + fields[0] + "}");
  EXPECT_EQ(read["text"], "source 'a\xef\xbf\xbd\"b' is now writer 2; before, it was writer 1");
}

TEST_F(Interventions, EndWithTheLastLineWhateverOtherThreadsNoteMeanwhile) {
  InterventionLog log(file);
  std::jthread other([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      log.note("other", {});
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(file) > 0; }));
  log.finish("last", {});
  EXPECT_EQ(kinds().back(), "last");
}

TEST_F(Interventions, OfAFullDiskWaitAndAreWrittenOnceThereIsRoom) {
  write("first");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{std::filesystem::file_size(file) + 10, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  InterventionLog log(file);
  for (std::size_t i = 0; i < InterventionLog::kMost + 7; ++i) log.note("waits", {{"i", i}});
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(std::filesystem::file_size(file), full.rlim_cur - 10) << "no part of a line stays";
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  // A line that is being written may be read in part.
  const auto lines = [this] { return std::ranges::count(test::read_text(file), '\n'); };
  ASSERT_TRUE(eventually([&] { return lines() == InterventionLog::kMost + 2; }));
  log.finish("last", {});
  EXPECT_EQ(log.complete(), true);
  const std::vector<std::string> all = kinds();
  EXPECT_EQ(all[1], "left-out");
  EXPECT_EQ(fields[1], R"("count":7)");
  EXPECT_EQ(all.back(), "last");
}

TEST_F(Interventions, AreIncompleteIfTheDiskStaysFull) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{10, before.rlim_max};
  InterventionLog log(file);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  log.finish("lost", {});
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_FALSE(log.complete());
  EXPECT_FALSE(log.hangs());
  EXPECT_EQ(test::read_text(file), "");
}

TEST_F(Interventions, OfALargeFileGoOnInANewOneWhoseFirstLineHoldsTheHashOfTheLast) {
  {
    InterventionLog log(file, 600);
    for (int i = 0; i < 7; ++i) log.note("note", {{"i", i}});
    log.finish("note", {{"i", 7}});
    EXPECT_TRUE(log.complete());
  }
  std::vector<std::filesystem::path> files;
  while (std::filesystem::exists(folder / fmt::format("log-{}", files.size() + 2)))
    files.push_back(folder / fmt::format("log-{}", files.size() + 2));
  EXPECT_GE(files.size(), 2u);
  files.push_back(file);
  std::string before;  // the hash of the last line of the file before
  int notes = 0;
  for (const std::filesystem::path& each : files) {
    SCOPED_TRACE(each);
    std::size_t lines = 0;
    const ChainedLog log = read_chained_log(each, [&](const ChainedLine& line) {
      const auto read = nlohmann::json::parse(fmt::format("{{{}}}", line.fields));
      if (++lines > 1 || before.empty()) {
        EXPECT_EQ(read.value("i", -1), notes++);
        return;
      }
      EXPECT_EQ(line.kind, "continues");
      EXPECT_EQ(read.value("last", ""), before);
    });
    EXPECT_EQ(log.fault + log.torn + log.error, "");
    before = log.end.hash;
  }
  EXPECT_EQ(notes, 8);
}

TEST_F(Interventions, GetNoLineInAFileThatAnotherProgramHasChangedOrMoved) {
  for (const bool moves : {false, true}) {
    InterventionLog log(file);
    log.note("first", {});
    ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(file) > 0; }));
    if (moves) {
      std::filesystem::rename(file, folder / "moved");
    } else {
      std::filesystem::resize_file(file, 0);
    }
    log.finish("second", {});
    EXPECT_FALSE(log.complete()) << moves;
    std::error_code none;
    EXPECT_EQ(moves ? std::filesystem::exists(file, none) : test::read_text(file) != "", false);
  }
}

}  // namespace
}  // namespace clearance
