// Commands to a running daemon, over real DDS: what they change, and what each fault of a client
// does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/shared/poses.hpp"
#include "tests/tools/commanding_client.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

std::string commanded_cell(const std::string& name) {
  std::string text = small_cell(name);
  const std::string objects = "objects:\n";
  text.insert(text.find(objects),
              "commands: {from: [planner, operator]}\n"
              "templates:\n  - {name: bin, groups: [still], box: {size: [0.1, 0.1, 0.1]}}\n");
  return text;
}

const CellChange kBin = AddFromTemplate{"bin", "bin_1", {}, at(0, 3, 3)};

class DaemonCommands : public testing::Test {
 protected:
  void start(const std::vector<std::string>& more = {}) {
    daemon.emplace(kDaemon, with(with({cell.path()}, dds_arguments(dds)), more));
    distances.settle();
    ASSERT_TRUE(meets_writers_of(participant, *daemon)) << daemon->output();
    robot.send(0.0);
  }
  std::unique_ptr<CommandingClient> client(const std::string& name) {
    auto made = std::make_unique<CommandingClient>(participant, name);
    made->meet();
    EXPECT_TRUE(meets_writers_of(participant, *daemon)) << daemon->output();
    return made;
  }
  // The first report of this cycle or a later one.
  std::unique_ptr<Sample<clearance_msg_Distances>> report_from(std::uint64_t cycle) {
    for (int i = 0; i < 10'000; ++i) {
      auto report = distances.next();
      if (report == nullptr || (*report)->cycle >= cycle) return report;
    }
    return nullptr;
  }
  // The log has a line about a refusal with this status, name or field.
  testing::AssertionResult logged_refusal(const std::vector<std::string>& names) {
    if (daemon->tells("command-refused", names)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << daemon->output();
  }
  // No cycle is missing among the reports that come in this time.
  void expect_every_cycle(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    std::uint64_t cycle = 0;
    while (std::chrono::steady_clock::now() < end) {
      const auto report = distances.next();
      ASSERT_NE(report, nullptr);
      ASSERT_TRUE(cycle == 0 || (*report)->cycle == cycle + 1) << cycle;
      cycle = (*report)->cycle;
    }
  }

  CellFile cell{commanded_cell("commands")};
  Cell read = cell.cell();
  DdsOptions dds = own_dds();
  Participant participant{dds};
  Distances distances{participant, read};
  Poses robot{participant, read};
  std::optional<ChildProcess> daemon;
};

TEST_F(DaemonCommands, ChangeTheSceneFromTheCycleOfTheirResult) {
  start();
  const auto planner = client("planner");
  const CommandResult result = planner->result_of({kBin});
  ASSERT_TRUE(result.done()) << result.reason;
  const auto report = report_from(result.in_force_from);
  ASSERT_NE(report, nullptr);
  EXPECT_EQ((*report)->cycle, result.in_force_from);
  EXPECT_EQ((*report)->scene_revision, result.scene_revision);
  EXPECT_EQ((*report)->pairs._length, 5u) << "two more with the bin";
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  EXPECT_TRUE(eventually([&] {
    catalogue.update();
    return catalogue.revision() == result.scene_revision;
  }));
  EXPECT_TRUE(catalogue.object("bin_1"));
}

TEST_F(DaemonCommands, AttachAndDetachWhereTheObjectIs) {
  start();
  const auto planner = client("planner");
  ASSERT_TRUE(planner->result_of({AddFromTemplate{"bin", "bin_1", {}, at(-0.5, 0, 4)}}).done());
  robot.send(0.0);
  const CommandResult attached =
      planner->result_of({Attach{.object = "bin_1", .to = "left", .far = true}});
  ASSERT_TRUE(attached.done()) << attached.reason;
  robot.send(0.1);
  const CommandResult detached = planner->result_of({Detach{"bin_1"}});
  ASSERT_TRUE(detached.done()) << detached.reason;
}

// Kinds whose fields lie at the same places of the union: texts, numbers, lists.
TEST_F(DaemonCommands, OfDifferentKindsInTurnAreReadByThemselves) {
  start();
  const auto planner = client("planner");
  ASSERT_TRUE(planner->result_of({kBin}).done());
  for (int i = 0; i < 100; ++i) {
    const std::vector<std::vector<CellChange>> lists = {
        {Attach{"bin_1", "left", at(0, 0, 1), {"right"}, std::nullopt, true},
         SetMargin{"floor", 0.1}},
        {Detach{"bin_1", at(0, 3, 3)}, SetPair{"bin_1", "left", SetPair::Rule::kPublish}},
        {SetPair{"bin_1", "left", SetPair::Rule::kUnstated}, SetZoneThresholds{"near", 0.3, 0.4}},
        {Place{"bin_1", at(0, 4, 3)}, SetMaxSpeed{"left", 4.0}, SetSource{"left", std::nullopt}}};
    for (const auto& list : lists) {
      const CommandResult result = planner->result_of(list);
      ASSERT_TRUE(result.done()) << i << ": " << result.path << result.reason;
    }
  }
}

TEST_F(DaemonCommands, AreOffWithoutAClientThatIsNamed) {
  write_text(cell.path(), small_cell("commands"));
  start();
  const dds_entity_t writer = participant.writer(TopicKind::kCommands, Topics{}.commands);
  const dds_entity_t reader =
      participant.reader(TopicKind::kCommandResults, Topics{}.command_results);
  // The daemon is known by now, as its reports come.
  for (int i = 0; i < 100; ++i) ASSERT_NE(distances.next(), nullptr);
  EXPECT_EQ(matched_readers(writer), 0u);
  EXPECT_EQ(matched_writers(reader), 0u);
}

TEST_F(DaemonCommands, OfAClientOnTheCommandLineAreTakenToo) {
  start({"--commands", "tool", "--gradients"});
  const auto tool = client("tool");
  EXPECT_TRUE(tool->result_of({kBin}).done());
  EXPECT_TRUE(tool->result_of({RemoveObject{"bin_1"}}).done());
}

TEST_F(DaemonCommands, SentTwiceAreDoneOnceAndAnsweredTwice) {
  start();
  const auto planner = client("planner");
  const Command command = planner->command({kBin});
  const CommandResult first = planner->result_of(command);
  ASSERT_TRUE(first.done()) << first.reason;
  planner->forget();
  const CommandResult second = planner->result_of(command);
  EXPECT_EQ(second.status, CommandStatus::kDone) << "a second bin_1 would be refused";
  EXPECT_EQ(second.in_force_from, first.in_force_from);
  EXPECT_EQ(second.scene_revision, first.scene_revision);
}

TEST_F(DaemonCommands, OutOfOrderOrWithAnotherContentAreRefused) {
  start();
  const auto planner = client("planner");
  Command later = planner->command({kBin});
  later.request = 10;
  ASSERT_TRUE(planner->result_of(later).done());
  Command earlier = planner->command({RemoveObject{"bin_1"}});
  earlier.request = 9;
  EXPECT_EQ(planner->result_of(earlier).status, CommandStatus::kOutOfOrder);
  EXPECT_TRUE(logged_refusal({"planner", "out-of-order"}));
  planner->forget();
  earlier.request = 10;
  EXPECT_EQ(planner->result_of(earlier).status, CommandStatus::kOtherContent);
  EXPECT_TRUE(logged_refusal({"planner", "other-content"}));
}

TEST_F(DaemonCommands, OfAClientThatIsNotNamedAreRefused) {
  start();
  const auto stranger = client("stranger");
  const CommandResult result = stranger->result_of({kBin});
  EXPECT_EQ(result.status, CommandStatus::kNotNamed);
  EXPECT_EQ(result.scene_revision, read.scene.revision);
  EXPECT_TRUE(logged_refusal({"stranger", "not-named"}));
}

TEST_F(DaemonCommands, OfTwoProgramsUnderOneNameAreRefusedUntilOneHasLeft) {
  start();
  const auto first = client("planner"), second = client("planner");
  ASSERT_TRUE(first->result_of({SetMargin{"floor", 0.01}}).done());
  Command other = second->command({SetMargin{"floor", 0.02}});
  other.request = 2;
  EXPECT_EQ(second->result_of(other).status, CommandStatus::kTwoWriters);
  EXPECT_EQ(first->result_of({SetMargin{"floor", 0.03}}).status, CommandStatus::kTwoWriters);
  EXPECT_TRUE(logged_refusal({"planner", "two-writers"}));
  first->leave();
  EXPECT_TRUE(eventually([&] {
    second->forget();
    return second->result_of(other).done();
  }));
}

// The lease distinguishes the killed run from one that lives. Without that, the name would be
// taken for longer than clearance-scene tries. The lease is the process's: a client that is idle
// for as long keeps its name.
TEST_F(DaemonCommands,
       OfAProgramThatStartsAgainAfterItWasKilledAreDoneAndOneThatIsIdleKeepsItsName) {
  start();
  client::Connection one(dds), two(dds);
  client::Commands idle(one, "operator"), other(two, "operator");
  ASSERT_TRUE(idle.send({SetMargin{"floor", 0.02}})->done());
  const ScratchFolder folder;
  const std::string margin = (folder / "margin.yaml").string();
  const std::string back = (folder / "back.yaml").string();
  write_text(margin, "- set_margin: {object: floor, margin: 0.01}\n");
  write_text(back, "- set_margin: {object: floor}\n");
  const std::vector<std::string> send =
      with({"send", margin, "--as", "planner", "--cell", cell.path()}, dds_arguments(dds));
  ChildProcess former(kScene, with(send, {"--back", back, "--repeat", "1000000"}));
  std::set<std::uint64_t> revisions;
  ASSERT_TRUE(eventually([&] {
    const auto report = distances.next();
    if (report != nullptr) revisions.insert((*report)->scene_revision);
    return revisions.size() > 2;
  })) << former.output();
  former.signal(SIGKILL);
  former.wait();
  ChildProcess again(kScene, send);
  EXPECT_EQ(again.wait(), 0) << again.output();
  const auto result = other.send({SetMargin{"floor", 0.02}}, {}, std::chrono::milliseconds(900));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, CommandStatus::kTwoWriters);
}

