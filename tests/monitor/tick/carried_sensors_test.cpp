// A sensor whose carrier the tick does not know shows nothing certain.
//
// Oracle: the joints of a robot that the test moves, while their encoder sends the same position.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using sensors_test::cell_with;
using test::kStart;

constexpr std::int64_t kCarriedStep = 10'000'000;
constexpr Carrier kWorld{}, kCart{.kind = RobotBase::Kind::kObject, .object = 0},
    kUpper{.kind = RobotBase::Kind::kLink, .robot = 0, .link = 1},
    kFoot{.kind = RobotBase::Kind::kLink, .robot = 0, .link = 0};

class CarriedSensors : public testing::Test {
 protected:
  void SetUp() override {
    const std::array<MeasuredPoint, 1> point = {{{2.0F, 0.0F, 0.0F, 0.0F}}};
    ASSERT_EQ(cloud.points()->build(point, {Vec3::Zero(), 100.0}), CloudBuild::kBuilt);
    ASSERT_EQ(cell.scene.objects[kCart.object].name, "cart");
    ASSERT_EQ(cell.scene.robots[0].links[kUpper.link].name, "upper");
  }
  // A tick with a frame that this has carried.
  void tick(double shoulder, double velocity, const Carrier& carrier, bool is_shown = true) {
    now += kCarriedStep;
    std::array<JointSample, 3> joints = test::joints(shoulder, 0.0, 0.0, now);
    for (JointSample& joint : joints) joint.has_velocity = true;
    joints[0].velocity = velocity;
    const SensorFrame frame{.cloud = &cloud,
                            .stamp_ns = now - kCarriedStep / 2,
                            .world_from_sensor = {},
                            .carrier = carrier};
    if (is_shown) {
      EXPECT_TRUE(monitor.show(0, frame));
    }
    monitor.tick(std::vector{test::sample(kCart.object, test::at(cart_x, 0, 0), now)}, joints,
                 {now, 0});
  }
  [[nodiscard]] bool is_known(const char* object) const {
    const PairStatus status = test::report_between(cell.scene, monitor, object, "eye").status;
    return status != PairStatus::kUnknown && status != PairStatus::kStale;
  }
  [[nodiscard]] bool knows_upper() const {
    return monitor.present_link(0, kUpper.link).state == PresentPose::State::kUsable;
  }
  // The shoulder turns at 0.5 rad/s and its encoder is stuck.
  bool get_stuck(const Carrier& carrier) {
    for (int i = 0; i < 1000 && knows_upper(); ++i) tick(0.0, 0.5, carrier);
    return !knows_upper();
  }

  Cell cell = cell_with(sensors_test::kPoints + ", mount: {on: upper}, age_limit_ms: 2000");
  Monitor monitor{cell.scene};
  SeenCloud cloud = SeenCloud::of_points(1);
  std::int64_t now = kStart;
  double cart_x = 1.0;
};

TEST_F(CarriedSensors, OnALinkWhoseJointIsContradictedAreUnknown) {
  for (int i = 0; i < 10; ++i) tick(0.0, 0.0, kUpper);
  EXPECT_TRUE(is_known("cart"));
  ASSERT_TRUE(get_stuck(kUpper));
  EXPECT_FALSE(is_known("cart")) << "in the same tick";
  // The encoder is right after this, and the joint stands still. Frames no longer come.
  for (int i = 0; i < 1000 && !knows_upper(); ++i) {
    tick(0.0, 0.0, kUpper, i < 3);
    EXPECT_TRUE(knows_upper() || !is_known("cart"));
  }
  ASSERT_TRUE(knows_upper());
  EXPECT_FALSE(is_known("cart")) << "the frame in use is from before";
  tick(0.0, 0.0, kUpper);
  EXPECT_TRUE(is_known("cart"));
}

TEST_F(CarriedSensors, OfTheWorldAndOnALinkBeforeThatJointStayKnown) {
  for (const Carrier& carrier : {kWorld, kFoot}) {
    for (int i = 0; i < 1000 && !knows_upper(); ++i) tick(0.0, 0.0, carrier);
    tick(0.0, 0.0, carrier);
    ASSERT_TRUE(get_stuck(carrier));
    EXPECT_TRUE(is_known("cart"));
  }
}

TEST_F(CarriedSensors, OnAnObjectThatIsContradictedAreUnknown) {
  for (int i = 0; i < 10; ++i) tick(0.0, 0.0, kCart);
  EXPECT_TRUE(is_known("upper"));
  cart_x = 500.0;
  tick(0.0, 0.0, kCart);
  EXPECT_EQ(monitor.present_pose(kCart.object).state, PresentPose::State::kContradicted);
  EXPECT_FALSE(is_known("upper"));
  cart_x = 1.0;
  for (int i = 0; i < 200; ++i) tick(0.0, 0.0, kCart);
  EXPECT_TRUE(is_known("upper"));
}

TEST_F(CarriedSensors, AreUnknownInTheStateThatAPartnerGets) {
  for (int i = 0; i < 10; ++i) tick(0.0, 0.0, kUpper);
  ASSERT_TRUE(get_stuck(kUpper));
  std::vector<std::byte> bytes;
  StateWriter out(bytes);
  monitor.save(out);
  Monitor joined(cell.scene);
  StateReader in(bytes);
  ASSERT_TRUE(joined.restore(in));
  const SensorFrame frame{
      .cloud = &cloud, .stamp_ns = now - kCarriedStep, .world_from_sensor = {}, .carrier = kWorld};
  EXPECT_TRUE(joined.show(0, frame));
  joined.tick(std::vector{test::sample(kCart.object, test::at(cart_x, 0, 0), now)}, {}, {now, 0});
  EXPECT_EQ(test::report_between(cell.scene, joined, "cart", "eye").status, PairStatus::kUnknown);
}

}  // namespace
}  // namespace clearance
