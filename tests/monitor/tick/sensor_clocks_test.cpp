// The clock of a sensor's frames, when one monitor takes over from another.
//
// Also how long a frame stays in use after its camera has died.
//
// Oracle: a camera on another machine, whose frames are 50 ms old, while this machine's clock is
// stepped back.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

constexpr std::int64_t kStep = -30'000'000, kAge = 50'000'000;

class SensorClocks : public testing::Test {
 protected:
  static Scene make(std::uint64_t revision, const std::vector<const char*>& names) {
    std::vector<Object> objects;
    std::vector<Sensor> sensors;
    for (const char* name : names) {
      objects.push_back(test::moving(name, {test::ball(name[0] == 's' ? 50.0 : 0.1)}));
      objects.back().age_limit_ns = 100'000'000;
      if (name[0] != 's') continue;
      objects.back().sensor = static_cast<std::uint32_t>(sensors.size());
      sensors.emplace_back().object = static_cast<std::uint32_t>(objects.size() - 1);
    }
    Scene scene = test::cell_of(std::move(objects));
    scene.revision = revision;
    scene.sensors = std::move(sensors);
    std::erase_if(scene.pairs, [&](const ObjectPair& pair) {
      return scene.objects[pair.first].is_seen() && scene.objects[pair.second].is_seen();
    });
    return scene;
  }
  // Returns the age of what the sensor of this object sees.
  std::int64_t age(Monitor& of, std::uint32_t sensor, std::uint32_t object,
                   std::int64_t offset_ns) {
    now += kTick;
    const SensorFrame frame{
        .cloud = &cloud, .stamp_ns = now - kAge, .world_from_sensor = {}, .content = 1};
    EXPECT_TRUE(of.show(sensor, frame));
    of.tick({}, {}, {now, offset_ns});
    return of.input_age(object).age_ns;
  }
  // The monitor of a partner that joins now.
  [[nodiscard]] std::unique_ptr<Monitor> joining() {
    const auto before = test::taken_over(*monitor, scene, scene, numbers);
    std::vector<std::byte> bytes;
    StateWriter out(bytes);
    before->save(out);
    auto joined = std::make_unique<Monitor>(scene);
    StateReader in(bytes);
    EXPECT_TRUE(joined->restore(in));
    return joined;
  }
  void SetUp() override {
    const std::array<MeasuredPoint, 1> point = {{{2.0F, 0.0F, 0.0F, 0.0F}}};
    ASSERT_EQ(cloud.points()->build(point, {Vec3::Zero(), 100.0}), CloudBuild::kBuilt);
    ASSERT_EQ(age(*monitor, 0, 1, 0), kAge);
    ASSERT_EQ(age(*monitor, 0, 1, kStep), kAge);
  }

  SeenCloud cloud = SeenCloud::of_points(1);
  std::int64_t now = kStart;
  Scene scene = make(7, {"ball", "seen"});
  SourceNumbers numbers{scene};
  std::unique_ptr<Monitor> monitor = std::make_unique<Monitor>(scene);
};

TEST_F(SensorClocks, AreTakenOverSoThatNoFrameBecomesYounger) {
  const auto same = test::taken_over(*monitor, scene, scene, numbers);
  EXPECT_EQ(age(*same, 0, 1, kStep), kAge);
}

TEST_F(SensorClocks, AreThoseOfTheSameSensorInAChangedScene) {
  const Scene changed = make(8, {"sound", "new", "ball", "seen"});
  const auto next = test::taken_over(*monitor, scene, changed, numbers);
  EXPECT_EQ(age(*next, 1, 3, kStep), kAge);
}

// A replay that begins again does the same, when the clock was another one.
TEST_F(SensorClocks, AreForgottenWhenTheTicksTimeGoesBackwards) {
  constexpr std::int64_t kOffset = 20'000'000;
  EXPECT_EQ(age(*monitor, 0, 1, kOffset), kAge) << "the clock is the one before";
  now -= 5'000'000'000;
  EXPECT_EQ(age(*monitor, 0, 1, kOffset), kAge + kOffset);
}

