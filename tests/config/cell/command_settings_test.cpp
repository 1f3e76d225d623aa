// The keys `commands:`, `questions:` and `capacity:` of a cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;

// The sections begin in line 4.
std::string with(const std::string& sections) {
  return cell_text(sections +
                   "objects:\n  - {name: a, sphere: {radius: 1}}\n  - {name: b, sphere: {radius: "
                   "1}}\npairs: [{between: [a, b]}]\n");
}

TEST(CommandSettingsOfACell, AreOffUnlessTheCellNamesClients) {
  const Cell cell = read_good(with(""));
  EXPECT_EQ(cell.commands, CommandSettings{});
  EXPECT_TRUE(cell.commands.from.empty());
  EXPECT_EQ(cell.questions, QuestionSettings{});
  EXPECT_TRUE(cell.questions.from.empty());
  EXPECT_EQ(cell.capacity, AddedCapacity{});
}

TEST(CommandSettingsOfACell, NameClientsThatAskAndTheWorkForThem) {
  const Cell cell = read_good(
      with("questions: {from: [planner, pendant], threads: 2, queue: 3, work_limit: 5000}\n"));
  EXPECT_EQ(cell.questions,
            (QuestionSettings{
                .from = {"planner", "pendant"}, .threads = 2, .queue = 3, .work_limit = 5000}));
  EXPECT_EQ(read_good(with("questions: {from: [a]}\n")).questions, QuestionSettings{.from = {"a"}});
}

TEST(CommandSettingsOfACell, NameClientsAndFoldersBesideTheCell) {
  const Cell cell =
      read_good(with("commands: {from: [planner, operator], folders: [meshes, ../b, /c/./d]}\n"),
                "/x/y/cell.yaml");
  EXPECT_THAT(cell.commands.from, testing::ElementsAre("planner", "operator"));
  EXPECT_THAT(cell.commands.folders, testing::ElementsAre("/x/y/meshes", "/x/b", "/c/d"));
}

TEST(CommandSettingsOfACell, StateWhatMayBeAdded) {
  const Cell cell = read_good(with("capacity: {objects: 3, parts: 0, pairs: 10, bytes: 1000}\n"));
  EXPECT_EQ(cell.capacity, (AddedCapacity{.objects = 3, .parts = 0, .pairs = 10, .bytes = 1000}));
  EXPECT_EQ(read_good(with("capacity: {pairs: 1}\n")).capacity, AddedCapacity{.pairs = 1});
}

TEST(CommandSettingsOfACell, AreRefusedWithTheirPlace) {
  EXPECT_THAT(errors_of(with("commands: {folders: [x]}\n")), mistake_at("4:11", "from"));
  EXPECT_THAT(errors_of(with("commands: {from: [a, a]}\n")), mistake_at("4:22", "twice"));
  EXPECT_THAT(errors_of(with("commands: {from: ['" + std::string(33, 'n') + "']}\n")),
              mistake_at("4:19", "33 bytes"));
  EXPECT_THAT(errors_of(with("commands: {from: planner}\n")), mistake_at("4:18", "list"));
  EXPECT_THAT(errors_of(with("commands: {from: [a], folders: ['']}\n")),
              mistake_at("4:33", "empty"));
  EXPECT_THAT(errors_of(with("commands: {from: [a], folder: [b]}\n")),
              mistake_at("4:23", "folders"));
  EXPECT_THAT(errors_of(with("questions: {threads: 2}\n")), mistake_at("4:12", "from"));
  EXPECT_THAT(errors_of(with("questions: {from: [a], threads: 0}\n")), mistake_at("4:33"));
  EXPECT_THAT(errors_of(with("questions: {from: [a], work_limit: no}\n")), mistake_at("4:36"));
  EXPECT_THAT(errors_of(with("questions: {from: [a], qeue: 1}\n")), mistake_at("4:24", "queue"));
  EXPECT_THAT(errors_of(with("capacity: {objects: -1}\n")), mistake_at("4:21"));
  EXPECT_THAT(errors_of(with("capacity: {pair: 5}\n")), mistake_at("4:12", "pairs"));
}

}  // namespace
}  // namespace clearance
