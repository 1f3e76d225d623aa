// A partner or a recording says where a frame was taken from and where the robot was then. Nothing
// is built of a frame whose places are none, or that is said to be known better than exactly.
//
// Oracle: the definition of a value that a frame can have.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "monitor/sensors/built_frames.hpp"
#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

class ForgedFrames : public SensorsTest {
 protected:
  void SetUp() override {
    make(kImage + ", max_speed: 0.5, persist: {frames: 2, of: 3}" + kAbove);
    sensors->keep([this](BuiltFrame frame) { built.push_back(std::move(frame)); });
    add_joints(0.1, kStart - 10'000'000);
    add_joints(0.1, kStart + 10'000'000);
    const std::vector<PoseSample> poses{test::sample(0, test::at(3, 0, 0), kStart + 10'000'000)};
    sensors->add(poses, {}, kStart + 10'000'000);
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    add(flat(0, 1500));
    static_cast<void>(settle(kStart + 25'000'000));
    ASSERT_EQ(built.size(), 1u);
    ASSERT_FALSE(built[0].postures.objects.empty());
    ASSERT_TRUE(is_built(built[0]));
  }
  // True if a partner builds it from the message.
  bool is_built(const BuiltFrame& frame) const {
    Sensors other(cell, SensorsOptions{});
    return other.rebuild(
        from_wire(*to_wire(frame, 1, true)), [](const SeenCloud*) { return false; },
        [](std::uint32_t, const SensorFrame&) {});
  }

  std::vector<BuiltFrame> built;
};

TEST_F(ForgedFrames, AreRefusedForEachPlaceThatIsNoneAndEachErrorBelowZero) {
  using Numbers = std::function<std::vector<double*>(PastPose&)>;
  const Numbers coordinates = [](PastPose& past) {
    Pose& pose = past.world_from_body;
    return std::vector<double*>{&pose.position.x(),    &pose.position.y(),    &pose.position.z(),
                                &pose.orientation.x(), &pose.orientation.y(), &pose.orientation.z(),
                                &pose.orientation.w()};
  };
  const Numbers errors = [](PastPose& past) {
    return std::vector<double*>{&past.shift_error, &past.turn_error};
  };
  const auto expect_refused = [&](const std::vector<double>& values, const Numbers& numbers) {
    const std::size_t places = 1 + built[0].postures.objects.size(),
                      count = numbers(built[0].place).size();
    for (std::size_t place = 0; place < places; ++place) {
      for (std::size_t number = 0; number < count; ++number) {
        for (const double value : values) {
          BuiltFrame forged = built[0];
          PastPose& past = place == 0 ? forged.place : forged.postures.objects[place - 1];
          past.known = true;
          *numbers(past)[number] = value;
          EXPECT_FALSE(is_built(forged))
              << "place " << place << ", number " << number << ": " << value;
        }
      }
    }
  };
  expect_refused({kNan, kInfinite, -kInfinite, 1e300}, coordinates);
  expect_refused({kNan, -kInfinite, -1.0, -0x1p-1074}, errors);
}

TEST_F(ForgedFrames, AreRefusedForEachJointThatIsNoNumberOrMovedByLessThanNothing) {
  ASSERT_FALSE(built[0].postures.joints.empty());
  for (std::size_t joint = 0; joint < built[0].postures.joints.size(); ++joint) {
    for (const double value : {kNan, kInfinite, -kInfinite, 1e30}) {
      BuiltFrame forged = built[0];
      forged.postures.joints[joint].known = true;
      forged.postures.joints[joint].position = value;
      EXPECT_FALSE(is_built(forged)) << joint << ": " << value;
    }
    for (const double value : {kNan, -1.0, -0x1p-1074}) {
      BuiltFrame forged = built[0];
      forged.postures.joints[joint].known = true;
      forged.postures.joints[joint].may_have_moved = value;
      EXPECT_FALSE(is_built(forged)) << joint << ": " << value;
    }
  }
}

TEST_F(ForgedFrames, AreRefusedFromAPlaceThatIsNotKnown) {
  BuiltFrame forged = built[0];
  forged.place.known = false;
  EXPECT_FALSE(is_built(forged));
}

TEST_F(ForgedFrames, MayLackWhatIsNotKnown) {
  BuiltFrame frame = built[0];
  for (PastPose& object : frame.postures.objects)
    object = {.known = false, .world_from_body = {}, .shift_error = kNan, .turn_error = -1.0};
  for (PlacedPostures::Joint& joint : frame.postures.joints) joint = {false, kNan, kNan};
  EXPECT_TRUE(is_built(frame));
}

}  // namespace
}  // namespace clearance::sensors_test
