// What a camera does wrong is refused by its cause and named, and nothing becomes clear by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "monitor/intake/camera_messages.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/tools/camera_daemon.hpp"

namespace clearance::test {
namespace {

using Image = sensor_msgs_msg_dds__Image_;

class CameraFaults : public DaemonCameras {
 protected:
  // Returns true once the log has named each of these causes. `step` is called until then.
  bool names_all(const std::function<void()>& step, const std::vector<FrameFault>& faults) {
    return step_until(kPeriodMs, step, [&] {
      // What the last good frame has shown is the most that is ever clear.
      if (is_measured()) {
        EXPECT_LE(ball_pair().lower, kExact + 1e-9);
      }
      return std::ranges::all_of(faults, [&](FrameFault fault) {
        return daemon->told("refused", {"eye", name(fault)});
      });
    });
  }
  static constexpr double kExact = 2.5 - kError - 1.0 - kRadius;
  // Farther than the wall of all good frames: it would make the ball clearer.
  MadeScene farther{.wall = 3.2, .ball = {}};
};

TEST_F(CameraFaults, OfImagesAreRefusedByCause) {
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
  struct Case {
    FrameFault fault;
    std::function<void(Image&)> change;
  };
  const auto text = [](char*& into, const char* value) {
    dds_string_free(into);
    into = dds_string_dup(value);
  };
  const std::vector<Case> cases = {
      {FrameFault::kEncoding, [&](Image& image) { text(image.encoding, "rgb8"); }},
      {FrameFault::kByteOrder, [](Image& image) { image.is_bigendian ^= 1; }},
      {FrameFault::kNoPixels, [](Image& image) { image.height = 0; }},
      {FrameFault::kTooManyPixels, [](Image& image) { image.width = image.height = 0xFFFFFFFF; }},
      {FrameFault::kStep, [](Image& image) { image.step = 0; }},
      {FrameFault::kShortData, [](Image& image) { image.data._length /= 2; }},
      {FrameFault::kSizeChanged, [](Image& image) { image.width = 33; }},
      {FrameFault::kNoStamp,
       [](Image& image) {
         image.header.stamp = {0, 0};
       }},
      {FrameFault::kOtherClock, [](Image& image) { image.header.stamp.sec -= 3600; }},
      {FrameFault::kOldStamp, [](Image& image) { image.header.stamp.sec -= 5; }},
      {FrameFault::kNothingSeen,
       [](Image& image) { std::memset(image.data._buffer, 0xFF, image.data._length); }},
  };
  std::vector<FrameFault> faults;
  for (const Case& each : cases) faults.push_back(each.fault);
  std::size_t next = 0;
  const auto step = [&] {
    camera.change_image = cases[next++ % cases.size()].change;
    camera.send_image(farther);
    camera.change_image = {};
    camera.send_image(scene_of_wall);
  };
  EXPECT_TRUE(names_all(step, faults)) << daemon->output();
  EXPECT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
}

TEST_F(CameraFaults, OfFrozenImagesAndOtherPublishersAndCamerasAreRefusedByCause) {
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
  Participant other{dds};
  RosCamera second(other, {});
  ASSERT_TRUE(second.is_heard());
  // The second one takes over where a busy machine holds the first one up for half a second.
  const MadeScene nearer{.wall = 2.3, .ball = {}};
  const auto two = [&] {
    camera.send_image(scene_of_wall);
    second.send_image(nearer);
  };
  EXPECT_TRUE(names_all(two, {FrameFault::kSecondPublisher})) << daemon->output();
  camera.is_frozen = true;
  const auto frozen = [&] { camera.send_image(scene_of_wall); };
  EXPECT_TRUE(names_all(frozen, {FrameFault::kFrozen})) << daemon->output();
  EXPECT_TRUE(step_until(kPeriodMs, frozen, [&] { return is("ball", PairStatus::kUnknown); }))
      << "the stamp in use is that of the first one";
  EXPECT_TRUE(step_until(kPeriodMs, frozen, told("frames-late", {"eye"}))) << daemon->output();
  camera.is_frozen = false;
  EXPECT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, told("frames-back", {"eye"})))
      << daemon->output();
  camera.made.focal = 61.0;
  // An image that comes before its CameraInfo is taken with the one before.
  EXPECT_TRUE(
      names_all([&] { camera.send_image(scene_of_wall); }, {FrameFault::kCameraInfoChanged}))
      << daemon->output();
}

