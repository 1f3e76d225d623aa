// Two partners that read the same camera, as a client meets them: processes that are killed and
// started again while the camera sends.
//
// Oracle: the closed form of the distance to a wall, whose depth each frame changes.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "monitor/client/client.hpp"
#include "tests/shared/ros_camera.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using client::PartnerState;
using std::chrono::milliseconds;
using test::ChildProcess;
using test::kDaemon;

// A ball that is fixed 1 m below the camera, in a zone of what the camera sees.
std::string cell_text(int age_limit_ms) {
  return R"(name: camera_partners
units: {length: m, angle: rad}
rate_hz: 200
objects: [{name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 0, 2]}}]
sensors:
  - {name: eye, depth_image: /cam/image, size: [65, 49], depth_error: {constant: 0.002}, range: [0.3, 4],
     age_limit_ms: )" +
         std::to_string(age_limit_ms) +
         R"(, mount: {pose: {xyz: [0, 0, 3], rpy: [3.141592653589793, 0, 0]}}}
pairs: [{between: [ball, eye], publish: true}]
zones: [{name: near, between: [ball, eye], enter_below: 0.3, leave_above: 0.35}]
)";
}

// Sends a frame every 25 ms, of a wall that is 2 to 2.4 m away.
class SendingCamera {
 public:
  explicit SendingCamera(const DdsOptions& dds) : participant_(dds), camera_(participant_, {}) {
    thread_ = std::thread([this] {
      for (int i = 0; !stop_; ++i) {
        camera_.send_image({.wall = 2.0 + 0.01 * (i % 40), .ball = {}});
        std::this_thread::sleep_for(milliseconds(25));
      }
    });
  }
  ~SendingCamera() { stop(); }
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  Participant participant_;
  test::RosCamera camera_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class CameraPartners : public testing::Test {
 protected:
  explicit CameraPartners(int age_limit_ms = 10'000) : file(cell_text(age_limit_ms)) {}

  DdsOptions dds = test::own_dds();
  test::CellFile file;
  Cell cell = file.cell();
  SendingCamera camera{dds};
  client::Connection connection{dds, cell.topics};
  client::Reports reports{connection, {.depth = 1024}};
  client::Catalogue catalogue{connection};
  client::Pair seen{catalogue, "ball", "eye"};
  client::Zones zones{connection};
  std::map<std::string, std::unique_ptr<ChildProcess>> daemons;
  std::map<PartnerState, int> states;
  std::set<double> distances;
  bool is_known = false, is_clear = false, may_be_lost = false;

  void start(const std::string& name, const std::vector<std::string>& more = {}) {
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon, test::with(test::with({file.path()}, test::dds_arguments(dds)),
                            test::with({"--partner", name}, more)));
  }
  template <class IsSo>
  bool read_until(const IsSo& is_so, int seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (reports.next(milliseconds(100))) note();
      if (is_so()) return true;
    }
    return false;
  }
  // After a frame has come, the camera is never unknown again, and no distance is wrong.
  void note() {
    states[reports.partner().state]++;
    const clearance_msg_PairDistance* const pair = seen.in(*reports);
    if (pair == nullptr) return;
    const bool known_now = pair->status != static_cast<std::uint8_t>(PairStatus::kUnknown);
    if (is_known && !may_be_lost) {
      EXPECT_TRUE(known_now) << "at cycle " << reports->cycle << logs();
    }
    is_known = is_known || known_now;
    if (!known_now) return;
    zones.update();
    const bool is_active = zones.states().contains(0) && zones.states().at(0).active;
    if (is_clear && !may_be_lost) {
      EXPECT_FALSE(is_active) << "at cycle " << reports->cycle << logs();
    }
    is_clear = is_clear || (zones.states().contains(0) && !is_active);
    distances.insert(pair->distance);
    EXPECT_LE(pair->lower, 2.39 - 0.002 - 1.0 - 0.1 + 1e-6);
    EXPECT_GE(pair->upper, 2.0 - 0.002 - 1.0 - 0.1 - 1e-6);
  }
  bool agree() {
    states.clear();
    return read_until([this] { return states[PartnerState::kAgrees] > 100; });
  }
  void expect_no_fault() {
    EXPECT_EQ(states[PartnerState::kDifferent] + states[PartnerState::kCorrupt], 0) << logs();
  }
  std::string logs() {
    std::string text;
    for (const auto& [name, daemon] : daemons) text += "\n== " + name + "\n" + daemon->output();
    return text;
  }
};

TEST_F(CameraPartners, AgreeOnEachFrameAndKeepTheCameraThroughKillsAndJoins) {
  start("left");
  ASSERT_TRUE(read_until([this] { return is_known; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  expect_no_fault();
  distances.clear();
  ASSERT_TRUE(agree()) << logs();
  EXPECT_GT(distances.size(), 5u) << "frames go on while both agree";
  for (const std::string victim : {"left", "right", "left"}) {
    daemons[victim]->signal(SIGKILL);
    distances.clear();
    EXPECT_TRUE(read_until([this] { return distances.size() > 5; }))
        << "it reads on alone" << logs();
    start(victim);
    ASSERT_TRUE(agree()) << logs();
    expect_no_fault();
  }
  EXPECT_TRUE(is_clear) << "the zone was clear all the time, also while one joined";
}

// The state that one of them joins with rests on a frame: either it has shown that one already, or
// its recording has it with the tick of the join.
TEST_F(CameraPartners, HaveRecordingsThatReplayToTheSameBits) {
  const test::ScratchFolder folder;
  std::map<std::string, std::string> recordings;
  for (const char* name : {"left", "right"})
    recordings[name] = (folder / (std::string(name) + ".mcap")).string();
  start("left", {"--record", recordings["left"]});
  ASSERT_TRUE(read_until([this] { return is_known; })) << logs();
  start("right", {"--record", recordings["right"]});
  ASSERT_TRUE(agree()) << logs();
  for (const char* name : {"right", "left"}) {
    daemons[name]->signal(SIGSTOP);
    states.clear();
    EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 300; })) << logs();
    daemons[name]->signal(SIGCONT);
    ASSERT_TRUE(agree()) << logs();
  }
  for (const auto& [name, daemon] : daemons) daemon->signal(SIGTERM);
  for (const auto& [name, recording] : recordings) {
    SCOPED_TRACE(name);
    EXPECT_EQ(daemons[name]->wait(), 0) << daemons[name]->output();
    EXPECT_FALSE(daemons[name]->wrote(clearance::name(Reject::kFuture)))
        << "its time goes on from that of the leader" << logs();
    ChildProcess check(test::kReplay, {"check", recording, "--compare"});
    EXPECT_EQ(check.wait(), 0) << check.output();
  }
}

class DeadCameraPartners : public CameraPartners {
 protected:
  DeadCameraPartners() : CameraPartners(500) {}
};

// The daemon that is left built its last frame of what the other one had sent.
TEST_F(DeadCameraPartners, AreJoinedByADaemonThatIsStartedAgain) {
  may_be_lost = true;
  start("left");
  ASSERT_TRUE(read_until([this] { return is_known; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  camera.stop();
  daemons["left"]->signal(SIGKILL);
  std::this_thread::sleep_for(milliseconds(200));
  start("left");
  ASSERT_TRUE(agree()) << logs();
  expect_no_fault();
}

}  // namespace
}  // namespace clearance