TEST_F(DaemonCommands, MalformedOnesAreRefusedByTheirField) {
  start();
  const auto planner = client("planner");
  const CommandResult result =
      planner->result_of({SetMargin{"floor", 0.01}, SetMargin{"floor", std::nan("")}});
  EXPECT_EQ(result.status, CommandStatus::kMalformed);
  EXPECT_EQ(result.change, 1u);
  EXPECT_EQ(result.path, "changes[1].set_margin.m");
  EXPECT_TRUE(logged_refusal({"planner", "malformed", "changes[1].set_margin.m"}));
}

// Both know the first scene. The second command to come would change one that its client does not
// know.
TEST_F(DaemonCommands, OfTwoClientsThatKnowOneRevisionIsOneDone) {
  start();
  const auto planner = client("planner"), other = client("operator");
  Command first = planner->command({kBin}), second = other->command({SetMargin{"floor", 0.01}});
  first.scene_revision = second.scene_revision = read.scene.revision;
  planner->send(first);
  other->send(second);
  const std::array results = {planner->result_of(first).status, other->result_of(second).status};
  EXPECT_THAT(results,
              testing::UnorderedElementsAre(CommandStatus::kDone, CommandStatus::kOtherRevision));
  EXPECT_TRUE(logged_refusal({"other-revision"}));
}