// Two publishers place the camera elsewhere: one on tf, one on tf_static.
TEST_F(CameraFaults, OfTwoPublishersOfItsPlaceMakeItUnknown) {
  start(kImage);
  RosCamera camera(client, {});
  RosFrames frames(client);
  ASSERT_TRUE(camera.is_heard() && frames.is_heard());
  const auto send = [&](RosFrames& from, double height) {
    from.send({{"map", "camera", {0, 0, height}, {1, 0, 0, 0}}});
    camera.send_image(scene_of_wall);
  };
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { send(frames, 3.0); }, [&] { return is_measured(); }))
      << daemon->output();
  Participant other{dds};
  RosFrames rival(other);
  ASSERT_TRUE(rival.is_heard());
  const auto both = [&] {
    rival.send({{"map", "camera", {0, 0, 5.0}, {1, 0, 0, 0}}});
    send(frames, 3.0);
  };
  EXPECT_TRUE(step_until(kPeriodMs, both, [&] { return is("ball", PairStatus::kUnknown); }))
      << daemon->output();
  EXPECT_TRUE(names_all(both, {FrameFault::kNoPlace})) << daemon->output();
  EXPECT_TRUE(step_until(
      kPeriodMs, [&] { send(frames, 3.0); }, [&] { return is_measured(); }))
      << daemon->output();
}

TEST_F(CameraFaults, OfNoPublisherAndOfRefusedImagesAreNamedAfterAWhile) {
  start(kImage + kAbove);
  EXPECT_TRUE(step_until(
      kPeriodMs, [] {}, told("frames-silent", {"eye", "no publisher"})))
      << daemon->output();
  EXPECT_TRUE(is("ball", PairStatus::kUnknown));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  camera.change_image = [](Image& image) { image.step = 0; };
  EXPECT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); },
      told("frames-silent", {"eye", "refused"})))
      << daemon->output();
}

// The thread that builds frames gets no memory for some time.
TEST_F(CameraFaults, AFrameThatFindsNoMemoryIsRefusedAndTheDaemonGoesOn) {
  if (places::failing_memory().empty()) GTEST_SKIP() << "not with sanitizers";
  const std::filesystem::path sign = folder / "memory_fails";
  more_environment = {{"LD_PRELOAD", places::failing_memory()},
                      {"CLEARANCE_MEMORY_FAILS_IF", sign.string()}};
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  const auto send = [&] { camera.send_image(scene_of_wall); };
  ASSERT_TRUE(step_until(kPeriodMs, send, [&] { return is_measured(); })) << daemon->output();
  write_text(sign, "");
  EXPECT_TRUE(step_until(kPeriodMs, send, told("inputs-failed", {"memory"}))) << daemon->output();
  EXPECT_TRUE(step_until(kPeriodMs, send, [&] { return is("ball", PairStatus::kUnknown); }))
      << "the last frame grows old";
  std::filesystem::remove(sign);
  EXPECT_TRUE(step_until(kPeriodMs, send, [&] { return is_measured(); })) << daemon->output();
}

// At ten times the rate, some frames are skipped and the newest one counts.
TEST_F(CameraFaults, OfTenTimesTheRateCostFramesAndNothingElse) {
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  std::int64_t last = 0;
  const auto burst = [&] {
    for (int i = 0; i < 10; ++i) {
      last = dds_time();
      camera.send_image(scene_of_wall, last);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  };
  int bursts = 0;
  ASSERT_TRUE(step_until(1, burst, [&] { return ++bursts > 30 && is_measured(); }))
      << daemon->output();
  EXPECT_TRUE(step_until(
      1, [] {}, [&] { return report->oldest_pose_ns == last; }))
      << "the last frame of all comes into use";
}

}  // namespace
}  // namespace clearance::test
