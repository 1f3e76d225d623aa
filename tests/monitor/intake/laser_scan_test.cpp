// Scans of a laser: their rays as balls, live, again from a recording, and on the page.
//
// Oracle: the distance to the nearest ball by polar coordinates in long double, from the numbers
// that the test put in.
#include "monitor/intake/laser_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/intake/frame_decoders.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/visual/seen_frames.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct ScanText {
  float angle_min = -1.0F, angle_max = 1.0F, angle_increment = 0.05F;
  float time_increment = 0.0F, scan_time = 0.0F, range_min = 0.1F, range_max = 8.0F;
  std::vector<float> ranges = std::vector<float>(41, 2.0F), intensities = {};
  std::int64_t stamp_ns = kStart;

  [[nodiscard]] std::vector<std::byte> cdr() const {
    test::RosCdr out;
    out.header(stamp_ns, "laser");
    for (const float number :
         {angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max})
      out.number(number);
    for (const auto* const list : {&ranges, &intensities}) {
      out.number(static_cast<std::uint32_t>(list->size()));
      for (const float number : *list) out.number(number);
    }
    return out.bytes();
  }
};

constexpr double kError = 0.02;
const std::string kScan =
    "points: /scan, depth_error: {constant: 0.02}, range: [0.05, 6], max_speed: 2, "
    "stamp_error_ms: 40, mount: {pose: {xyz: [0.3, -0.2, 0.5], rpy: [0, 0, 0]}}";

class LaserScans : public SensorsTest {
 protected:
  void add(const ScanText& text) { sensors->add(raw(text), now(text)); }
  static RawSensorMessage raw(const ScanText& text) {
    return {.type = Type::kLaserScan,
            .topic = "/scan",
            .sent_ns = text.stamp_ns + 1000,
            .writer = 1,
            .cdr = text.cdr()};
  }
  static Now now(const ScanText& text) {
    return {.realtime_ns = text.stamp_ns + 1000, .monotonic_ns = text.stamp_ns};
  }
  // Before the first scan.
  void add_all_joints() {
    add_joints(0.0, kStart - 100'000'000);
    add_joints(0.0, kStart);
  }
  FrameFault fault(const ScanText& text) {
    Sensor sensor;
    sensor.most_points = 50;
    sensor.stamp_error_ns = 40'000'000;
    CdrDecoder decoder;
    const auto cloud = frame_decoder(Type::kLaserScan)->decode(raw(text), sensor, decoder);
    return cloud->fault;
  }
};

// The distance of a ball around p, in the scanner's frame, from the nearest ball of the scan.
long double nearest(const ScanText& text, const Vec3& p, double radius) {
  using Real = long double;
  Real least = kInf;
  const Real half_gap = std::tan(std::abs(Real{text.angle_increment}) / 2);
  for (std::size_t i = 0; i < text.ranges.size(); ++i) {
    const Real range = text.ranges[i], angle = text.angle_min + Real{text.angle_increment} * i;
    const bool is_too_near = text.ranges[i] == -kInf;
    const bool is_there = range >= std::max(Real{text.range_min}, Real{0.05}) &&
                          range <= std::min(Real{text.range_max}, Real{6});
    if (!is_there && !is_too_near) continue;
    const Real end = is_too_near ? Real{text.range_min} : range;
    const Real middle = is_too_near ? end / 2 : end;
    const Real ball = end - middle + Real{kError} + (end + Real{kError}) * half_gap;
    const Real x = middle * std::cos(angle) - p.x(), y = middle * std::sin(angle) - p.y();
    least = std::min(least, std::sqrt(x * x + y * y + Real{p.z()} * p.z()) - ball - radius);
  }
  return least;
}

TEST_F(LaserScans, AreTheBallsAroundTheEndsOfTheirRays) {
  make(kScan);
  add_all_joints();
  SlabBody body;
  int number = 0, checked = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 5);
    ScanText text;
    text.stamp_ns += ++number * kFrame;
    text.angle_min = static_cast<float>(random.uniform(-3.1, 0.0));
    text.angle_increment = static_cast<float>(random.uniform(0.005, 0.07));
    if (random.chance(0.3)) text.angle_increment = -text.angle_increment;
    text.angle_max = text.angle_min + 40.0F * text.angle_increment;
    for (float& range : text.ranges) {
      range = static_cast<float>(random.uniform(0.0, 9.0));
      if (random.chance(0.1)) range = random.chance(0.5) ? kInf : kNan;
      if (random.chance(0.02)) range = -kInf;
    }
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{});
    add_all_joints();
    add(text);
    const auto frames = settle(text.stamp_ns + 25'000'000);
    ASSERT_EQ(frames.size(), 1u) << seed;
    for (int query = 0; query < 20; ++query) {
      const Vec3 p(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-1, 1));
      const ConvexBody part = test::made(point(Vec3::Zero(), 0.05));
      RelativePose pose;
      pose.translation = -p;
      CloudTracking tracking;
      const NearestElement found = frames[0].cloud->nearest(part, pose, body, tracking);
      const long double exact = nearest(text, p, 0.05);
      EXPECT_LE(found.lower, exact) << seed;
      EXPECT_GE(found.upper, exact) << seed;
      EXPECT_LE(found.upper - found.lower, 1e-5) << seed;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 1200);
}

