// A stream of 640 x 480 pixels at 30 Hz beside ticks at 1 kHz.
//
// CLEARANCE_CAMERA_SECONDS=60 lets it last longer, with the tick thread in real time on a core of
// its own, and prints how late reports and ticks are, with the stream and without it in turn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/shared/ros_joints.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/camera_daemon.hpp"

namespace clearance::test {
namespace {

using std::chrono::steady_clock;

double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return values[place];
}

class CameraStream : public DaemonCameras {
 protected:
  // Streams for this long, and takes all reports. Returns the times from the end of the write of a
  // frame to its first report, ms.
  std::vector<double> stream(double seconds, bool with_images) {
    std::vector<double> late_ms;
    std::map<std::int64_t, std::int64_t> written;  // when, by stamp
    std::atomic<bool> done{false};
    std::thread moving([&] {
      auto next = steady_clock::now();
      for (int i = 0; !done; ++i) {
        joints->send({"shoulder", "elbow", "push"}, {0.3 * std::sin(0.001 * i), 0, 0.1});
        std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
      }
    });
    const auto end = steady_clock::now() + std::chrono::duration<double>(seconds);
    auto next = steady_clock::now();
    while (steady_clock::now() < end) {
      if (steady_clock::now() >= next) {
        next += std::chrono::microseconds(33'333);
        const std::int64_t stamp = dds_time();
        if (with_images) {
          camera->send_image(scene_of_wall, stamp);
          written[stamp] = dds_time();
          ++sent;
        }
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      take();
      take_health(with_images ? with_stream : without);
      const auto of_report = written.find(report->oldest_pose_ns);
      if (of_report == written.end()) continue;
      late_ms.push_back(1e-6 * static_cast<double>(dds_time() - of_report->second));
      written.erase(written.begin(), std::next(of_report));
    }
    done = true;
    moving.join();
    return late_ms;
  }
  // The largest delay of a wake-up and the longest tick of each second, in us, and the number of
  // overruns.
  struct Ticks {
    std::vector<double> wakeups, ticks;
    std::uint64_t overruns = 0;
    [[nodiscard]] std::string text() {
      return fmt::format(
          "wake-up late p50 {:.0f}, p99 {:.0f}, worst {:.0f}; tick p50 {:.0f}, p99 {:.0f}, worst "
          "{:.0f}; overruns {} in {} s",
          percentile(wakeups, 0.5), percentile(wakeups, 0.99), percentile(wakeups, 1.0),
          percentile(ticks, 0.5), percentile(ticks, 0.99), percentile(ticks, 1.0), overruns,
          ticks.size());
    }
  };
  void take_health(Ticks& of) {
    while (take_next(health_reader, health)) {
      of.wakeups.push_back(health->wakeup_second_max_us);
      of.ticks.push_back(health->tick_second_max_us);
      of.overruns += health->overruns - overruns.value_or(health->overruns);
      overruns = health->overruns;
    }
  }
  Ticks with_stream, without;
  std::optional<std::uint64_t> overruns;  // in the last health sample
  int sent = 0;                           // frames
  Sample<clearance_msg_Health> health;
  dds_entity_t health_reader = client.reader(TopicKind::kHealth, Topics{}.health);
  std::optional<RosCamera> camera;
  std::optional<RosJoints> joints;
};

TEST_F(CameraStream, OfFullSizeComesIntoReportsBesideTicksAtOneKilohertz) {
  const char* const wanted = std::getenv("CLEARANCE_CAMERA_SECONDS");
  const double seconds = wanted == nullptr ? 1.0 : std::atof(wanted);
  rate_hz = 1000;
  start(
      "depth_image: /cam/image, size: [640, 480], depth_error: {constant: 0.002}, range: [0.3, 4]" +
          kAbove,
      wanted == nullptr ? std::vector<std::string>{}
                        : std::vector<std::string>{"--priority", "80", "--cpu", "1"});
  camera.emplace(client, MadeCamera{.width = 640, .height = 480, .focal = 525.0});
  joints.emplace(client);
  ASSERT_TRUE(camera->is_heard() && joints->is_heard());
  std::vector<double> late_ms;
  const auto stream_part = [&](double part) {
    const std::vector<double> of_part = stream(part, true);
    late_ms.insert(late_ms.end(), of_part.begin(), of_part.end());
  };
  for (double streamed = 0.0; streamed < seconds; streamed += 25.0) {
    if (wanted != nullptr) static_cast<void>(stream(5.0, false));
    stream_part(std::min(25.0, seconds - streamed));
  }
  // On a busy machine the daemon has fewer frames in a second, so they take longer to come.
  const auto are_enough = [&] { return static_cast<double>(late_ms.size()) > 5.0 * seconds; };
  EXPECT_TRUE(eventually([&] { return are_enough() || (stream_part(1.0), are_enough()); }))
      << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  if (wanted == nullptr) return;
  std::printf(
      "%zu of %d frames in reports; from the end of the write to the first report, ms: "
      "p50 %.2f, p99 %.2f, p99.9 %.2f, worst %.2f\nlargest of each second, us, with the "
      "stream: %s\nwithout: %s\n%s\n",
      late_ms.size(), sent, percentile(late_ms, 0.5), percentile(late_ms, 0.99),
      percentile(late_ms, 0.999), percentile(late_ms, 1.0), with_stream.text().c_str(),
      without.text().c_str(), daemon->output().c_str());
}

}  // namespace
}  // namespace clearance::test
