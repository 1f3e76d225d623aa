// Commands to two daemons that are partners: the leader takes them, and both have the same cell.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "monitor/client/commands.hpp"
#include "monitor/client/questions.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/commanding_client.hpp"
#include "tests/tools/running_partners.hpp"

namespace clearance {
namespace {

using client::PartnerState;
using test::ChildProcess;
using test::kDaemon;
using test::Partners;

class CommandedPartners : public Partners {
 protected:
  explicit CommandedPartners(const std::string& text = test::cell_at_rate()) : Partners(text) {
    count_apart = true;
  }
  void start_both() {
    for (const char* name : {"left", "right"}) {
      start(name, kNamed);
      ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
    }
    ASSERT_TRUE(agree()) << logs();
  }
  static std::vector<CellChange> margin(int step) {
    return {SetMargin{"floor", 0.001 * (step + 1)}};
  }
  // Sends so many commands under this name, each by a client of its own: which daemon it meets
  // first is chance. Keeps the revisions that were told as done.
  void send(const std::string& name, int count, std::vector<std::uint64_t>& done) {
    for (int i = 0; i < count; ++i) {
      client::Connection own(dds, cell.topics);
      client::Commands commands(own, name);
      const auto result = commands.send(margin(number++), {}, std::chrono::seconds(20));
      ASSERT_TRUE(result) << name << ", " << i;
      ASSERT_TRUE(result->done()) << result->reason;
      EXPECT_EQ(result->reason, "");
      done.push_back(result->scene_revision);
    }
  }
  // The revisions that came in force in this daemon, by its log, each where it did so last: a
  // change is taken back and made again if the lead changes before the other daemon has it.
  std::vector<std::string> changes_of(const std::string& name) {
    static constexpr std::string_view kBefore = "the cell's revision ";
    std::vector<std::string> revisions;
    std::istringstream lines(daemons[name]->output());
    for (std::string line; std::getline(lines, line);) {
      const auto at = line.find(kBefore);
      if (line.find("[scene-changed]") == std::string::npos || at == std::string::npos) continue;
      const std::string revision = line.substr(at + kBefore.size(), 16);
      std::erase(revisions, revision);
      revisions.push_back(revision);
    }
    return revisions;
  }
  static std::string text_of(std::uint64_t revision) { return fmt::format("{:016x}", revision); }
  // Changes that led to one of these revisions. A client is told busy, and makes another revision,
  // if its change was taken back.
  std::vector<std::string> changes_of(const std::string& name,
                                      const std::vector<std::uint64_t>& told) {
    std::set<std::string> those;
    for (const std::uint64_t revision : told) those.insert(text_of(revision));
    auto changes = changes_of(name);
    std::erase_if(changes, [&](const std::string& each) { return !those.contains(each); });
    return changes;
  }
  bool have_in_force(std::uint64_t revision) {
    const std::string text = text_of(revision);
    return std::ranges::all_of(daemons, [&](const auto& each) {
      const auto changes = changes_of(each.first);
      return !changes.empty() && changes.back() == text;
    });
  }

