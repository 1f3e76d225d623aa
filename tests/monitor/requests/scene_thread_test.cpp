// Commands of several clients that come at once, or faster than they can be done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "config/text/file_bytes.hpp"
#include "monitor/requests/scene_thread.hpp"
#include "tests/monitor/requests/commanded_cell.hpp"

namespace clearance {
namespace {

using test::at;

class SceneThreadTest : public test::CommandedCell {
 protected:
  ~SceneThreadTest() override { end_thread(); }
  void begin() {
    start();
    thread.emplace(*changer, *loop, loop_ended, CommanderOptions{});
    thread->start();
  }
  void end_thread() {
    end_loop();
    if (!thread) return;
    EXPECT_TRUE(thread->end());
    thread.reset();
  }
  // Keeps the result in `to`, and counts it.
  bool put(Command command, CommandResult& to) {
    return thread->put(
        GivenCommand{.command = std::move(command), .answer = [&](const CommandResult& result) {
                       to = result;
                       ++answered;
                     }});
  }
  void await(std::uint64_t count) const {
    while (answered < count) std::this_thread::yield();
  }
  std::optional<SceneThread> thread;
  std::atomic<std::uint64_t> answered{0};
};

TEST_F(SceneThreadTest, DoesOneOfTwoCommandsThatKnowTheSameScene) {
  begin();
  std::uint64_t known = revision();
  for (std::uint64_t round = 1; round <= 20; ++round) {
    std::array<CommandResult, 2> results;
    const auto send = [&](std::size_t client) {
      const double margin = 0.001 * static_cast<double>(2 * round + client);
      EXPECT_TRUE(put({.client = client == 0 ? "planner" : "operator",
                       .request = round,
                       .scene_revision = known,
                       .changes = {SetMargin{"table", margin}}},
                      results[client]));
    };
    std::thread other([&] { send(1); });
    send(0);
    other.join();
    await(2 * round);
    const bool first = results[0].done();
    EXPECT_TRUE(first || results[1].done());
    EXPECT_EQ(results[first ? 1 : 0].status, CommandStatus::kOtherRevision);
    EXPECT_EQ(results[0].scene_revision, results[1].scene_revision);
    known = results[0].scene_revision;
  }
}

TEST_F(SceneThreadTest, DoesACommandBeforeItsObjectIsRemovedOrRefusesIt) {
  begin();
  for (std::uint64_t round = 1; round <= 20; ++round) {
    CommandResult added, removed, named;
    ASSERT_TRUE(put({.changes = {AddFromTemplate{"bin", "bin_1", {}, at(0, 2, 0)}}}, added));
    std::thread other([&] { EXPECT_TRUE(put({.changes = {RemoveObject{"bin_1"}}}, removed)); });
    EXPECT_TRUE(put({.changes = {Place{"bin_1", at(0, 3, 0)}}}, named));
    other.join();
    await(3 * round);
    EXPECT_TRUE(added.done()) << added.reason;
    EXPECT_TRUE(removed.done()) << removed.reason;
    if (named.done()) continue;
    EXPECT_EQ(named.status, CommandStatus::kRefused);
    EXPECT_EQ(named.path, "objects");
  }
  end_thread();
  EXPECT_EQ(changer->cell().yaml, test::kCommandedCell);
}

// 10 kHz for 0.2 s.
TEST_F(SceneThreadTest, AnswersEachCommandThatItTookOnceHoweverFastTheyCome) {
  begin();
  constexpr std::size_t kCommands = 2000;
  std::vector<int> answers(kCommands);
  std::vector<std::size_t> order;
  std::size_t taken = 0;
  auto next = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < kCommands; ++i) {
    std::this_thread::sleep_until(next += std::chrono::microseconds(100));
    const double margin = i % 2 == 0 ? 0.01 : 0.02;
    const bool is_taken =
        thread->put(GivenCommand{.command = {.changes = {SetMargin{"table", margin}}},
                                 .answer = [&, i](const CommandResult& result) {
                                   EXPECT_TRUE(result.done()) << result.reason;
                                   ++answers[i];
                                   order.push_back(i);
                                   ++answered;
                                 }});
    if (!is_taken) --answers[i];
    taken += is_taken;
  }
  await(taken);
  end_thread();
  for (const int count : answers) EXPECT_TRUE(count == 1 || count == -1);
  EXPECT_EQ(order.size(), taken);
  EXPECT_TRUE(std::ranges::is_sorted(order));
  EXPECT_EQ(object("table").margin, order.back() % 2 == 0 ? 0.01 : 0.02);
}

// Splits of this mesh wait as long as this lives, as for another program that splits it.
class HeldMesh {
 public:
  explicit HeldMesh(const std::filesystem::path& file) : file_(open_to_read(file)) {
    EXPECT_EQ(::flock(file_, LOCK_EX), 0);
  }
  ~HeldMesh() { ::close(file_); }
  HeldMesh(const HeldMesh&) = delete;
  HeldMesh& operator=(const HeldMesh&) = delete;

