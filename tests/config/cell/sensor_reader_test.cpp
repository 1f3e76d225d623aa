// The sensors of a cell: what each sees is an object, and each of its keys is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;

// A mistake in this line, at any column, whose message has the words.
template <class... Words>
auto in_line(int line, const Words&... words) {
  return testing::AllOf(testing::HasSubstr("cell.yaml:" + std::to_string(line) + ":"),
                        testing::HasSubstr(words)...);
}

std::string with_sensor(const std::string& keys, const std::string& rules = "") {
  return cell_text("sensors:\n  - {name: eye, " + keys + "}\n" + kBoxes +
                   (rules.empty() ? "  - {between: [arm, eye]}\n" : rules));
}
const std::string kDepth =
    "depth_image: /cam/depth/image, depth_error: {constant: 0.001, quadratic: 0.002}, range: "
    "[0.25, 4]";
const std::string kPoints = "points: /cam/points, depth_error: {constant: 0.001}, range: [0.25, 4]";

TEST(SensorsOfACell, AreObjectsThatPairsName) {
  const Scene scene = scene_of(
      with_sensor(kDepth + ", groups: [eyes], margin: 0.1", "  - {between: [arm, eyes]}\n"));
  ASSERT_EQ(scene.sensors.size(), 1u);
  const Sensor& sensor = scene.sensors[0];
  const Object& seen = scene.objects.at(sensor.object);
  EXPECT_EQ(sensor.object, 3u);
  EXPECT_EQ(seen.name, "eye");
  EXPECT_EQ(seen.sensor, 0u);
  EXPECT_EQ(seen.margin, 0.1);
  EXPECT_EQ(seen.age_limit_ns, 100'000'000);
  EXPECT_EQ(seen.max_speed, kInfinity);
  EXPECT_FALSE(seen.fixed);
  EXPECT_FALSE(scene.objects[0].is_seen());
  EXPECT_EQ(sensor.topic, "/cam/depth/image");
  EXPECT_EQ(sensor.camera_info, "/cam/depth/camera_info");
  EXPECT_TRUE(sensor.frames_by_message);
  EXPECT_EQ(sensor.error_at(2.0), 0.001 + 0.002 * 4.0);
  EXPECT_EQ(sensor.columns, 640u);
  EXPECT_EQ(sensor.rows, 480u);
  EXPECT_EQ(scene.pairs.size(), 4u);  // two boxes against floor and sensor
}

TEST(SensorsOfACell, StateTheirShellsAndTheirRate) {
  const auto sensor = [](const std::string& keys) {
    return scene_of(with_sensor(kDepth + keys)).sensors[0];
  };
  EXPECT_EQ(sensor("").most_shell, 0.3);
  EXPECT_EQ(sensor(", own_shell: 0.4").most_shell, 0.4);
  EXPECT_EQ(sensor(", own_shell: 0.02, most_shell: 0.05").most_shell, 0.05);
  EXPECT_EQ(sensor("").least_interval_ns, 0);
  EXPECT_EQ(sensor(", most_hz: 50").least_interval_ns, 20'000'000);
  EXPECT_EQ(sensor("").stamp_error_ns, 0);
  EXPECT_EQ(sensor(", stamp_error_ms: 20").stamp_error_ns, 20'000'000);
  EXPECT_EQ(sensor("").stamps, RosStamps::kMessage);
  EXPECT_EQ(sensor(", stamps: sent").stamps, RosStamps::kSent);
  const auto points = [](const std::string& keys) {
    return scene_of(with_sensor(kPoints + keys)).sensors[0];
  };
  EXPECT_FALSE(points(", spacing: 0.01").by_neighbours);
  EXPECT_TRUE(points(", spacing: neighbours").by_neighbours);
  EXPECT_EQ(points(", spacing: neighbours").spacing, 0.0);
  EXPECT_THAT(errors_of(with_sensor(kPoints + ", spacing: neighbors")),
              in_line(5, "'neighbors'", "'neighbours'"));
}

TEST(SensorsOfACell, StateWhatTheyKnowAndWhenTheirPicturesLive) {
  const auto sensor = [](const std::string& keys) {
    return scene_of(with_sensor(kDepth + keys)).sensors[0];
  };
  EXPECT_EQ(sensor("").trusted_shell, 0.1);
  EXPECT_EQ(sensor(", trusted_shell: 0.05").trusted_shell, 0.05);
  EXPECT_EQ(sensor(", own_shell: 0.2").trusted_shell, 0.2);
  EXPECT_TRUE(sensor("").has_noise);
  EXPECT_FALSE(sensor(", noise: none").has_noise);
  EXPECT_EQ(sensor(", least_seen: 0.7").least_seen, 0.7);
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", noise: some")), in_line(5, "'some'", "none"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", least_seen: 1.1")), in_line(5, "1.1"));
  for (const char* const key : {"noise: none", "least_seen: 0.5"}) {
    EXPECT_THAT(errors_of(with_sensor(std::string("octomap: /map, ") + key)),
                in_line(5, "depth images and points only"));
  }

  EXPECT_FALSE(sensor("").knows);
  EXPECT_TRUE(known_bodies(scene_of(with_sensor(kDepth))).empty());
  const Scene scene = scene_of(with_sensor(kDepth + ", knows: true"));
  EXPECT_EQ(known_bodies(scene), (std::vector<std::uint32_t>{0, 1, 2})) << "floor and boxes";
  EXPECT_EQ(hidden_pairs(scene).size(), 2u) << "of the sensor with each box";
}