  const std::vector<std::string> kNamed = {"--commands", "planner", "--commands", "operator"};
  std::atomic<int> number{0};
  std::atomic<bool> ended{false};
};

TEST_F(CommandedPartners, BothHaveTheChangedCellWhenAClientIsToldThatItIsDone) {
  start_both();
  std::vector<std::uint64_t> done;
  std::thread sending([&] {
    send("planner", 30, done);
    ended = true;
  });
  EXPECT_TRUE(read_until([&] { return ended.load(); }, 400)) << logs();
  sending.join();
  ASSERT_EQ(done.size(), 30u) << logs();
  EXPECT_TRUE(read_until([&] { return have_in_force(done.back()); })) << logs();
  EXPECT_EQ(changes_of("left", done), changes_of("right", done));
  EXPECT_TRUE(agree()) << logs();
  EXPECT_EQ(states[PartnerState::kDifferent] + states[PartnerState::kCorrupt], 0) << logs();
}

TEST_F(CommandedPartners, CommandsOfTwoClientsAtOnceAreDoneInOneOrderByBoth) {
  start_both();
  std::array<std::vector<std::uint64_t>, 2> done;
  std::atomic<int> threads_ended{0};
  const auto begin = [&](const char* name, std::vector<std::uint64_t>& to) {
    return std::thread([&, name] {
      send(name, 20, to);
      ++threads_ended;
    });
  };
  std::thread one = begin("planner", done[0]), other = begin("operator", done[1]);
  EXPECT_TRUE(read_until([&] { return threads_ended == 2; }, 60)) << logs();
  one.join();
  other.join();
  std::vector<std::uint64_t> told = done[0];
  told.insert(told.end(), done[1].begin(), done[1].end());
  ASSERT_EQ(told.size(), 40u) << logs();
  const auto same = [&] {
    const auto left = changes_of("left", told);
    return left.size() == told.size() && left == changes_of("right", told);
  };
  EXPECT_TRUE(read_until(same, 10)) << logs();
  EXPECT_TRUE(agree()) << logs();
}

TEST_F(CommandedPartners, ADaemonThatIsStartedAgainTakesTheChangedCellFromTheOtherOne) {
  start("left", kNamed);
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  std::vector<std::uint64_t> done;
  send("planner", 3, done);
  start("right", kNamed);
  EXPECT_TRUE(agree()) << logs();
  EXPECT_TRUE(have_in_force(done.back())) << logs();
}

TEST_F(CommandedPartners, AChangeThatAClientWasToldIsDoneOutlivesTheLeader) {
  start_both();
  std::vector<std::uint64_t> done;
  send("planner", 1, done);
  daemons["left"]->signal(SIGKILL);
  // Reports from before may still be read, some of which lack a partner that was held up.
  states.clear();
  EXPECT_TRUE(read_until([&] {
    return states[PartnerState::kMissing] > 20 && reports->scene_revision == done.back();
  })) << logs();
  send("operator", 1, done);
  EXPECT_TRUE(read_until([&] { return reports->scene_revision == done.back(); })) << logs();
}

// The client forgets the first answer, as if it was lost. A second crate of that name would be
// refused.
TEST_F(CommandedPartners, ACommandThatIsSentAgainToTheOtherOneIsAnsweredAndNotDoneAgain) {
  start_both();
  test::CommandingClient client(connection.participant(), "planner");
  client.meet();
  const Command command = client.command(
      {AddObject{"{name: crate, groups: [still], fixed: true, sphere: {radius: 0.1}}"}});
  const CommandResult done = client.result_of(command);
  ASSERT_TRUE(done.done()) << done.reason;
  daemons["left"]->signal(SIGKILL);
  daemons["left"]->wait();
  client.forget();
  const CommandResult second = client.result_of(command);
  EXPECT_TRUE(second.done()) << second.reason << logs();
  EXPECT_EQ(second.scene_revision, done.scene_revision);
  const CommandResult next = client.result_of(margin(3));
  EXPECT_TRUE(next.done()) << next.reason;
}

std::string cell_with_post() {
  std::string text = test::cell_at_rate();
  return text.insert(text.find("  - {name: floor"),
                     "  - {name: post, groups: [still], fixed: true, pose: {xyz: [0, 0, 0.2]}, "
                     "sphere: {radius: 0.1}}\n");
}

// Each daemon has a folder of its own, as on a machine of its own.
class PartnersInFolders : public CommandedPartners {
 protected:
  explicit PartnersInFolders(const std::string& text = cell_with_post()) : CommandedPartners(text) {
    for (const auto& [name, folder] : folders) test::write_text(folder / "cell.yaml", cell.yaml);
  }
  void begin(const std::string& name) {
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon,
        test::with(test::with({(folders[name] / "cell.yaml").string()}, test::dds_arguments(dds)),
                   {"--partner", name, "--commands", "planner", "--questions", "planner"}));
  }
  std::filesystem::path sent(const std::string& name) { return folders[name] / "clearance.sent"; }
  // Gives the post another mesh, which is sent along. A command that is done again, since the lead
  // changed, changes nothing more. A slow machine parts partners, and the lead changes each second.
  CommandResult give_mesh(const std::string& name) {
    client::Connection own(dds, cell.topics);
    client::Commands commands(own, "planner");
    const std::string mesh = name + ".obj";
    const auto result = commands.send(
        {ReplaceObject{"{name: post, groups: [still], fixed: true, pose: {xyz: [0, 0, 0.2]}, "
                       "mesh: {file: 'sent:" +
                       mesh + "'}}"}},
        {.files = {{mesh,
                    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 "
                    "4\nf 3 1 4\n# " +
                        name + "\n"}}},
        std::chrono::seconds(120));
    EXPECT_TRUE(result);
    return result.value_or(CommandResult{.status = CommandStatus::kFailed});
  }
  static std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  std::map<std::string, test::ScratchFolder> folders = [] {
    std::map<std::string, test::ScratchFolder> made;
    made.try_emplace("left");
    made.try_emplace("right");
    return made;
  }();
};

TEST_F(PartnersInFolders, BothKeepTheFilesThatCommandsSendAlong) {
  begin("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  begin("right");
  ASSERT_TRUE(agree()) << logs();
  std::uint64_t revision = 0;
  std::thread sending([&] {
    for (const char* name : {"one", "two", "three"}) {
      const CommandResult result = give_mesh(name);
      EXPECT_TRUE(result.done()) << result.reason;
      EXPECT_EQ(result.reason, "") << "the partner has it, too";
      revision = result.scene_revision;
    }
    ended = true;
  });
  EXPECT_TRUE(read_until([this] { return ended.load(); }, 400)) << logs();
  sending.join();
  EXPECT_EQ(names_in(sent("left")).size(), 3u);
  EXPECT_EQ(names_in(sent("left")), names_in(sent("right")));
  EXPECT_TRUE(agree()) << logs();
  daemons["left"]->signal(SIGKILL);
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 20; })) << logs();
  EXPECT_EQ(reports->scene_revision, revision) << logs();
}