 private:
  int file_;
};

constexpr const char* kObjTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(SceneThreadTest, CommandsOfOthersOvertakeOneWhoseMeshIsBeingRead) {
  begin();
  std::filesystem::create_directories(folder / "allowed");
  test::write_text(folder / "allowed" / "a.obj", kObjTetrahedron);
  auto held = std::make_unique<HeldMesh>(folder / "allowed" / "a.obj");
  std::vector<std::string> order;  // by the scene thread alone, until all have answered
  const auto put_named = [&](const std::string& name, Command command) {
    EXPECT_TRUE(thread->put(GivenCommand{.command = std::move(command),
                                         .answer = [&, name](const CommandResult& result) {
                                           order.push_back(result.done() ? name : result.reason);
                                           ++answered;
                                         }}));
  };
  put_named("mesh", {.client = "planner",
                     .request = 1,
                     .changes = {AddObject{"{name: m, groups: [things], fixed: true, pose: {xyz: "
                                           "[3, 0, 0]}, mesh: {file: allowed/a.obj}}"}}});
  put_named("after it", {.client = "planner", .request = 2, .changes = {SetMargin{"m", 0.01}}});
  put_named("other", {.client = "operator", .request = 1, .changes = {SetMargin{"table", 0.01}}});
  await(1);
  put_named("other again",
            {.client = "operator", .request = 2, .changes = {SetMargin{"table", 0.02}}});
  await(2);
  held.reset();
  await(4);
  EXPECT_EQ(order, (std::vector<std::string>{"other", "other again", "mesh", "after it"}));
}

// The daemon's own commands may name any file, and wait as others do.
TEST_F(SceneThreadTest, CommandsOfClientsOvertakeAnOwnOneWhoseMeshIsBeingRead) {
  begin();
  std::string text = test::kCommandedCell;
  text.insert(text.find("\npairs:") + 1,
              "  - {name: m, groups: [things], fixed: true, pose: {xyz: [3, 0, 0]}, mesh: {file: "
              "a.obj}}\n");
  test::write_text(folder / "a.obj", kObjTetrahedron);
  auto held = std::make_unique<HeldMesh>(folder / "a.obj");
  std::vector<std::string> order;  // by the scene thread alone, until all have answered
  const auto answer_as = [&](const std::string& name) {
    return [&, name](const CommandResult& result) {
      order.push_back(result.done() ? name : result.reason);
      ++answered;
    };
  };
  int put_off = 0;
  EXPECT_TRUE(thread->put(MadeCommand{
      .sender = "moveit",
      .put_off = [&] { ++put_off; },
      .make = [&](const Cell&, const AskPose&) { return Command{.changes = {ReplaceCell{text}}}; },
      .answer = answer_as("made")}));
  EXPECT_TRUE(
      thread->put(GivenCommand{.command = {.changes = {ReplaceCell{text}, SetMargin{"table", 0.5}}},
                               .is_own = true,
                               .answer = answer_as("own")}));
  EXPECT_TRUE(thread->put(GivenCommand{
      .command = {.client = "planner", .request = 1, .changes = {SetMargin{"table", 0.01}}},
      .answer = answer_as("client")}));
  await(1);
  EXPECT_EQ(answered, 1);
  held.reset();
  await(3);
  ASSERT_EQ(order.size(), 3u);
  EXPECT_EQ(order[0], "client");
  EXPECT_THAT(order, testing::UnorderedElementsAre("client", "made", "own"));
  EXPECT_EQ(put_off, 1);
  EXPECT_EQ(object("m").parts.size(), 1u);
}

// Mesh files of commands are refused as before, whoever reads them.
TEST_F(SceneThreadTest, AMeshThatIsNoneIsRefusedOnceItWasRead) {
  begin();
  std::filesystem::create_directories(folder / "allowed");
  test::write_text(folder / "allowed" / "b.obj", "no mesh");
  CommandResult missing, damaged, elsewhere, sent;
  const auto add = [](const char* file) {
    return AddObject{"{name: m, groups: [things], fixed: true, mesh: {file: " + std::string(file) +
                     "}}"};
  };
  put({.client = "planner", .request = 1, .changes = {add("allowed/none.obj")}}, missing);
  put({.client = "planner", .request = 2, .changes = {add("allowed/b.obj")}}, damaged);
  put({.client = "planner", .request = 3, .changes = {add("b.obj")}}, elsewhere);
  put({.client = "planner",
       .request = 4,
       .changes = {add("\"sent:c.obj\"")},
       .files = {{"c.obj", kObjTetrahedron}}},
      sent);
  await(4);
  EXPECT_TRUE(sent.done()) << sent.reason;
  EXPECT_EQ(missing.status, CommandStatus::kRefused) << missing.reason;
  EXPECT_EQ(damaged.status, CommandStatus::kRefused) << damaged.reason;
  EXPECT_EQ(elsewhere.status, CommandStatus::kFileRefused) << elsewhere.reason;
}

// As of MoveIt: the message is taken with the place that the hand has once it is known again.
TEST_F(SceneThreadTest, ACommandThatDependsOnALatePoseWaitsForItAndOthersDoNot) {
  std::string text = test::kCommandedCell;
  text.replace(text.find("age_limit_ms: 60000"), 19, "age_limit_ms: 20");
  start(text);
  poses->put(at(0.5, 0, 0));
  poses->settle();
  poses->repeat(0);
  const auto hand = [&] {
    return (*present_poses({"hand"}, cell->scene, *loop, loop_ended)).at("hand").state;
  };
  while (hand() != PresentPose::State::kLate) std::this_thread::yield();
  thread.emplace(*changer, *loop, loop_ended, CommanderOptions{});
  thread->start();
  std::vector<std::string> order;
  int put_off = 0;
  const auto answer_as = [&](const char* name) {
    return [&, name](const CommandResult& result) {
      order.push_back(result.done() ? name : result.reason);
      ++answered;
    };
  };
  const auto make = [](const Cell&, const AskPose& pose) {
    const auto place = pose("hand");
    EXPECT_TRUE(place);
    return Command{.changes = {Place{"part", place ? *place : Pose{}}}};
  };
  const auto later = [](const Cell&, const AskPose&) {
    return Command{.changes = {SetMargin{"part", 0.01}}};
  };
  EXPECT_TRUE(thread->put(MadeCommand{.sender = "moveit",
                                      .put_off = [&] { ++put_off; },
                                      .make = make,
                                      .answer = answer_as("placed")}));
  EXPECT_TRUE(
      thread->put(MadeCommand{.sender = "moveit", .make = later, .answer = answer_as("after it")}));
  EXPECT_TRUE(thread->put(GivenCommand{
      .command = {.client = "planner", .request = 1, .changes = {SetMargin{"table", 0.01}}},
      .answer = answer_as("other")}));
  await(1);
  poses->put(at(0.7, 0, 0));
  poses->repeat(1);
  await(3);
  EXPECT_EQ(order, (std::vector<std::string>{"other", "placed", "after it"}));
  EXPECT_GE(put_off, 1);
  EXPECT_EQ(object("part").world_from_object.position, Vec3(0.7, 0, 0));
}

}  // namespace
}  // namespace clearance