// As REP 117 says, and nothing of it is clear: a frame without an end of a ray is refused.
TEST_F(LaserScans, CountWhatIsNoRangeAsNotSeenAndWhatIsTooNearAsThere) {
  make(kScan);
  add_all_joints();
  int number = 0;
  const auto elements = [&](float range) {
    ScanText text;
    text.stamp_ns += ++number * kFrame;
    std::ranges::fill(text.ranges, range);
    text.ranges[7] = 1.0F + 0.001F * static_cast<float>(number);
    add(text);
    const auto frames = settle(text.stamp_ns + 25'000'000);
    return frames.empty() ? 0 : frames[0].cloud->size() - 1;
  };
  EXPECT_EQ(elements(2.0F), 40u);
  EXPECT_EQ(elements(kInf), 0u) << "nothing within the range";
  EXPECT_EQ(elements(kNan), 0u) << "a fault of the measurement";
  EXPECT_EQ(elements(0.09F), 0u) << "below range_min";
  EXPECT_EQ(elements(0.0F), 0u);
  EXPECT_EQ(elements(7.0F), 0u) << "beyond the range of the cell";
  EXPECT_EQ(elements(8.5F), 0u) << "beyond range_max";
  EXPECT_EQ(elements(-kInf), 40u) << "something is there, nearer than range_min";
}

TEST_F(LaserScans, ThatCannotBeWhatTheySayAreRefusedByCause) {
  const auto with = [&](const auto& change) {
    ScanText text;
    change(text);
    return fault(text);
  };
  using Fault = FrameFault;
  EXPECT_EQ(with([](ScanText&) {}), Fault::kNoFault);
  EXPECT_EQ(with([](ScanText& t) { t.ranges.clear(); }), Fault::kNoPixels);
  EXPECT_EQ(with([](ScanText& t) { t.ranges.resize(51); }), Fault::kTooManyPixels);
  EXPECT_EQ(with([](ScanText& t) { t.ranges.resize(20); }), Fault::kLayout) << "half a scan";
  EXPECT_EQ(with([](ScanText& t) { t.ranges.push_back(2.0F); }), Fault::kNoFault);
  EXPECT_EQ(with([](ScanText& t) { t.angle_increment = 0.0F; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.angle_increment = -0.05F; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.angle_min = kNan; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.range_min = 9.0F; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.range_max = kNan; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.angle_increment = 0.2F, t.angle_max = 7.0F; }), Fault::kLayout)
      << "more than a turn";
  EXPECT_EQ(with([](ScanText& t) { t.angle_min = t.angle_max = 1e30F; }), Fault::kLayout)
      << "all rays have one angle as float32";
  EXPECT_EQ(with([](ScanText& t) { t.angle_increment = 0.11F, t.angle_max = 3.4F; }),
            Fault::kWideRays);
  EXPECT_EQ(with([](ScanText& t) { t.time_increment = 0.00099F; }), Fault::kNoFault);
  EXPECT_EQ(with([](ScanText& t) { t.time_increment = 0.00101F; }), Fault::kLongScan);
  EXPECT_EQ(with([](ScanText& t) { t.scan_time = 0.2F; }), Fault::kLongScan) << "a third of it";
  EXPECT_EQ(with([](ScanText& t) { t.scan_time = kNan; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.scan_time = -1.0F; }), Fault::kLayout);
  EXPECT_EQ(with([](ScanText& t) { t.intensities = {1.0F}; }), Fault::kNoFault);
}

// A bag, a live topic and the page have one intake; partners and replays build a frame again.
TEST_F(LaserScans, ComeFromTheTopicOfPointsAndAreTheSameInARecordingAndOnThePage) {
  make(kScan);
  EXPECT_TRUE(is_frame_type(SensorKind::kPoints, "sensor_msgs/msg/LaserScan"));
  std::vector<BuiltFrame> built;
  sensors->keep([&](BuiltFrame frame) { built.push_back(std::move(frame)); });
  add_all_joints();
  add(ScanText{});
  const auto frames = settle(kStart + 25'000'000);
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(built.size(), 1u);
  const BuiltFrame again = from_wire(*to_wire(built[0], 1, true));
  Sensors other(cell, SensorsOptions{});
  std::size_t same = 0;
  ASSERT_TRUE(other.rebuild(
      again, [](const SeenCloud*) { return false; },
      [&](std::uint32_t, const SensorFrame& frame) {
        const PointCloud &a = *frame.cloud->points(), &b = *frames[0].cloud->points();
        ASSERT_EQ(a.blocks(), b.blocks());
        for (std::size_t i = 0; i < a.blocks(); ++i) {
          same += a.block(i).x == b.block(i).x && a.block(i).y == b.block(i).y &&
                          a.block(i).radius == b.block(i).radius
                      ? 1
                      : 0;
        }
        EXPECT_EQ(same, b.blocks());
      }));
  EXPECT_GT(same, 0u);

  SeenFrames page(cell, false);
  page.hear(raw(ScanText{}), kStart);
  int drawn = 0;
  const auto draw = [&](std::uint32_t sensor, std::int64_t stamp_ns,
                        std::span<const std::byte> cdr) {
    EXPECT_EQ(sensor, 0u);
    EXPECT_EQ(stamp_ns, kStart);
    EXPECT_GT(cdr.size(), 41u * 16u);
    ++drawn;
  };
  page.settle(kStart + 25'000'000, draw);
  page.show(built[0], draw);
  EXPECT_EQ(drawn, 2) << "heard, and from a recording";
  EXPECT_EQ(page.states()[0].elements, 41u);
}

}  // namespace
}  // namespace clearance::sensors_test
