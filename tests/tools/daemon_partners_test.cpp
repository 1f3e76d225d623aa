// Two daemons that are partners, as a client meets them: processes that are killed, stopped and
// started again while a source sends poses.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <map>
#include <optional>
#include <thread>

#include "monitor/client/client.hpp"
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
      for (double t = 0.0; !stop_; t += 0.005) {
        poses_.send(t);
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

class Partners : public testing::Test {
 protected:
  DdsOptions dds = test::own_dds();
  test::CellFile file{test::small_cell("pair")};
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
};

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