// The command came before the second daemon was started.
TEST_F(PartnersInFolders, AFileThatIsMissingIsNamedAndTheyDoNotAgreeUntilItIsThere) {
  begin("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  ASSERT_TRUE(give_mesh("part").done()) << logs();
  const auto files = names_in(sent("left"));
  ASSERT_EQ(files.size(), 1u);
  begin("right");
  states.clear();
  const auto is_told = [&] { return daemons["right"]->told("partner-state-refused", {files[0]}); };
  EXPECT_TRUE(read_until(is_told)) << logs();
  read_until([] { return false; }, 2);
  EXPECT_EQ(states[PartnerState::kAgrees], 0) << logs();
  EXPECT_FALSE(daemons["left"]->told("partner-agrees")) << logs();
  std::filesystem::copy(sent("left"), sent("right"));
  EXPECT_TRUE(agree()) << logs();
}

// The arm slides along x, above the floor and to the post.
std::string cell_with_arm() {
  static const test::ScratchFolder folder;
  test::write_text(folder / "arm.urdf", R"(<robot name="slide">
  <link name="foot"/>
  <link name="hand"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><origin xyz="-2 0 1"/><parent link="foot"/><child link="hand"/><axis xyz="1 0 0"/><limit lower="0" upper="2" velocity="1"/></joint>
</robot>
)");
  std::string text = cell_with_post();
  text.insert(text.find("objects:"),
              "robots: [{name: slider, urdf: " + (folder / "arm.urdf").string() + "}]\n");
  const std::string pairs = "pairs:\n";
  return text.insert(text.find(pairs) + pairs.size(), "  - {between: [slider, post]}\n");
}

class AskedPartners : public PartnersInFolders {
 protected:
  AskedPartners() : PartnersInFolders(cell_with_arm()) {}
  // Asks so many times, each by a client of its own, and keeps the revisions of the answers.
  void ask(int count, std::set<std::uint64_t>& revisions) {
    Question question;
    question.motion = {
        .joints = {"slide"}, .times = {0.0, 1.0}, .positions = {0.0, 0.5}, .velocities = {}};
    for (int i = 0; i < count; ++i) {
      client::Connection own(dds, cell.topics);
      client::Questions questions(own, "planner");
      const auto result = questions.ask(question, {}, std::chrono::seconds(20));
      ASSERT_TRUE(result) << i << "\n" << logs();
      EXPECT_TRUE(result->done()) << result->reason;
      revisions.insert(result->scene_revision);
    }
  }
};

// The daemon was away during a command, and lacks a file of the changed cell. It still has the old
// cell, in which the motion may be free.
TEST_F(AskedPartners, AreNotAnsweredByADaemonWithTheOldCellThatWasStartedAgain) {
  begin("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  begin("right");
  ASSERT_TRUE(agree()) << logs();
  daemons["right"]->signal(SIGKILL);
  daemons["right"]->wait();
  const CommandResult changed = give_mesh("part");
  ASSERT_TRUE(changed.done()) << changed.reason;
  const dds_entity_t notices =
      connection.participant().reader(TopicKind::kPartnerTicks, cell.topics.partner_ticks, 256);
  std::set<std::uint64_t> leading;
  const auto look = [&] {
    Sample<clearance_msg_PartnerTick> tick;
    while (test::take_next(notices, tick)) leading.insert(tick->daemon);
    return ended.load();
  };
  begin("right");
  std::set<std::uint64_t> revisions;
  std::thread asking([&] {
    ask(5, revisions);
    ended = true;
  });
  EXPECT_TRUE(read_until(look, 60)) << logs();
  asking.join();
  if (leading.size() > 1) GTEST_SKIP() << "the leader stood still, and the other one took the lead";
  EXPECT_TRUE(daemons["right"]->tells("partner-state-refused")) << logs();
  EXPECT_EQ(revisions, std::set{changed.scene_revision}) << logs();
  daemons["left"]->signal(SIGKILL);
  daemons["left"]->wait();
  revisions.clear();
  std::thread asking_again([&] {
    ask(1, revisions);
    ended = false;
  });
  EXPECT_TRUE(read_until([this] { return !ended.load(); }, 400)) << logs();
  asking_again.join();
  EXPECT_EQ(revisions.size(), 1u) << "the one that is left answers\n" << logs();
}

}  // namespace
}  // namespace clearance