TEST(SensorsOfACell, ContainAllThatTheySeeInABall) {
  for (const std::string& keys :
       {kDepth, kPoints + ", spacing: 0.01", kPoints + ", spacing: neighbours"}) {
    const Scene scene = scene_of(with_sensor(keys));
    const Sensor& sensor = scene.sensors[0];
    ASSERT_EQ(scene.objects[3].parts.size(), 1u);
    const double radius = scene.objects[3].parts[0].shape.radius;
    // The corner of the farthest slab that a picture can have, and half of the ball at it.
    const double z = 4.0 + sensor.error_at(4.0);
    const Vec3 corner(kWidestTangent * z, kWidestTangent * z, z);
    EXPECT_GE(sensor.extent(), corner.norm() + z * sensor.spacing * std::sqrt(0.5));
    EXPECT_LE(sensor.extent(), (sensor.by_neighbours ? 1.3 : 1.2) * corner.norm());
    EXPECT_EQ(radius, sensor.view_radius()) << "where its place has the largest error that counts";
    EXPECT_GE(radius, 2.0 * sensor.extent());
  }
}

TEST(SensorsOfACell, HavePairsWithFixedObjectsButNotWithUnboundedOnesOrEachOther) {
  const std::string two =
      "sensors:\n  - {name: eye, " + kDepth + "}\n  - {name: ear, " + kPoints + "}\n" + kBoxes;
  EXPECT_EQ(scene_of(cell_text(two + "  - {between: [arm, eye]}\n  - {between: [left, ear]}\n"))
                .pairs.size(),
            5u);
  EXPECT_THAT(errors_of(cell_text(two + "  - {between: [arm, eye]}\n  - {between: [eye, ear]}\n")),
              mistake_at("cell.yaml:14:5", "'eye'", "'ear'"));
  EXPECT_THAT(
      errors_of(cell_text(two + "  - {between: [arm, ear]}\n  - {between: [eye, still]}\n")),
      mistake_at("cell.yaml:14:5", "'eye'", "'still'"));
}

TEST(SensorsOfACell, StandWhereTheirMountSays) {
  const auto mount = [](const std::string& text) {
    return scene_of(with_sensor(kDepth + ", mount: {" + text + "}")).sensors[0];
  };
  const Sensor on_world = mount("pose: {xyz: [1, 2, 3]}");
  EXPECT_FALSE(on_world.frames_by_message);
  EXPECT_EQ(on_world.mount.kind, RobotBase::Kind::kWorld);
  EXPECT_EQ(on_world.mount.base_from_root.position, Vec3(1, 2, 3));
  const Sensor on_object = mount("on: right, pose: {xyz: [0, 0, 1]}");
  EXPECT_EQ(on_object.mount.kind, RobotBase::Kind::kObject);
  EXPECT_EQ(on_object.mount.object, 1u);
  const Sensor in_frame = mount("frame: /head, pose: {xyz: [0, 0, 1]}");
  EXPECT_EQ(in_frame.mount.frame, "head");
  EXPECT_EQ(in_frame.mount.frame_from_root.position, Vec3(0, 0, 1));
  EXPECT_FALSE(in_frame.mount_speed.is_stated());
  const Sensor moving = mount("frame: head, max_speed: 0.5, max_turn_speed: 0.2");
  EXPECT_EQ(moving.mount_speed.shift, 0.5);
  EXPECT_NEAR(moving.mount_speed.turn, 0.2 * std::numbers::pi / 180.0, 1e-15);
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {frame: head, max_speed: 0.5}")),
              in_line(5, "'max_speed'", "'max_turn_speed'"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {on: right, max_speed: 0.5}")),
              in_line(5, "'max_speed'"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {on: rigth}")),
              in_line(5, "'rigth'", "'right'"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {on: eye}")), in_line(5, "'eye'"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {on: right, frame: a}")),
              in_line(5, "'on'"));
  EXPECT_THAT(errors_of(with_sensor(kDepth + ", mount: {}")),
              in_line(5, "'pose'", "'on'", "'frame'"));
}

TEST(SensorsOfACell, ConvertTheirErrorFromTheUnitOfTheCell) {
  const std::string cell =
      "name: test\nunits: {length: mm, angle: deg}\n"
      "sensors:\n  - {name: eye, depth_image: /d/i, depth_error: {constant: 1, quadratic: 2.5e-6}, "
      "range: [250, 4000]}\n" +
      kBoxes + "  - {between: [arm, eye]}\n";
  const Sensor sensor = scene_of(cell).sensors[0];
  EXPECT_DOUBLE_EQ(sensor.error_constant, 0.001);
  EXPECT_DOUBLE_EQ(sensor.error_quadratic, 0.0025);
  EXPECT_DOUBLE_EQ(sensor.greatest_depth, 4.0);
}