// The message is cut off behind the client's name, in the middle and in its last byte. Cyclone
// drops it.
TEST_F(DaemonCommands, ThatAreCutOffAreCountedAndTheNextOneIsDone) {
  start();
  const auto planner = client("planner");
  const Command command = planner->command({kBin});
  CdrEncoder encoder;
  const auto whole = encoder.encode(*to_wire(command));
  client::Connection connection(dds);
  client::Health health(connection);
  std::uint64_t sent = 0;
  for (const std::size_t size : {std::size_t{16}, whole.size() / 2, whole.size() - 8}) {
    ByteWriter cut(participant, dds.partition, clearance_msg_Command_desc, Topics{}.commands,
                   {whole.begin(), whole.begin() + static_cast<long>(size)});
    ASSERT_TRUE(cut.is_heard() && meets_writers_of(participant, *daemon));
    cut.send();
    ++sent;
    EXPECT_TRUE(eventually([&] {
      health.update();
      return health.message() != nullptr && health.message()->undecodable_samples == sent;
    })) << size
        << daemon->output();
  }
  EXPECT_TRUE(daemon->tells("undecodable")) << daemon->output();
  EXPECT_EQ(planner->find(command.request), nullptr);
  const CommandResult result = planner->result_of(command);
  EXPECT_TRUE(result.done()) << result.reason;
}

