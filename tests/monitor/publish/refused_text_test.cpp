// Each cause is told with the part of the value that it is about. The samples go through the tick.
#include "monitor/publish/refused_text.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <string>

#include "tests/monitor/tick/two_balls.hpp"

namespace clearance::test {
namespace {

// The sample that a tick refuses after a good one.
std::string text_of_refused(PoseSample bad) {
  Scene scene = balls_of_speed(1.0);
  scene.future_limit_ns = 1'000'000;
  Monitor monitor(scene);
  tick_with(monitor, 0, at(1, 2, 3), kStart);
  monitor.tick(std::span(&bad, 1), kStart + 1'000'000);
  return text_of(monitor.refused_poses()[0]);
}

PoseSample good() { return sample(0, at(1, 2, 3), kStart + 1'000'000); }

TEST(RefusedText, IsEmptyWhereNothingWasRefused) { EXPECT_EQ(text_of_refused(good()), ""); }

TEST(RefusedText, TellsThePlaceThatLeapt) {
  PoseSample bad = good();
  bad.world_from_object = at(4, 5, 6.25);
  EXPECT_EQ(text_of_refused(bad), "(4, 5, 6.25) m");
  bad.has_twist = true;
  bad.twist.linear = Vec3(3, 0, 4);
  EXPECT_EQ(text_of_refused(bad), "(4, 5, 6.25) m at 5 m/s");
}

TEST(RefusedText, TellsTheQuaternionTheStampAndWhatIsNoNumber) {
  PoseSample bad = good();
  bad.world_from_object.orientation = Eigen::Quaterniond(0.5, 0, 0, 0);
  EXPECT_EQ(text_of_refused(bad), "(0, 0, 0, 0.5)");
  bad = good();
  bad.stamp_ns = kStart - 3'000'000'000;
  EXPECT_EQ(text_of_refused(bad), "stamped 3.001 s ago");
  bad.stamp_ns = kStart + 3'600'000'000'000;
  EXPECT_EQ(text_of_refused(bad), "stamped 3600 s ahead");
  bad.stamp_ns = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(text_of_refused(bad).substr(0, 8), "stamped ");
  bad = good();
  bad.world_from_object.position.y() = std::numeric_limits<double>::quiet_NaN();
  bad.world_from_object.position.z() = 1e300;
  EXPECT_EQ(text_of_refused(bad), "(1, nan, inf) m, quaternion (0, 0, 0, 1)");
}

}  // namespace
}  // namespace clearance::test
