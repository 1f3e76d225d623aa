// Two daemons that are partners, as a client meets them: processes that are killed, stopped and
// started again while a source sends poses.
//
// The long campaign: CLEARANCE_KILLS=1000 tools_tests --gtest_filter='Partners.Random*'
// Another seed, and another rate in Hz: CLEARANCE_KILLS_SEED=7 CLEARANCE_KILLS_RATE=1000
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/replay/recordings_difference.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/meeting_boxes.hpp"

namespace clearance {
namespace {

using client::PartnerState;
using std::chrono::milliseconds;
using test::ChildProcess;
using test::kDaemon;

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

std::string cell_at_rate() {
  std::string text = test::meeting_cell();
  const std::string rate = "rate_hz: 200";
  return text.replace(text.find(rate), rate.size(),
                      "rate_hz: " + std::to_string(number_of("CLEARANCE_KILLS_RATE", 200)));
}

class Partners : public testing::Test {
 protected:
  DdsOptions dds = test::own_dds();
  test::CellFile file{cell_at_rate()};
  Cell cell = file.cell();
  test::SendingRobot robot{dds, cell};
  client::Connection connection{dds, cell.topics};
  // Both partners at 1 kHz write two thousand reports a second, and the start of a process takes
  // this one some milliseconds.
  client::Reports reports{connection, {.depth = 1024}};
  client::Catalogue catalogue{connection};
  client::Pair boxes{catalogue, "left", "right"};
  std::map<std::string, std::unique_ptr<ChildProcess>> daemons;
  std::uint64_t cycle = 0, last = 0, lineage = 0, came = 0, again = 0;

  ChildProcess& start(const std::string& name, const std::vector<std::string>& more = {}) {
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon, test::with(test::with({file.path()}, test::dds_arguments(dds)),
                            test::with({"--partner", name}, more)));
    return *daemons[name];
  }
  // Reads on until this is so. No cycle may be missing. One may come again only from a partner that
  // had other inputs when it was left alone.
  template <class IsSo>
  bool read_until(const IsSo& is_so, int seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (reports.next(milliseconds(100))) note();
      if (is_so()) return true;
    }
    return false;
  }
  void note() {
    const clearance_msg_PairDistance* const pair = boxes.in(*reports);
    if (pair != nullptr && pair->swept_lower < 0.3) inside = true;
    if (pair != nullptr && pair->swept_lower > 0.35) inside = false;
    if (pair != nullptr && (pair->swept_lower < 0.3) != was_inside) {
      was_inside = !was_inside;
      ++zone_changes;
    }
    // Partners that were alone for a moment count alike if the machine keeps the rate. Otherwise
    // the time between their reports tells what is missing.
    if (reports->lineage == lineage || cycle == 0) {
      EXPECT_EQ(reports.check().missed, 0u) << "cycles are missing";
    } else if (cell.scene.rate_hz <= 200.0 && !count_apart) {
      EXPECT_LE(reports->cycle, cycle + 1) << "cycles are missing";
    } else {
      lost += reports.check().missed;
    }
    longest_ns = std::max(longest_ns, cycle == 0 ? 0 : reports->now_ns - now_ns);
    now_ns = reports->now_ns;
    if (reports->cycle <= last) {
      EXPECT_NE(reports->lineage, lineage) << "a cycle came again";
    }
    again += static_cast<std::uint64_t>(reports->cycle <= cycle);
    last = reports->cycle;
    lineage = reports->lineage;
    cycle = std::max(cycle, reports->cycle);
    ++came;
    states[reports.partner().state]++;
  }
  bool agree() {
    states.clear();
    return read_until([this] { return states[PartnerState::kAgrees] > 20; });
  }
  std::string logs() {
    std::string text;
    for (const auto& [name, daemon] : daemons) text += "== " + name + "\n" + daemon->output();
    return text;
  }

  std::map<PartnerState, int> states;
  std::uint64_t lost = 0;
  bool count_apart =
      false;  // a change of the cell parts them, and a busy machine may tick late then
  std::int64_t now_ns = 0, longest_ns = 0;  // of the last report; between two reports
  bool inside = false, was_inside = false;  // the zone by the reports that came
  int zone_changes = 0;
};

