// An arm turns at 2 rad/s before a camera whose stamps are up to 20 ms off.
//
// Oracles: the labels of a rendered picture, which say whose each pixel is; the motion of the
// points that are seen, by the joints' exact positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <map>
#include <numeric>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/sensors/sensors.hpp"
#include "tests/monitor/intake/camera_texts.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tools/rendering/measured_depth.hpp"
#include "tools/rendering/simulated_world.hpp"

namespace clearance::sensors_test::in_motion {
namespace {

constexpr PinholeCamera kCamera{
    .width = 640, .height = 480, .fx = 554.0, .fy = 554.0, .cx = 319.5, .cy = 239.5};
constexpr double kSpeed = 2.0, kWidest = 2.5;  // rad/s, rad
constexpr std::int64_t kStampErrorNs = 20'000'000, kMs = 1'000'000;

// The processor time of this thread.
double processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double since_start(std::int64_t stamp_ns) {
  return 1e-9 * static_cast<double>(stamp_ns - test::camera::kStart);
}

// The first joint goes to and fro at a constant speed; the arm is stretched out.
void positions_at(const Scene& scene, double t_s, std::vector<JointSample>& joints) {
  joints.assign(scene.variables.size(), {});
  const double phase = std::fmod(kSpeed * t_s, 4.0 * kWidest);
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    joints[i].variable = i;
    const std::string& name = scene.variables[i].name;
    if (name == "joint1") joints[i].position = std::abs(phase - 2.0 * kWidest) - kWidest;
    if (name == "joint2") joints[i].position = 1.2;
    if (name == "joint4") joints[i].position = 0.3;
  }
}

struct Figures {
  std::size_t frames = 0, own = 0, foreign = 0;
  std::vector<double> thickness, least;  // m, of the link of each frame whose shell is thickest
  std::vector<double> build_ns;          // processor time from a message to its frame
};

class OwnImageInMotion : public testing::Test {
 protected:
  static Figures measure(std::int64_t stated_ns, std::int64_t joints_every_ns, int frames) {
    Figures figures;
    const std::string file = test::places::sources() + "/config/cells/camera.yaml";
    auto cell = std::get<Cell>(read_cell(file));
    Sensor& sensor = cell.scene.sensors[0];
    sensor.stamp_error_ns = stated_ns;
    Sensors sensors(cell, {});
    SimulatedWorld world(cell,
                         [&](double t_s, std::vector<JointSample>& joints) {
                           positions_at(cell.scene, t_s, joints);
                         },
                         {});
    const auto send = [&](RawSensorMessage::Type type, const std::string& topic,
                          std::vector<std::byte> cdr, std::int64_t at_ns) {
      sensors.add({.type = type, .topic = topic, .sent_ns = at_ns, .writer = 1, .cdr = cdr},
                  {.realtime_ns = at_ns, .monotonic_ns = at_ns});
    };
    test::camera::InfoText info;
    info.width = kCamera.width;
    info.height = kCamera.height;
    info.k = {kCamera.fx, 0, kCamera.cx, 0, kCamera.fy, kCamera.cy, 0, 0, 1};
    info.p = {kCamera.fx, 0, kCamera.cx, 0, 0, kCamera.fy, kCamera.cy, 0, 0, 0, 1, 0};
    send(RawSensorMessage::Type::kCameraInfo, sensor.camera_info, info.cdr(), test::camera::kStart);
    rendering::DepthRenderer renderer(kCamera);
    const rendering::DepthNoise noise{
        .bound = {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
        .range = {.least = sensor.least_depth, .greatest = sensor.greatest_depth},
        .share = 1.0,
        .missing_share = 0.01};
    Random random(20);
    std::int64_t joints_ns = test::camera::kStart;
    for (int frame = 0; frame < frames; ++frame) {
      const std::int64_t exposed_ns =
          test::camera::kStart + 500 * kMs + frame * test::camera::kFrame;
      // A third of the stamps are off by as much as they may be.
      const double share = std::clamp(random.uniform(-1.5, 1.5), -1.0, 1.0);
      const std::int64_t stamp_ns = exposed_ns + static_cast<std::int64_t>(share * kStampErrorNs);
      for (; joints_ns < exposed_ns + 60 * kMs; joints_ns += joints_every_ns) {
        std::vector<JointSample> joints;
        positions_at(cell.scene, since_start(joints_ns), joints);
        for (JointSample& each : joints) each.stamp_ns = joints_ns;
        sensors.add({}, joints, joints_ns);
      }
      world.place(since_start(exposed_ns));
      renderer.render(*world.sensor(sensor), world.bodies());
      std::vector<std::byte> bytes;
      rendering::measure(renderer.depth(), DepthImage::Format::kMillimetres16, noise,
                         static_cast<std::uint64_t>(frame), bytes);
      test::camera::ImageText image;
      image.width = kCamera.width;
      image.height = kCamera.height;
      image.step = 2 * kCamera.width;
      image.stamp_ns = stamp_ns;
      image.data.resize(bytes.size());
      std::memcpy(image.data.data(), bytes.data(), bytes.size());
      const std::vector<std::byte> message = image.cdr();
      const double began_ns = processor_ns();
      send(RawSensorMessage::Type::kImage, sensor.topic, message, joints_ns);
      sensors.settle(
          joints_ns + 30 * kMs, [](const SeenCloud*) { return false; },
          [&](std::uint32_t, const SensorFrame& built) {
            figures.build_ns.push_back(processor_ns() - began_ns);
            add(built, renderer, world, sensor, exposed_ns, figures);
          });
    }
    return figures;
  }

 private:
  // The world is placed at the time of exposure.
  static void add(const SensorFrame& built, const rendering::DepthRenderer& renderer,
                  SimulatedWorld& world, const Sensor& sensor, std::int64_t exposed_ns,
                  Figures& figures) {
    ++figures.frames;
    const DepthCloud& cloud = *built.cloud->depth();
    built.cloud->for_each([&](std::size_t b, std::size_t lane, const Vec3&, double) {
      const std::uint32_t label = renderer.labels()[cloud.source(b, lane)];
      figures.foreign += label != rendering::kNoLabel && world.is_of_robot(label) ? 1 : 0;
    });
    // The points of each link that are seen, in its frame, and twice the largest error of a depth.
    struct Seen {
      std::vector<Vec3> points;
      double noise = 0.0;  // m
    };
    std::map<std::uint32_t, Seen> links;
    const Pose camera = *world.sensor(sensor);
    for (std::size_t i = 0; i < renderer.labels().size(); ++i) {
      const std::uint32_t label = renderer.labels()[i];
      if (label == rendering::kNoLabel || !world.is_of_robot(label)) continue;
      ++figures.own;
      Seen& seen = links[label];
      const Pose& link = *world.object(label);
      const Vec3 p = renderer.point(i);
      seen.points.push_back(link.orientation.conjugate() * (transform(camera, p) - link.position));
      seen.noise = std::max(seen.noise, 2.0 * sensor.error_at(p.z()) * p.norm() / p.z());
    }
    const auto poses_at = [&](std::int64_t stamp_ns) {
      world.place(since_start(stamp_ns));
      std::map<std::uint32_t, Pose> poses;
      for (const auto& [label, seen] : links) poses[label] = *world.object(label);
      return poses;
    };
    auto at = poses_at(built.stamp_ns), before = poses_at(built.stamp_ns - kStampErrorNs),
         after = poses_at(built.stamp_ns + kStampErrorNs);
    double thickest = 0.0, least = 0.0;
    for (const HiddenNear& near : built.cloud->hidden()) {
      if (!links.contains(near.object) || near.shell.thickness <= thickest) continue;
      double error = 0.0;
      for (const Vec3& p : links[near.object].points) {
        const Vec3 here = transform(at[near.object], p);
        error = std::max({error, (transform(before[near.object], p) - here).norm(),
                          (transform(after[near.object], p) - here).norm()});
      }
      thickest = near.shell.thickness;
      least = 2.0 * error + links[near.object].noise;
    }
    figures.thickness.push_back(thickest);
    figures.least.push_back(least);
    world.place(since_start(exposed_ns));
  }
};

double mean(const std::vector<double>& all) {
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

// An element counts as own within the error E of its link's pose, and may be as long as the noise
// of its depth, D. So no shell around the exact link is thinner than 2 E + D. Between two joint
// states, each joint may leave its line and be back, which the least thickness does not contain.
TEST_F(OwnImageInMotion, LeavesNoOwnPointWithAShellNearTheThinnestThatTheErrorsAllow) {
  for (const bool is_often : {true, false}) {
    const Figures figures = measure(kStampErrorNs, is_often ? kMs : 10 * kMs, 60);
    EXPECT_GT(figures.frames, 30u);
    EXPECT_GT(figures.own, 100'000u);
    EXPECT_EQ(figures.foreign, 0u);
    const double thickness = mean(figures.thickness), least = mean(figures.least);
    EXPECT_LT(thickness, (is_often ? 1.5 : 2.5) * least);
    EXPECT_GE(thickness, least);
    const auto record = [&](const std::string& what, double value) {
      RecordProperty(what + (is_often ? "_1kHz" : "_100Hz"), std::to_string(value));
    };
    record("frames", static_cast<double>(figures.frames));
    record("own_points", static_cast<double>(figures.own));
    record("own_points_left", static_cast<double>(figures.foreign));
    record("thickness_mm", 1e3 * thickness);
    record("thickness_least_mm", 1e3 * least);
    // This time, from a message's bytes to the frame that the tick takes, includes the removal of
    // the robot's own image.
    std::vector<double> build_ns = figures.build_ns;
    std::ranges::nth_element(build_ns, build_ns.begin() + std::ssize(build_ns) / 2);
    record("build_ns_a_pixel", build_ns[build_ns.size() / 2] / (kCamera.width * kCamera.height));
  }
}

TEST_F(OwnImageInMotion, LeavesOwnPointsIfTheErrorOfStampsIsNotStated) {
  EXPECT_GT(measure(0, 10 * kMs, 10).foreign, 100u);
}

}  // namespace
}  // namespace clearance::sensors_test::in_motion