TEST(SensorsOfACell, StateWhatIsLeftOutAndLookedFor) {
  const Sensor plain = scene_of(with_sensor(kDepth)).sensors[0];
  EXPECT_EQ(plain.persist_frames, 1u);
  EXPECT_FALSE(plain.unseen);
  EXPECT_TRUE(plain.crop.empty());
  EXPECT_EQ(notes_of(plain).size(), 1u) << "unseen places are not looked for";
  const Sensor sensor =
      scene_of(with_sensor(kDepth + ", unseen: true, max_speed: 1, persist: {frames: 3, of: 5}"))
          .sensors[0];
  EXPECT_EQ(sensor.persist_frames, 3u);
  EXPECT_EQ(sensor.persist_of, 5u);
  EXPECT_TRUE(sensor.unseen);
  EXPECT_EQ(notes_of(sensor).size(), 1u) << "what comes into view is hidden at first";
}

TEST(SensorsOfACell, AreRefusedWhereAKeyIsWrong) {
  const auto refuses = [](const std::string& keys, const std::string& word) {
    EXPECT_THAT(errors_of(with_sensor(keys)), in_line(5, word)) << keys;
  };
  const std::string rest = ", depth_error: {constant: 0.001}, range: [0.25, 4]";
  refuses("depth_image: cam" + rest, "'cam'");
  refuses("depth_error: {constant: 0.001}, range: [0.25, 4]", "none");
  refuses("depth_image: /a, points: /b" + rest, "several");
  refuses("points: /b, camera_info: /a" + rest, "'camera_info'");
  refuses("points: /b, size: [2, 2]" + rest, "'size'");
  refuses("depth_image: /b, most_points: 7" + rest, "'most_points'");
  refuses("depth_image: /b, spacing: 0.1" + rest, "'spacing'");
  refuses("depth_image: /b, size: [4000, 4000]" + rest, "16000000 pixels");
  refuses("points: /b, depth_along: x" + rest, "'x'");
  refuses("depth_image: /b, depth_error: {constant: 0.3}, range: [0.25, 4]", "depth_error");
  refuses("depth_image: /b, depth_error: {quadratic: 0.3}, range: [0.25, 1]", "'constant'");
  refuses("depth_image: /b, depth_error: {constant: 0.1}, range: [4, 2]", "least");
  refuses("depth_image: /b, depth_error: {constant: 0.1}, range: 4", "[0.3, 4]");
  refuses(kDepth + ", shell: 1", "'shell'");
  refuses(kDepth + ", own_shell: 0.2, most_shell: 0.1", "most_shell of 0.1 m");
  refuses(kDepth + ", most_hz: 0", "rate of frames");
  refuses(kPoints + ", unseen: true", "no camera");
  refuses(kPoints + ", spacing: neighbours, unseen: true", "depth image of this camera");
  refuses("octomap: /map, unseen: true", "'unseen' of an octomap");
  refuses(kDepth + ", persist: {frames: 2, of: 3}", "'max_speed'");
  refuses(kDepth + ", max_speed: 1, persist: {frames: 4, of: 3}", "4");
  refuses(kDepth + ", max_speed: 1, persist: {frames: 1, of: 17}", "17");
  refuses(kDepth + ", reach: 0.5", "no robot");
  EXPECT_THAT(errors_of(cell_text("sensors:\n  - {name: a, " + kDepth + "}\n  - {name: b, " +
                                  kDepth + "}\n" + kBoxes)),
              in_line(6, "'/cam/depth/image'", "line 5"));
}

// A camera measures no speeds: a person whom it sees has the stated one.
TEST(SensorsOfACell, StandForPeopleWithAStatedSpeedOnly) {
  const std::string terms =
      "reaction_time_ms: 10, stopping_time_ms: 100, stopping_distance: 0.1, "
      "intrusion_distance: 0}}]\n";
  const auto with = [&](const std::string& keys) {
    return with_sensor(kDepth,
                       "  - {between: [arm, eye]}\nzones: [{name: z, between: [arm, eye], "
                       "enter_below: 0.1, leave_above: 0.2, separation: {" +
                           keys + terms);
  };
  EXPECT_FALSE(scene_of(with("human: eye, robot_speed: 1, ")).zones[0].separation->human_speed);
  EXPECT_THAT(errors_of(with("human: eye, human_speed_measured: true, human_acceleration: 5, ")),
              testing::HasSubstr("the sensor 'eye', which measures no speeds"));
  EXPECT_THAT(errors_of(with("human: arm, ")),
              testing::HasSubstr("the sensor 'eye' on the robot's side"));
}

}  // namespace
}  // namespace clearance
