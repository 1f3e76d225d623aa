// Commands of several clients that come at once, or faster than they can be done.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

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
    end();
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

}  // namespace
}  // namespace clearance
