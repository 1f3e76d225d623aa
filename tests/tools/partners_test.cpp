// Two daemons that are partners, as a client meets them: processes that are killed, stopped and
// started again while a source sends poses.
//
// The long campaign: CLEARANCE_KILLS=1000 tools_tests --gtest_filter='Partners.Random*'
// Another seed, and another rate in Hz: CLEARANCE_KILLS_SEED=7 CLEARANCE_KILLS_RATE=1000
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "monitor/replay/recordings_difference.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_partners.hpp"

namespace clearance {
namespace {

using client::PartnerState;
using std::chrono::milliseconds;
using test::cell_at_rate;
using test::ChildProcess;
using test::kDaemon;
using test::number_of;
using test::Partners;

// One of the two, whichever it is, is killed or stopped again and again. No cycle is missing in the
// merged stream, and the zone is as the reports say. Gradients come from the leader alone: the
// longest gap in them after the end of a leader is the time of its succession. The fixture holds
// against a plain reader that never two write them at once.
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
    // Notices that waited for more than a second say nothing of the delay any more.
    const double stop_s = random.chance(0.1) ? random.uniform(1.0, 1.6) : random.uniform(0.02, 0.4);
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
  const test::OneLeader::Found simple_reader = leaders.found();
  EXPECT_GT(simple_reader.samples, 100u);
  const auto at = [](std::vector<double>& values, double share) {
    std::ranges::sort(values);
    return values.empty()
               ? 0.0
               : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf(
      "%llu kills and stops, %llu reports in one stream, %llu of them with a number that came "
      "before, at most %.1f ms apart, %llu periods lost between partners; %zu successions of the "
      "leader: p50 %.1f ms, p99.9 %.1f ms; reports of the two apart by p50 %.0f us; a plain reader "
      "saw %zu gradients, %d changes of the leader, %d of them soon, %d too soon, %d old "
      "samples\n%s",
      static_cast<unsigned long long>(kills), static_cast<unsigned long long>(came),
      static_cast<unsigned long long>(again), 1e-6 * static_cast<double>(longest_ns),
      static_cast<unsigned long long>(lost), takeovers_ms.size(), at(takeovers_ms, 0.5),
      at(takeovers_ms, 0.999), at(phases_us, 0.5), simple_reader.samples, simple_reader.successions,
      simple_reader.soon, simple_reader.faults, simple_reader.old, simple_reader.text.c_str());
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
  EXPECT_TRUE(daemons["left"]->tells("partner-agrees", {"right"})) << logs();
  EXPECT_TRUE(daemons["right"]->tells("partner-agrees", {"left"})) << logs();
  EXPECT_TRUE(daemons["left"]->tells("partner-met", {"right"})) << logs();
}

// Two cells that differ in the names of their daemons only.
TEST_F(Partners, MayBeNamedByTheirCells) {
  const auto text = [](const std::string& name) {
    return cell_at_rate() + "partner: " + name + "\n";
  };
  const test::CellFile left(text("left")), right(text("right"));
  ASSERT_EQ(left.cell().scene.revision, cell.scene.revision);
  const auto begin = [&](const std::string& name, const test::CellFile& of,
                         const std::vector<std::string>& more = {}) {
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon, test::with(test::with({of.path()}, test::dds_arguments(dds)), more));
  };
  begin("left", left);
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  begin("right", right);
  EXPECT_TRUE(agree()) << logs();
  EXPECT_TRUE(daemons["left"]->tells("partner-agrees", {"right"})) << logs();
  daemons["right"]->signal(SIGTERM);
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 20; })) << logs();
  begin("other", left, {"--partner", "other"});
  EXPECT_TRUE(agree()) << logs() << "the option overrides the cell";
  EXPECT_TRUE(daemons["left"]->tells("partner-met", {"other"})) << logs();
}

// Both record from their starts. What each ticked before it joined, and while it was apart, rests
// on inputs of its own: it is left out, and all other cycles have the same bits. Each recording
// replays to the same bits throughout, since it holds the states that its daemon took over.
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
  for (const std::string& recording : files) {
    SCOPED_TRACE(recording);
    ChildProcess check(test::kReplay, {"check", recording, "--compare"});
    EXPECT_EQ(check.wait(), 0) << check.output();
  }
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
  EXPECT_TRUE(daemons["right"]->tells("partner-missing", {"left"})) << logs();
}

// Each of them ends with status 4 and the cause, and the others go on as before.
TEST_F(Partners, AThirdOneOneOfTheSameNameAndADaemonThatIsNoneAreExcluded) {
  const auto is_excluded = [&](const std::vector<std::string>& more) {
    ChildProcess extra(kDaemon,
                       test::with(test::with({file.path()}, test::dds_arguments(dds)), more));
    ASSERT_TRUE(read_until([&] { return !extra.running(); })) << extra.output() << logs();
    EXPECT_EQ(extra.wait(), 4) << extra.output();
    EXPECT_TRUE(extra.tells("other-daemon-first")) << extra.output();
    for (const auto& [name, daemon] : daemons) EXPECT_TRUE(daemon->running()) << logs();
  };
  start("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  {
    SCOPED_TRACE("the only partner's name");
    is_excluded({"--partner", "left"});
  }
  start("right");
  ASSERT_TRUE(agree()) << logs();
  for (const char* name : {"left", "right", "third"}) {
    SCOPED_TRACE(name);
    is_excluded({"--partner", name});
    EXPECT_TRUE(agree()) << logs();
  }
  SCOPED_TRACE("no partner");
  is_excluded({});
  EXPECT_TRUE(agree()) << logs();
  EXPECT_TRUE(daemons["left"]->tells("other-daemon-later")) << logs();
}

}  // namespace
}  // namespace clearance