// One of the two, whichever it is, is killed or stopped again and again. No cycle is missing in the
// merged stream, and the zone is as the reports say. Gradients come from the leader alone: the
// longest gap in them after the end of a leader is the time of its succession.
TEST_F(Partners, RandomKillsLoseNoCycleAndForgetNoZone) {
  const std::uint64_t kills = number_of("CLEARANCE_KILLS", 4);
  Random random(number_of("CLEARANCE_KILLS_SEED", 34));
  client::Zones zones(connection);
  client::Gradients simple(connection);
  client::Health health(connection);
  const std::array<std::string, 2> names = {"left", "right"};
  start("left", {"--gradients"});
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right", {"--gradients"});
  std::vector<double> takeovers_ms, phases_us;
  for (std::uint64_t kill = 0; kill < kills && !HasFailure(); ++kill) {
    ASSERT_TRUE(agree()) << logs();
    health.update();
    if (health.message() != nullptr)
      phases_us.push_back(1e-3 * std::abs(static_cast<double>(health.message()->partner.phase_ns)));
    EXPECT_EQ(states[PartnerState::kDifferent] + states[PartnerState::kCorrupt], 0) << logs();
    const auto zone_is_right = [&] {
      zones.update();
      return zones.states().contains(0) && zones.states().at(0).active == inside;
    };
    EXPECT_TRUE(read_until(zone_is_right, 5)) << logs();
    const bool leads_simple = read_until([&] { return simple.newest(); }, 5);
    EXPECT_TRUE(leads_simple) << logs();
    const std::uint64_t leader = simple->daemon;
    const std::string& victim = names[random.next() % 2];
    const bool stops = random.chance(0.4);
    std::int64_t last_ns = dds_time();
    daemons[victim]->signal(stops ? SIGSTOP : SIGKILL);
    const double stop_s = random.uniform(0.02, 0.4);
    // Until the leader's topics go on: either it was not the leader, or the other one leads.
    bool is_succeeded = false;
    const auto goes_on = [&] {
      if (!simple.newest()) return false;
      is_succeeded = simple->daemon != leader;
      return dds_time() - last_ns > 60'000'000 && (is_succeeded || simple->cycle + 3 > cycle);
    };
    std::int64_t first_ns = 0;
    EXPECT_TRUE(read_until(
        [&] {
          const bool on = goes_on();
          if (is_succeeded && first_ns == 0) first_ns = dds_time();
          return on;
        },
        10))
        << logs();
    if (first_ns != 0) takeovers_ms.push_back(1e-6 * static_cast<double>(first_ns - last_ns));
    states.clear();
    const std::int64_t begin = dds_time();
    read_until([&] { return dds_time() - begin > static_cast<std::int64_t>(1e9 * stop_s); });
    if (stops) {
      daemons[victim]->signal(SIGCONT);
    } else {
      start(victim, {"--gradients"});
    }
  }
  EXPECT_TRUE(agree()) << logs();
  EXPECT_GT(zone_changes, 0);
  const auto at = [](std::vector<double>& values, double share) {
    std::ranges::sort(values);
    return values.empty()
               ? 0.0
               : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf(
      "%llu kills and stops, %llu reports in one stream, %llu of them with a number that came "
      "before, at most %.1f ms apart, %llu periods lost between partners; %zu successions of the "
      "leader: p50 %.1f "
      "ms, p99.9 %.1f ms; reports of the two apart by p50 %.0f us\n",
      static_cast<unsigned long long>(kills), static_cast<unsigned long long>(came),
      static_cast<unsigned long long>(again), 1e-6 * static_cast<double>(longest_ns),
      static_cast<unsigned long long>(lost), takeovers_ms.size(), at(takeovers_ms, 0.5),
      at(takeovers_ms, 0.999), at(phases_us, 0.5));
}

TEST_F(Partners, OneStreamGoesOnWhileOneOfThemIsKilledAndComesBack) {
  start("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  for (const char* name : {"left", "right"}) {
    SCOPED_TRACE(name);
    daemons[name]->signal(SIGKILL);
    states.clear();
    EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 20; })) << logs();
    start(name);
    EXPECT_TRUE(agree()) << logs();
  }
  EXPECT_EQ(states[PartnerState::kDifferent], 0);
  EXPECT_TRUE(daemons["left"]->told("partner-agrees", {"right"})) << logs();
  EXPECT_TRUE(daemons["right"]->told("partner-agrees", {"left"})) << logs();
  EXPECT_TRUE(daemons["left"]->told("partner-met", {"right"})) << logs();
}

