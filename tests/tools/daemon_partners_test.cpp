// Two daemons that are partners, as a client meets them: processes that are killed, stopped and
// started again while a source sends poses.
//
// The long campaign: CLEARANCE_KILLS=1000 tools_tests --gtest_filter='Partners.Random*'
// Another seed: CLEARANCE_KILLS_SEED=7
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include "monitor/client/client.hpp"
#include "tests/shared/random.hpp"
#include "tests/tools/lossy_network.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using client::PartnerState;
using std::chrono::milliseconds;
using test::ChildProcess;
using test::eventually;
using test::kDaemon;

// Sends poses in a thread of its own, as a robot does.
class Robot {
 public:
  Robot(const DdsOptions& dds, const Cell& cell) : participant_(dds), poses_(participant_, cell) {
    thread_ = std::thread([this] {
      const std::int64_t began = dds_time();
      while (!stop_) {
        poses_.send(1e-9 * static_cast<double>(dds_time() - began));
        std::this_thread::sleep_for(milliseconds(5));
      }
    });
  }
  ~Robot() {
    stop_ = true;
    thread_.join();
  }

 private:
  Participant participant_;
  test::Poses poses_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// The two boxes come so near to each other, again and again, that the zone is active for a while.
std::string meeting_cell() {
  std::string text = test::small_cell("pair");
  const std::string apart = "[0.1, 0.2, 0]";
  return text.replace(text.find(apart), apart.size(), "[0.35, 0, 0]");
}

class Partners : public testing::Test {
 protected:
  DdsOptions dds = test::own_dds();
  test::CellFile file{meeting_cell()};
  Cell cell = file.cell();
  Robot robot{dds, cell};
  client::Connection connection{dds, cell.topics};
  client::Reports reports{connection};
  std::map<std::string, std::unique_ptr<ChildProcess>> daemons;
  std::uint64_t cycle = 0, came = 0;

  ChildProcess& start(const std::string& name, const std::vector<std::string>& more = {}) {
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon, test::with(test::with({file.path()}, test::dds_arguments(dds)),
                            test::with({"--partner", name}, more)));
    return *daemons[name];
  }
  // Reads on until this is so. No cycle may be missing, nor come twice.
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
    const clearance_msg_PairDistance* const pair = client::find(*reports, 2);
    if (pair != nullptr && pair->swept_lower < 0.3) inside = true;
    if (pair != nullptr && pair->swept_lower > 0.35) inside = false;
    if (pair != nullptr && (pair->swept_lower < 0.3) != was_inside) {
      was_inside = !was_inside;
      ++zone_changes;
    }
    if (cycle != 0) {
      EXPECT_EQ(reports->cycle, cycle + 1);
      EXPECT_FALSE(reports.check().other_daemon);
    }
    cycle = reports->cycle;
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
  bool inside = false, was_inside = false;  // the zone by the reports that came
  int zone_changes = 0;
};

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

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
  std::vector<double> takeovers_ms;
  std::uint64_t other_inputs = 0;
  for (std::uint64_t kill = 0; kill < kills && !HasFailure(); ++kill) {
    ASSERT_TRUE(agree()) << logs();
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
    other_inputs += static_cast<std::uint64_t>(states[PartnerState::kOtherInputs]);
  }
  EXPECT_TRUE(agree()) << logs();
  EXPECT_GT(zone_changes, 0);
  if (takeovers_ms.empty()) return;
  std::ranges::sort(takeovers_ms);
  const auto at = [&](double share) {
    return takeovers_ms[static_cast<std::size_t>(share * (takeovers_ms.size() - 1))];
  };
  std::printf(
      "%llu kills and stops, %llu reports in one stream; %zu successions of the leader: p50 %.1f "
      "ms, p99.9 %.1f ms\n",
      static_cast<unsigned long long>(kills), static_cast<unsigned long long>(came),
      takeovers_ms.size(), at(0.5), at(0.999));
}

// A link that is cut leaves a leader in each half. Of the two, one follows when it is whole again.
TEST(PartnersOnANetwork, BothHalvesOfACutGoOnAndAgreeAfterwards) {
  test::NetworkNamespace one(1), other(2);
  for (const auto* machine : {&one, &other}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(one.frames(), other.frames());
  const test::CellFile file(meeting_cell());
  const Cell cell = file.cell();
  DdsOptions dds = test::own_dds();
  const auto arguments = test::with(test::with({file.path()}, test::dds_arguments(dds)),
                                    {"--interface", "eth0", "--partner"});
  dds.interface = "eth0";
  std::optional<ChildProcess> left, right;
  std::optional<Robot> robot;
  one.run([&] {
    robot.emplace(dds, cell);
    left.emplace(kDaemon, test::with(arguments, {"left"}));
  });
  ASSERT_TRUE(eventually([&] { return left->told("partner-stands", {"leading"}); }));
  other.run([&] { right.emplace(kDaemon, test::with(arguments, {"right"})); });
  const auto agreements = [](const ChildProcess& daemon) {
    const std::string text = daemon.output();
    int count = 0;
    for (std::size_t at = 0; (at = text.find("[partner-agrees]", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  ASSERT_TRUE(eventually([&] { return agreements(*left) > 0 && agreements(*right) > 0; }))
      << left->output() << right->output();
  wire.lose(1.0);
  ASSERT_TRUE(eventually([&] { return right->told("partner-stands", {"leading"}); }))
      << right->output();
  const int before = agreements(*right);
  wire.lose(0.0);
  EXPECT_TRUE(eventually([&] { return agreements(*right) > before; }))
      << left->output() << right->output();
  for (auto* daemon : {&*left, &*right}) {
    daemon->signal(SIGTERM);
    EXPECT_EQ(daemon->wait(), 0) << daemon->output();
    EXPECT_FALSE(daemon->told("partner-differs")) << daemon->output();
  }
  one.run([&] { robot.reset(); });
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
  EXPECT_EQ(start("third").wait(), 4) << logs();
  ChildProcess single(kDaemon, test::with({file.path()}, test::dds_arguments(dds)));
  EXPECT_EQ(single.wait(), 4) << single.output();
  EXPECT_TRUE(agree()) << logs();
}

}  // namespace
}  // namespace clearance
