// What a camera sees of a robot is in the daemon's health.
//
// Oracle: the boxes of an arm lie across the camera's axis, so the residual of each of its pixels
// is the offset that its depth was made with.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/shared/ros_joints.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/camera_daemon.hpp"

namespace clearance::test {
namespace {

class DaemonWitness : public DaemonCameras {
 protected:
  void SetUp() override {
    start(kImage +
              ", witness: true, mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, "
              "0]}}",
          {}, "pose: {xyz: [0.5, 3, 1]}");
    camera.change_image = [&](sensor_msgs_msg_dds__Image_& image) {
      auto* const depth = reinterpret_cast<float*>(image.data._buffer);
      for (std::uint32_t v = 0; v < image.height; ++v) {
        for (std::uint32_t u = 0; u < image.width; ++u) {
          const Vec3 on_arm = 1.95 * camera.made.ray(u, v);
          // The end face of the lower link, too: what is nearer than it proves nothing.
          const bool on_upper = std::abs(on_arm.x()) < 0.4,
                     on_lower = std::abs(on_arm.x() - 1) < 0.42;
          if (std::abs(on_arm.y()) < 0.05 && (on_upper || on_lower))
            depth[v * image.width + u] =
                static_cast<float>(1.95 + farther + (on_lower ? lower_farther : 0.0));
        }
      }
    };
    ASSERT_TRUE(camera.is_heard() && joints.is_heard());
  }
  // Sends pictures of an arm that is `by` farther than its joints say, until health says `so`.
  template <class So>
  bool sees(double by, const So& so) {
    farther = by;
    const auto send_joints = [&] { joints.send({"shoulder", "elbow", "push"}, {0, 0, 0.1}); };
    const auto step = [&] {
      send_joints();
      camera.send_image({.wall = 2.8, .ball = {}});  // it hides the foot
      send_joints();
    };
    return step_until(5, step, [&] {
      while (take_next(reader, health)) {
      }
      return health->witnesses._length > 0 && so(health->witnesses._buffer[0]);
    });
  }

  RosCamera camera{client, {}};
  RosJoints joints{client};
  double farther = 0.0, lower_farther = 0.0;  // m
  Sample<clearance_msg_Health> health;
  dds_entity_t reader = client.reader(TopicKind::kHealth, Topics{}.health);
};

TEST_F(DaemonWitness, HealthSaysHowFarARobotIsSeenFromWhereItsJointsSay) {
  for (const double by : {0.0, 0.001, -0.0015}) {
    ASSERT_TRUE(sees(by,
                     [&](const clearance_msg_WitnessHealth& of) {
                       return of.agreeing > 24 && std::abs(of.residual_p50 - by) < 1e-6;
                     }))
        << by << daemon->output();
    const clearance_msg_WitnessHealth& of = health->witnesses._buffer[0];
    EXPECT_STREQ(of.sensor, "eye");
    EXPECT_STREQ(of.robot, "arm");
    EXPECT_EQ(of.through, 0u);
    EXPECT_FALSE(of.denied);
    EXPECT_NEAR(of.residual_p90, std::abs(by), 1e-6);
  }
}

TEST_F(DaemonWitness, HealthAndWatchNameTheLinkThatIsFarthestFromItsPlace) {
  ChildProcess watch(kWatch, with({"--plain"}, dds_arguments(dds)));
  lower_farther = 0.0013;
  const auto of_lower = [&]() -> const clearance_msg_WitnessHealth* {
    for (std::uint32_t i = 0; i < health->witnesses._length; ++i)
      if (health->witnesses._buffer[i].link == std::string("lower"))
        return &health->witnesses._buffer[i];
    return nullptr;
  };
  ASSERT_TRUE(sees(0.0003, [&](const clearance_msg_WitnessHealth&) {
    return of_lower() != nullptr && std::abs(of_lower()->residual_p50 - 0.0016) < 1e-6;
  })) << daemon->output();
  EXPECT_STREQ(of_lower()->robot, "arm");
  EXPECT_LT(of_lower()->agreeing, health->witnesses._buffer[0].agreeing) << "those of the arm";
  const std::string most = "most at lower: 1.6 mm";
  ASSERT_TRUE(sees(0.0003, [&](const auto&) { return watch.wrote(most); })) << watch.output();
}

TEST_F(DaemonWitness, HealthSaysThatARobotIsNotThere) {
  ASSERT_TRUE(sees(1.0, [](const clearance_msg_WitnessHealth& of) { return of.denied; }))
      << daemon->output();
  const clearance_msg_WitnessHealth& of = health->witnesses._buffer[0];
  EXPECT_GT(of.through, 24u);
  EXPECT_EQ(of.agreeing, 0u);
  EXPECT_TRUE(std::isnan(of.residual_p50) && std::isnan(of.residual_p90)) << "no ray agrees";
}

}  // namespace
}  // namespace clearance::test