TEST_F(SensorClocks, AreInTheStateThatAPartnerGets) {
  const auto joined = joining();
  EXPECT_EQ(age(*joined, 0, 1, kStep), kAge);
}

// The camera has died. A partner that joins must not wait for a frame that nothing sends again.
class DeadCamera : public SensorClocks {
 protected:
  void make(double max_speed, bool is_on_tf = false) {
    scene.objects[1].max_speed = max_speed;
    scene.sensors[0].frames_by_message = is_on_tf;
    monitor = std::make_unique<Monitor>(scene);
    age(*monitor, 0, 1, 0);
  }
  void tick_at(double seconds_later) {
    const std::int64_t at = now + static_cast<std::int64_t>(seconds_later * 1e9);
    monitor->tick(std::vector{test::sample(0, test::at(1, 0, 0), at)}, {}, {at, 0});
  }
  [[nodiscard]] PairStatus status() const {
    return test::report_between(scene, *monitor, "ball", "seen").status;
  }
  // The frame that a joining partner waits for; 0: none.
  [[nodiscard]] std::uint64_t awaited() { return joining()->awaited_frame(0); }
};

TEST_F(DeadCamera, LeavesItsFrameInUseForASecondAfterItIsUnknown) {
  make(kInfinity);
  EXPECT_EQ(awaited(), 1u);
  tick_at(1.0);
  EXPECT_EQ(status(), PairStatus::kUnknown);
  EXPECT_TRUE(monitor->uses(&cloud));
  tick_at(1.2);
  EXPECT_EQ(status(), PairStatus::kUnknown);
  EXPECT_FALSE(monitor->uses(&cloud));
  EXPECT_EQ(awaited(), 0u);
  now += 2'000'000'000;
  EXPECT_EQ(age(*monitor, 0, 1, 0), kAge) << "it is back";
  tick_at(0.001);
  EXPECT_EQ(status(), PairStatus::kConverged);
  EXPECT_TRUE(monitor->set_absent(1, true));
  tick_at(0.002);
  EXPECT_EQ(awaited(), 0u) << "what it sees is absent";
}

TEST_F(DeadCamera, WithAStatedSpeedIsUnknownOnceThatLeadsOutOfItsView) {
  make(10.0);
  tick_at(4.9);
  EXPECT_EQ(status(), PairStatus::kStale) << "10 m/s for 4.95 s, in a view of 50 m";
  EXPECT_EQ(awaited(), 1u);
  tick_at(5.5);
  EXPECT_EQ(status(), PairStatus::kUnknown);
  EXPECT_EQ(awaited(), 1u);
  tick_at(6.1);
  EXPECT_EQ(status(), PairStatus::kUnknown);
  EXPECT_EQ(awaited(), 0u);
  make(0.0);
  tick_at(100.0);
  EXPECT_EQ(status(), PairStatus::kStale) << "nothing that it sees moves";
}

// What is heard of a mount on tf after a frame may contradict its place.
TEST_F(DeadCamera, OnTfIsUnknownAsSoonAsItIsLate) {
  make(0.0, true);
  tick_at(0.05);
  EXPECT_EQ(status(), PairStatus::kConverged);
  tick_at(1.0);
  EXPECT_EQ(status(), PairStatus::kUnknown);
  EXPECT_TRUE(monitor->input_age(1).stale);
  EXPECT_FALSE(monitor->input_age(1).contradicted) << "nothing came that could contradict it";
  now += 2'000'000'000;
  EXPECT_EQ(age(*monitor, 0, 1, 0), kAge) << "it is back";
  tick_at(0.001);
  EXPECT_EQ(status(), PairStatus::kConverged);
}

}  // namespace
}  // namespace clearance
