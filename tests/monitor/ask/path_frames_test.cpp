// Oracle: the closed form of an arm that swings in a plane.
#include "monitor/ask/path_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance::path_frames_test {
namespace {

const double kUnknown = std::numeric_limits<double>::quiet_NaN();

TEST(PathFrames, PlaceTheMovedLinksAlongTheMotion) {
  const Scene scene = test::scara_beside(test::kPin);
  Question question = test::swing(-1.0, 0.6);
  question.held = {{"push", 0.1}};
  const std::vector<double> present = {kUnknown, 0.5, kUnknown};  // the elbow is bent
  const std::vector<Pose> carriers(1);
  const std::vector<double> more = {1.25};
  const auto frames = path_frames(scene, question, present, carriers, 5, more);
  ASSERT_EQ(frames.size(), 6u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double time = std::vector{0.0, 0.5, 1.0, 1.25, 1.5, 2.0}[i];
    EXPECT_EQ(frames[i].time, time);
    ASSERT_EQ(frames[i].links.size(), 3u) << "the foot stands";
    const double angle = -1.0 + 0.8 * time;
    const auto finger = std::ranges::find_if(frames[i].links, [&](const PathFrame::Placed& link) {
      return scene.objects[link.object].name == "finger";
    });
    ASSERT_NE(finger, frames[i].links.end());
    const Vec3 expected(std::cos(angle) + 1.1 * std::cos(angle + 0.5),
                        std::sin(angle) + 1.1 * std::sin(angle + 0.5), 0.0);
    EXPECT_LT((finger->world_from_object.position - expected).norm(), 1e-12) << time;
  }
}

TEST(PathFrames, LeaveOutWhatIsBehindAJointThatIsNowhere) {
  const Scene scene = test::scara_beside(test::kPin);
  Question question = test::swing(-1.0, 0.6);
  question.held.clear();
  const std::vector<double> present = {0.0, kUnknown, 0.0};
  const std::vector<Pose> carriers(1);
  const auto frames = path_frames(scene, question, present, carriers, 2, {});
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_EQ(frames[0].links.size(), 1u);
  EXPECT_EQ(scene.objects[frames[0].links[0].object].name, "upper");
  question.motion.times = {1.0, 0.0};
  EXPECT_TRUE(path_frames(scene, question, present, carriers, 2, {}).empty());
}

}  // namespace
}  // namespace clearance::path_frames_test
