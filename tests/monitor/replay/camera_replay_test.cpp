// A bag with depth images or points, and joints, becomes distances.
//
// Oracle: the scene that is rendered into the images, by closed forms for boxes, spheres and the
// points where rays meet them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "monitor/replay/offline_replay.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/clouds/rendered_scene.hpp"
#include "tests/monitor/recording/ros_camera.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::camera_replay_test {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kBagStart = 1'700'000'000'000'000'000, kStep = 10'000'000, kFrameSteps = 10;
constexpr int kSteps = 60;
const PinholeCamera kView{80, 60, 60.0, 61.0, 39.7, 29.2};
constexpr DepthError kError{0.002, 0.001};
const std::vector<std::string> kLinks{"foot", "upper", "lower", "finger"};

std::array<double, 3> positions(int step) {
  return {-0.4 + 0.01 * step, 0.6 - 0.015 * step, 0.001 * step};
}

// The bodies of the links where the joints place them, numbered from 0, and the surroundings from
// 10 on: a floor, a box and a ball.
std::vector<RenderedBody> scene_at(const std::array<double, 3>& q) {
  const auto turn = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
  };
  const Vec3 elbow = turn(q[0]) * Vec3::UnitX();
  const Eigen::Quaterniond forearm = turn(q[0] + q[1]);
  std::vector<RenderedBody> out;
  out.push_back(rendered_box({0, 0, -1}, {0.1, 0.1, 0.1}, 0));
  out.push_back(rendered_box(turn(q[0]) * Vec3(0.5, 0, 0), {0.4, 0.05, 0.05}, 1));
  out.back().world_from_body.orientation = turn(q[0]);
  out.push_back(rendered_box(elbow + forearm * Vec3(0.5, 0, 0), {0.4, 0.05, 0.05}, 2));
  out.back().world_from_body.orientation = forearm;
  out.push_back(rendered_sphere(elbow + forearm * Vec3(1.0 + q[2], 0, 0), 0.05, 3));
  out.push_back(rendered_box({0, 0, -1.6}, {5, 5, 0.1}, 10));
  out.push_back(rendered_box({0.6, -0.7, 0.1}, {0.1, 0.15, 0.2}, 11));
  out.push_back(rendered_sphere({1.3, 0.75, 0.05}, 0.15, 12));
  return out;
}

Pose camera_place() {
  Pose place;
  place.position = {0.9, 0.0, 2.2};
  place.orientation = Eigen::Quaterniond(0, 1, 0, 0);  // it looks down
  return place;
}

double distance_to(const RenderedBody& body, const Vec3& point) {
  const Vec3 local =
      body.world_from_body.orientation.conjugate() * (point - body.world_from_body.position);
  if (body.radius > 0.0) return local.norm() - body.radius;
  return (local.cwiseAbs() - body.half).cwiseMax(0.0).norm();
}

// A point that a pixel has seen, and the size of the slab around it.
struct SeenPoint {
  Vec3 at;
  double size;
};

// An arm below a camera that looks down, with such messages.
Cell scara_with_eye(const ScratchFolder& folder, const std::string& messages) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  return read_good(
      "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n"
      "sensors:\n  - {name: eye, " +
          messages +
          ", depth_error: {constant: 0.002, quadratic: 0.001}, range: [0.3, 5], "
          "own_shell: 0.005, age_limit_ms: 150, mount: "
          "{pose: {xyz: [0.9, 0, 2.2], rpy: [3.141592653589793, 0, 0]}}}\n"
          "pairs:\n  - {between: [arm, eye]}\n",
      folder / "cell.yaml");
}

// What a camera sends, and how the cell states it.
struct Form {
  const char* name;
  const char* messages;
  bool is_image, in_rows;
  double reach = 1.0;  // of elements, in the size of a pixel
};
class CameraReplayOf : public testing::TestWithParam<Form> {};

