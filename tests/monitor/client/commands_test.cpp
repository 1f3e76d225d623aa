// Commands of the client library over real DDS. The test plays the daemon.
#include "monitor/client/commands.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "tests/monitor/client/answering_daemon.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

using std::chrono::milliseconds;
using Seconds = std::chrono::seconds;
using test::AnsweringDaemon;

CommandResult done(const Command& command) {
  return {.client = command.client,
          .request = command.request,
          .scene_revision = 9,
          .in_force_from = 44};
}

const std::vector<CellChange> kAttach{Attach{.object = "part", .to = "hand"}};

TEST(ClientCommands, GetTheResultOfTheirRequestAndNoOther) {
  const DdsOptions dds = test::own_dds();
  AnsweringDaemon daemon(dds, [](const Command& command) {
    EXPECT_EQ(command.client, "planner");
    EXPECT_EQ(command.scene_revision, 5u);
    EXPECT_TRUE(command.dry_run);
    EXPECT_EQ(command.files.at(0).bytes, "solid");
    EXPECT_EQ(std::get<Attach>(command.changes.at(0)).to, "hand");
    CommandResult other = done(command), earlier = done(command);
    other.client = "pendant";
    other.scene_revision = 1;
    earlier.request -= 1;
    earlier.scene_revision = 2;
    return std::vector{other, earlier, done(command)};
  });
  client::Connection connection(dds);
  client::Commands commands(connection, "planner");
  const auto result = commands.send(
      kAttach, {.scene_revision = 5, .dry_run = true, .files = {{"part.stl", "solid"}}},
      Seconds(20));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->done());
  EXPECT_EQ(result->scene_revision, 9u);
  EXPECT_EQ(result->in_force_from, 44u);
}

TEST(ClientCommands, SendTheSameRequestAgainUntilAResultComes) {
  const DdsOptions dds = test::own_dds();
  std::vector<std::uint64_t> requests;
  AnsweringDaemon daemon(dds, [&](const Command& command) {
    requests.push_back(command.request);
    if (requests.size() == 1) return std::vector<CommandResult>{};  // lost
    CommandResult result = done(command);
    if (requests.size() == 2) result.status = CommandStatus::kBusy;
    return std::vector{result};
  });
  client::Connection connection(dds);
  client::Commands commands(connection, "planner");
  const auto result = commands.send(kAttach, {}, Seconds(30));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->done());
  ASSERT_GE(requests.size(), 3u);
  EXPECT_EQ(requests[0], requests[1]);
  EXPECT_EQ(requests[0], requests[2]);
}

TEST(ClientCommands, CountUpAcrossPrograms) {
  const DdsOptions dds = test::own_dds();
  AnsweringDaemon daemon(dds, [](const Command& command) { return std::vector{done(command)}; });
  std::uint64_t before = 0;
  for (int program = 0; program < 3; ++program) {
    client::Connection connection(dds);
    client::Commands commands(connection, "planner");
    for (int i = 0; i < 3; ++i) {
      const auto result = commands.send(kAttach, {}, Seconds(20));
      ASSERT_TRUE(result);
      EXPECT_GT(result->request, before);
      before = result->request;
    }
  }
}

TEST(ClientCommands, PostedOnesGetTheirResultsLater) {
  const DdsOptions dds = test::own_dds();
  AnsweringDaemon daemon(dds, [](const Command& command) { return std::vector{done(command)}; });
  client::Connection connection(dds);
  client::Commands commands(connection, "planner");
  ASSERT_TRUE(test::eventually([&] { return commands.is_heard(); }));
  const std::uint64_t first = commands.post(kAttach), second = commands.post(kAttach);
  EXPECT_LT(first, second);
  ASSERT_TRUE(commands.result(second, Seconds(20)));
  EXPECT_EQ(commands.result(first).value().request, first);
  EXPECT_FALSE(commands.result(second + 1));
}

TEST(ClientCommands, WithoutADaemonGiveUpAfterTheTimeout) {
  client::Connection connection(test::own_dds());
  client::Commands commands(connection, "planner");
  EXPECT_FALSE(commands.is_heard());
  EXPECT_FALSE(commands.send(kAttach, {}, milliseconds(50)));
}

TEST(ClientCommands, StopWaitingForADaemonWhenTheCallerSaysSo) {
  client::Connection connection(test::own_dds());
  client::Commands commands(connection, "planner");
  int asked = 0;
  EXPECT_FALSE(commands.send(kAttach, {.stop = [&] { return ++asked == 3; }}, Seconds(600)));
  EXPECT_EQ(asked, 3);
}

TEST(ClientCommands, StopWaitingForAResultWhenTheCallerSaysSo) {
  const DdsOptions dds = test::own_dds();
  std::atomic<bool> came = false;
  AnsweringDaemon daemon(dds, [&](const Command&) {
    came = true;
    return std::vector<CommandResult>{};
  });
  client::Connection connection(dds);
  client::Commands commands(connection, "planner");
  EXPECT_FALSE(commands.send(kAttach, {.stop = [&] { return came.load(); }}, Seconds(600)));
  EXPECT_TRUE(came);
}

TEST(ClientCommands, RefuseANameThatNoCellCanHave) {
  client::Connection connection(test::own_dds());
  EXPECT_THROW(client::Commands(connection, ""), std::invalid_argument);
  EXPECT_THROW(client::Commands(connection, std::string(33, 'x')), std::invalid_argument);
}

}  // namespace
}  // namespace clearance