// Two clients: one removes what the other attaches, at the same time. Whichever comes first is
// done, and the scene is that of one of the two orders.
TEST_F(DaemonCommands, ThatNameWhatIsJustBeingRemovedAreRefusedOrDoneBefore) {
  start();
  const auto planner = client("planner"), other = client("operator");
  for (int i = 0; i < 20; ++i) {
    robot.send(0.0);
    ASSERT_TRUE(planner->result_of({kBin}).done());
    const Command remove = planner->command({RemoveObject{"bin_1"}});
    const Command attach = other->command(
        {Attach{"bin_1", "left", at(0, 0, 1), {}, std::nullopt, true}, SetAbsent{"bin_1"}});
    planner->send(remove);
    other->send(attach);
    const CommandResult first = planner->result_of(remove), second = other->result_of(attach);
    ASSERT_TRUE(first.done()) << first.reason;
    EXPECT_TRUE(second.done() || second.status == CommandStatus::kRefused) << second.reason;
  }
  // Both wait in one queue, and the removal is the first in it.
  ASSERT_TRUE(planner->result_of({kBin}).done());
  const Command remove = planner->command({RemoveObject{"bin_1"}}),
                attach = planner->command(
                    {Attach{"bin_1", "left", at(0, 0, 1), {}, std::nullopt, true}});
  planner->send(remove);
  planner->send(attach);
  EXPECT_TRUE(planner->result_of(remove).done());
  EXPECT_EQ(planner->result_of(attach).status, CommandStatus::kRefused);
  EXPECT_TRUE(logged_refusal({"(refused)", "bin_1"}));
  EXPECT_TRUE(daemon->running());
}

// 2 s at 10 kHz. Each command is answered or refused as busy, and no report is missing.
TEST_F(DaemonCommands, AtTenKilohertzAreAnsweredOrRefusedAsBusyAndNoTickIsMissing) {
  start();
  const auto planner = client("planner");
  std::thread flood([&] {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 20'000; ++i) {
      planner->send(planner->command({SetMargin{"floor", 1e-6 * i}}));
      std::this_thread::sleep_until(begin + std::chrono::microseconds(100) * i);
    }
  });
  expect_every_cycle(std::chrono::milliseconds(2000));
  flood.join();
  const CommandResult last = planner->result_of({SetMargin{"floor", 0.5}});
  EXPECT_TRUE(last.done()) << last.reason;
  std::size_t done = 0;
  for (const CommandResult& result : planner->all()) {
    ASSERT_TRUE(result.done() || result.status == CommandStatus::kBusy) << result.reason;
    done += result.done() ? 1 : 0;
  }
  EXPECT_GT(done, 0u);
  EXPECT_TRUE(logged_refusal({"planner", "busy"}));
  EXPECT_TRUE(daemon->tells("commands-left-out")) << daemon->output();
  EXPECT_TRUE(eventually([&] { return planner->result_of({SetMargin{"floor", 0.6}}).done(); }));
}

TEST_F(DaemonCommands, ThatWereAcceptedAreResumedAfterAKill) {
  const ScratchFolder folder;
  const std::vector<std::string> keep = {"--keep-scene", (folder / "scene.yaml").string()};
  start(keep);
  CommandResult result;
  {
    const auto planner = client("planner");
    result = planner->result_of({kBin});
    ASSERT_TRUE(result.done()) << result.reason;
  }
  daemon->signal(SIGKILL);
  daemon->wait();
  start(keep);
  EXPECT_TRUE(eventually([&] {
    const auto report = distances.next();
    return report != nullptr && (*report)->scene_revision == result.scene_revision;
  }));
  EXPECT_TRUE(daemon->tells("scene-resumed", {"scene.yaml"})) << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  write_text(cell.path(), commanded_cell("commands") + "# changed\n");
  daemon.emplace(kDaemon, with(with({cell.path()}, dds_arguments(dds)), keep));
  EXPECT_EQ(daemon->wait(), 3) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("scene.yaml"));
}

TEST_F(DaemonCommands, WithoutAKeptSceneARestartedDaemonBeginsWithItsCell) {
  start();
  {
    const auto planner = client("planner");
    ASSERT_TRUE(planner->result_of({kBin}).done());
  }
  daemon->signal(SIGKILL);
  daemon->wait();
  start();
  EXPECT_TRUE(eventually([&] {
    const auto report = distances.next();
    return report != nullptr && (*report)->scene_revision == read.scene.revision;
  }));
}

}  // namespace
}  // namespace clearance::test