// Both record from their starts. What each ticked before it joined, and while it was apart, rests
// on inputs of its own: it is left out, and all other cycles have the same bits.
TEST_F(Partners, RecordingsOfBothAgreeInAllCyclesThatTheyTickedTogether) {
  test::ScratchFolder folder;
  const std::string files[] = {(folder / "left.mcap").string(), (folder / "right.mcap").string()};
  start("left", {"--gradients", "--record", files[0]});
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right", {"--gradients", "--record", files[1]});
  ASSERT_TRUE(agree()) << logs();
  const std::uint64_t joined = cycle;
  for (const char* name : {"left", "right"}) {
    daemons[name]->signal(SIGSTOP);
    states.clear();
    EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 20; })) << logs();
    daemons[name]->signal(SIGCONT);
    EXPECT_TRUE(agree()) << logs();
  }
  const std::uint64_t ended = cycle;
  for (const auto& [name, daemon] : daemons) daemon->signal(SIGTERM);
  for (const auto& [name, daemon] : daemons) EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  const RecordingsDifference found = compare_recordings(files[0], files[1]);
  EXPECT_TRUE(found.is_same()) << found.error << found.what << " in cycle " << found.cycle;
  EXPECT_GT(found.first_cycle, 20u) << "the first one was alone in its first cycles";
  EXPECT_LE(found.first_cycle, joined);
  EXPECT_GE(found.last_cycle + 20, ended) << "one of them may have ended somewhat earlier";
  EXPECT_GT(found.compared, 60u);
  EXPECT_GE(found.left_out[0], 20u);
  EXPECT_GE(found.left_out[1], 1u) << "it ticks before it joins";
  ChildProcess tool(test::kReplay, {"compare", files[0], files[1]});
  EXPECT_EQ(tool.wait(), 0) << tool.output();
  EXPECT_TRUE(tool.wrote("no difference")) << tool.output();
  EXPECT_TRUE(tool.wrote("left out before the last of these: ")) << tool.output();
}

TEST_F(Partners, AStoppedLeaderIsMissedAndAgreesAgain) {
  start("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  daemons["left"]->signal(SIGSTOP);
  states.clear();
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 60; })) << logs();
  daemons["left"]->signal(SIGCONT);
  EXPECT_TRUE(agree()) << logs();
  EXPECT_TRUE(daemons["right"]->told("partner-missing", {"left"})) << logs();
}

TEST_F(Partners, AThirdOneAndADaemonThatIsNoneAreExcluded) {
  start("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  ChildProcess& third = start("third");
  EXPECT_TRUE(read_until([&] { return !third.running(); })) << logs();
  EXPECT_EQ(third.wait(), 4) << logs();
  ChildProcess single(kDaemon, test::with({file.path()}, test::dds_arguments(dds)));
  EXPECT_TRUE(read_until([&] { return !single.running(); })) << single.output();
  EXPECT_EQ(single.wait(), 4) << single.output();
  EXPECT_TRUE(agree()) << logs();
}

class CommandedPartners : public Partners {
 protected:
  CommandedPartners() { count_apart = true; }
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
  // Those of these revisions. A client is told busy, and makes another revision, if its change was
  // taken back.
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
};

TEST_F(CommandedPartners, BothHaveTheChangedCellWhenAClientIsToldThatItIsDone) {
  start_both();
  std::vector<std::uint64_t> done;
  std::atomic<bool> ended{false};
  std::thread sending([&] {
    send("planner", 30, done);
    ended = true;
  });
  EXPECT_TRUE(read_until([&] { return ended.load(); }, 60)) << logs();
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
  std::atomic<int> ended{0};
  const auto begin = [&](const char* name, std::vector<std::uint64_t>& to) {
    return std::thread([&, name] {
      send(name, 20, to);
      ++ended;
    });
  };
  std::thread one = begin("planner", done[0]), other = begin("operator", done[1]);
  EXPECT_TRUE(read_until([&] { return ended == 2; }, 60)) << logs();
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
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 20; })) << logs();
  EXPECT_EQ(reports->scene_revision, done.back()) << logs();
  send("operator", 1, done);
  EXPECT_TRUE(read_until([&] { return reports->scene_revision == done.back(); })) << logs();
}

}  // namespace
}  // namespace clearance