TEST_P(CameraReplayOf, ABagWithJointsGivesTrueDistances) {
  const ScratchFolder folder;
  const Form form = GetParam();
  const Cell cell = scara_with_eye(folder, form.messages);
  std::vector<RosMessage> bag;
  if (form.is_image) bag.push_back(camera_info(kBagStart, kView));
  std::map<std::int64_t, std::vector<SeenPoint>> frames;  // by stamp: what is not the robot
  Random random(5);
  for (int step = 0; step < kSteps; ++step) {
    const std::int64_t stamp = kBagStart + step * kStep;
    const auto q = positions(step);
    bag.push_back(
        joint_state(stamp, stamp, {{"shoulder", "elbow", "push"}, {q[0], q[1], q[2]}, {}, {}}));
    if (step % kFrameSteps != 0) continue;
    const std::vector<RenderedPixel> pixels = render(scene_at(q), kView, camera_place());
    const std::vector<float> depth = measured(pixels, kError, 0.9, random);
    bag.push_back(form.is_image ? depth_image(stamp, kView, depth)
                                : points_of(stamp, kView, depth, form.in_rows));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (pixels[i].number < 10 || std::isnan(depth[i])) continue;
      const double z = depth[i], e = kError.at(z);
      // Corners of a pixel are at most a pixel apart across, 1.4 m a metre along the corner ray.
      const double size = 1.3 * (2.0 * e + 1.5 * (z + e) / kView.fx);
      frames[stamp].push_back({pixels[i].in_world, size});
    }
  }
  write_mcap_bag(folder / "run.mcap", bag);

  int rows = 0, near = 0, shells = 0;
  std::int64_t newest = 0;
  const OfflineReplay replay = replay_offline(
      cell, folder / "run.mcap", {.tick_hz = 0.0, .evaluate_all = true},
      [&](const ReplayedTick& tick) {
        const std::int64_t now = tick.report.now_ns;
        if ((now - kBagStart) % (kStep * kFrameSteps) == 0) newest = now;
        const auto step = static_cast<int>((now - kBagStart) / kStep);
        const std::vector<RenderedBody> bodies = scene_at(positions(step));
        for (const PairReport& pair : tick.report.pairs) {
          if (pair.status == PairStatus::kUnknown) continue;
          const ObjectPair& objects = tick.cell.scene.pairs[pair.pair];
          const std::string& name =
              tick.cell.scene
                  .objects[tick.cell.scene.objects[objects.first].is_seen() ? objects.second
                                                                            : objects.first]
                  .name;
          const auto link =
              static_cast<std::size_t>(std::ranges::find(kLinks, name) - kLinks.begin());
          ASSERT_LT(link, kLinks.size());
          double exact = kInfinity, least = kInfinity;
          for (const SeenPoint& point : frames.at(newest)) {
            const double d = distance_to(bodies[link], point.at);
            exact = std::min(exact, d);
            least = std::min(least, d - form.reach * point.size);
          }
          ++rows;
          near += exact < 0.5 ? 1 : 0;
          EXPECT_LE(pair.lower, exact + 1e-9) << name << " " << step;
          EXPECT_GE(pair.lower, least - 1e-9) << name << " " << step;
        }
        for (const HiddenReport& hidden : tick.report.hidden) {
          if (hidden.elements == 0 || !std::isfinite(hidden.thickness)) continue;
          ++shells;
          EXPECT_GT(hidden.thickness, 0.005);
          EXPECT_LT(hidden.thickness, 0.3);
        }
      });
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_GT(rows, 4 * 50);
  EXPECT_GT(near, 50);
  EXPECT_GT(shells, 50);
}
INSTANTIATE_TEST_SUITE_P(
    All, CameraReplayOf,
    testing::Values(Form{"DepthImages", "depth_image: /cam/depth, size: [80, 60]", true, true},
                    Form{"Points", "points: /cam/points", false, false},
                    Form{"PointsWithASpacing", "points: /cam/points, spacing: 0.0167", false, true},
                    Form{"PointsWithNeighbours", "points: /cam/points, spacing: neighbours", false,
                         true, 2.0}),
    [](const auto& form) { return form.param.name; });

// The texts of the failures of a bag with joints, one image on /cam/depth and, if it is said, the
// image's CameraInfo.
std::vector<std::string> failures(const std::string& topic, bool has_info) {
  const ScratchFolder folder;
  const Cell cell = scara_with_eye(folder, "depth_image: " + topic + ", size: [80, 60]");
  std::vector<RosMessage> bag{
      joint_state(kBagStart, kBagStart, {{"shoulder", "elbow", "push"}, {0, 0, 0}, {}, {}}),
      depth_image(kBagStart, kView, std::vector<float>(80 * 60, 1.0F))};
  if (has_info) bag.insert(bag.begin(), camera_info(kBagStart, kView));
  write_mcap_bag(folder / "run.mcap", bag);
  std::vector<std::string> texts;
  for (const auto& each : replay_offline(cell, folder / "run.mcap").failures)
    texts.push_back(each.what);
  return texts;
}

// A camera whose topic is spelt wrongly would leave every distance to it unknown, without a word.
TEST(CameraReplay, FailsWhereABagHasNoMessageOfASensorAndListsTheTopicsThatItHas) {
  EXPECT_THAT(failures("/camera/depth", true),
              testing::ElementsAre(testing::HasSubstr("/cam/depth")));
}

TEST(CameraReplay, FailsWhereOnlyTheCameraInfoOfASensorIsThere) {
  EXPECT_THAT(failures("/cam/depht", true), testing::ElementsAre(testing::HasSubstr("/cam/depth")));
}

TEST(CameraReplay, FailsWhereAnImageHasNoCameraInfoAndNamesItsTopic) {
  EXPECT_THAT(failures("/cam/depth", false),
              testing::ElementsAre(testing::HasSubstr("/cam/camera_info")));
}

}  // namespace
}  // namespace clearance::camera_replay_test
