// clearance-merge passes commands on to shares that do not all make them. The test plays the
// daemons of the shares, so that each answers as the test wants.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/share_topics.hpp"
#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "tests/monitor/client/answering_daemon.hpp"
#include "tests/tools/shared_cells.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t kNext = 9, kOther = 10;  // revisions of the changed scene

class RelayedCommands : public testing::Test {
 protected:
  RelayedCommands() {
    for (const Share& share : cell.shares.all) {
      ShareRelay& of = shares[share.name];
      daemons.emplace_back(
          dds,
          [&of](const Command& command) {
            ++(command.dry_run ? of.tried : of.asked);
            CommandResult result{
                .client = command.client, .request = command.request, .scene_revision = kNext};
            if (!of.answers(command, result)) return std::vector<CommandResult>{};
            return std::vector{result};
          },
          topics_of_share(cell.topics, share.name));
    }
  }
  // A change that every daemon could make.
  [[nodiscard]] CommandResult send(bool dry_run = false) {
    const auto result =
        commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}},
                      {.dry_run = dry_run}, std::chrono::seconds(40));
    EXPECT_TRUE(result) << merge.output();
    return result.value_or(CommandResult{});
  }
  void expect_no_share_was_asked() {
    for (const auto& [name, share] : shares) {
      EXPECT_GT(share.tried, 0) << name;
      EXPECT_EQ(share.asked, 0) << name;
    }
  }
  // The result says that some shares have changed, and others not.
  static void expect_part(const CommandResult& result, const std::string& cause) {
    EXPECT_EQ(result.status, CommandStatus::kFailed);
    EXPECT_THAT(result.reason, HasSubstr("'left floor': " + cause + ")"));
    EXPECT_THAT(result.reason, HasSubstr("'boxes', 'right floor' did"));
    EXPECT_EQ(result.in_force_from, 0u);
  }
  static void refuse(CommandResult& result) {
    result.status = CommandStatus::kRefused;
    result.change = 3;
    result.reason = "it has no room";
  }

  struct ShareRelay {
    std::atomic<int> tried{0}, asked{0};  // dry runs and others
    // Changes the result; false: it does not answer.
    std::function<bool(const Command&, CommandResult&)> answers = [](auto&, auto&) { return true; };
  };
  DdsOptions dds = test::own_dds();
  test::CellFile file{test::shared_cell("commands: {from: [planner]}\n")};
  Cell cell = file.cell();
  std::map<std::string, ShareRelay> shares;
  std::list<test::AnsweringDaemon> daemons;
  test::ChildProcess merge{test::kMerge, test::with({file.path()}, test::dds_arguments(dds))};
  client::Connection connection{dds, cell.topics};
  client::Commands commands{connection, "planner"};
};

TEST_F(RelayedCommands, ThatOneShareRefusesInTheDryRunHaveItsStatusAndChangeNone) {
  shares["left floor"].answers = [](const Command&, CommandResult& result) {
    refuse(result);
    return true;
  };
  const CommandResult result = send();
  EXPECT_EQ(result.status, CommandStatus::kRefused);
  EXPECT_EQ(result.change, 3u);
  EXPECT_THAT(result.reason, HasSubstr("'left floor'"));
  EXPECT_THAT(result.reason, HasSubstr("no share has changed: it has no room"));
  expect_no_share_was_asked();
}

// Each share counts the cycles of its own daemon.
TEST_F(RelayedCommands, ThatAllowAContactUpToACycleReachNoShare) {
  const AllowContact contact{.contact = "push",
                             .a = "a",
                             .b = "b",
                             .depth = 0.01,
                             .end = {.last_cycle = 900},
                             .by = "planner",
                             .reason = "it pushes"};
  const auto result =
      commands.send({SetMargin{.object = "a", .m = 0.01}, contact}, {}, std::chrono::seconds(40));
  ASSERT_TRUE(result) << merge.output();
  EXPECT_EQ(result->status, CommandStatus::kRefused);
  EXPECT_EQ(result->change, 1u);
  for (const auto& [name, share] : shares) EXPECT_EQ(share.tried + share.asked, 0) << name;
}

TEST_F(RelayedCommands, ThatWouldLeadToDifferentScenesChangeNone) {
  shares["right floor"].answers = [](const Command&, CommandResult& result) {
    result.scene_revision = kOther;
    return true;
  };
  for (const bool dry_run : {false, true}) {
    const CommandResult result = send(dry_run);
    EXPECT_EQ(result.status, CommandStatus::kFailed);
    EXPECT_THAT(result.reason, HasSubstr("'boxes' and 'right floor' would have different scenes"));
    EXPECT_THAT(result.reason, HasSubstr("no share has changed"));
    expect_no_share_was_asked();
  }
}

TEST_F(RelayedCommands, ThatOneShareRefusesAfterItsDryRunNameItAndThoseThatMadeIt) {
  shares["left floor"].answers = [](const Command& command, CommandResult& result) {
    if (!command.dry_run) refuse(result);
    return true;
  };
  expect_part(send(), "it has no room");
  for (const auto& [name, share] : shares) EXPECT_GE(share.asked, 1) << name;
}

TEST_F(RelayedCommands, ThatLeadToAnotherSceneThanTheDryRunNameTheShare) {
  shares["left floor"].answers = [](const Command& command, CommandResult& result) {
    if (!command.dry_run) result.scene_revision = kOther;
    return true;
  };
  expect_part(send(), "its scene is another one");
}

// The share is waited for, 10 s.
TEST_F(RelayedCommands, ThatOneShareDoesNotAnswerAfterItsDryRunNameIt) {
  shares["left floor"].answers = [](const Command& command, CommandResult&) {
    return command.dry_run;
  };
  expect_part(send(), "it did not answer");
  EXPECT_GT(shares["left floor"].asked, 1) << "it was asked again";
}

TEST_F(RelayedCommands, ThatNoShareMakesSayThatNoneDid) {
  for (auto& [name, share] : shares) {
    share.answers = [](const Command& command, CommandResult& result) {
      if (!command.dry_run) refuse(result);
      return true;
    };
  }
  const CommandResult result = send();
  EXPECT_EQ(result.status, CommandStatus::kFailed);
  for (const auto& [name, share] : shares)
    EXPECT_THAT(result.reason, HasSubstr("'" + name + "': it has no room"));
  EXPECT_THAT(result.reason, Not(HasSubstr(" did;")));
}

// The other results: all make it, and a dry run makes nothing.
TEST_F(RelayedCommands, ThatAllSharesMakeAreDone) {
  EXPECT_TRUE(send(true).done());
  expect_no_share_was_asked();
  const CommandResult result = send();
  EXPECT_TRUE(result.done()) << result.reason;
  EXPECT_EQ(result.scene_revision, kNext);
  EXPECT_EQ(result.in_force_from, 0u) << "no report of that scene has come";
}

}  // namespace
}  // namespace clearance
