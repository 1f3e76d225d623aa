// A camera on a network that loses packets. A frame of which a fragment is lost does not come at
// all, and what the others show stays true.
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>

#include "monitor/files/reader.hpp"
#include "monitor/intake/camera_messages.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/shared/ros_camera.hpp"
#include "tests/tools/camera_daemon.hpp"
#include "tests/tools/lossy_network.hpp"

namespace clearance::test {
namespace {

constexpr double kWall = 2.5;                              // m, from the camera
constexpr double kExact = kWall - kError - 1.0 - kRadius;  // m, of the ball 1 m below it
constexpr std::int64_t kFrameNs = 33'333'333, kStartNs = 700'000'000, kLossNs = 3'000'000'000;

TEST(CameraOnALossyNetwork, GivesWholeFramesOrNone) {
  NetworkNamespace robot(1), computer(2);
  for (const auto* machine : {&robot, &computer}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  LossyWire wire(robot.frames(), computer.frames());
  const CellFile file(
      "name: cameras\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
      "objects: [{name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 0, 2]}}]\n"
      "sensors: [{name: eye, depth_image: /cam/image, size: [320, 240], "
      "depth_error: {constant: 0.002}, range: [0.3, 4]" +
      kAbove + "}]\npairs: [{between: [ball, eye]}]\n");
  const Cell cell = file.cell();
  DdsOptions dds = own_dds();
  const ScratchFolder folder;
  const std::string recording = folder / "run.mcap";
  std::optional<ChildProcess> daemon;
  computer.run([&] {
    daemon.emplace(kDaemon, with(with({file.path()}, dds_arguments(dds)),
                                 {"--interface", "eth0", "--record", recording, "--force"}));
  });
  dds.interface = "eth0";
  std::optional<Participant> participant;
  robot.run([&] { participant.emplace(dds); });
  std::int64_t sent = 0, begin_ns = 0;
  {
    RosCamera camera(*participant, {.width = 320, .height = 240, .focal = 300.0});
    ASSERT_TRUE(camera.is_heard());
    std::int64_t next_ns = dds_time();
    const std::int64_t start_ns = next_ns;
    for (; next_ns < start_ns + kStartNs + kLossNs; next_ns += kFrameNs) {
      if (begin_ns == 0 && next_ns > start_ns + kStartNs) {
        wire.lose(0.003);  // an image has more than a hundred fragments
        begin_ns = next_ns;
      }
      camera.send_image({.wall = kWall, .ball = {}}, dds_time());
      sent += begin_ns != 0 ? 1 : 0;
      dds_sleepfor(std::max<std::int64_t>(0, next_ns + kFrameNs - dds_time()));
    }
  }
  wire.lose(0.0);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  robot.run([&] { participant.reset(); });
  // What comes is whole. Only a CameraInfo may be late or lost, which every image needs.
  for (std::size_t fault = 1; fault < kFrameFaults; ++fault) {
    const auto cause = static_cast<FrameFault>(fault);
    if (cause == FrameFault::kNoCameraInfo) continue;
    EXPECT_FALSE(daemon->told("refused", {name(cause)})) << daemon->output();
  }

  McapReader reader(recording);
  McapMessage message;
  CdrDecoder decoder;
  Sample<clearance_msg_Distances> report;
  std::set<std::int64_t> used;  // stamps
  while (reader.next(message)) {
    if (message.channel->topic != cell.topics.distances) continue;
    if (!decoder.decode(message.payload, report)) continue;
    if (report->oldest_pose_ns > begin_ns) used.insert(report->oldest_pose_ns);
    for (std::uint32_t i = 0; i < report->pairs._length; ++i) {
      const clearance_msg_PairDistance& pair = report->pairs._buffer[i];
      if (pair.status >= static_cast<std::uint8_t>(PairStatus::kStale)) continue;
      EXPECT_LE(pair.lower, kExact + 1e-9);
      EXPECT_GE(pair.upper, kExact - 1e-9);
    }
  }
  const auto came = static_cast<std::int64_t>(used.size());
  EXPECT_GT(came, sent / 10) << "of " << sent << " frames\n" << daemon->output();
  EXPECT_LT(came, sent) << "none was lost";
}

}  // namespace
}  // namespace clearance::test
