// clearance-robot simulates the cameras of a cell: images, CameraInfo and points over DDS, as ROS 2
// has them, and people whom the cell does not know.
//
// Oracles: the projection of a box by hand, and the stated bound of the depth error.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/ros_types.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/ros_reader.hpp"
#include "tests/tools/running_cell.hpp"
#include "tools/rendering/person.hpp"
#include "tools/rendering/simulated_world.hpp"

namespace clearance::test {
namespace {

using Image = sensor_msgs_msg_dds__Image_;
using Points = sensor_msgs_msg_dds__PointCloud2_;
using Info = sensor_msgs_msg_dds__CameraInfo_;

// Two cameras 2 m above a floor look down at a box of 0.8 m x 0.8 m, whose top is at 0.5 m.
const std::string kBoxBelow = R"(name: below
units: {length: m, angle: deg}
rate_hz: 100
objects:
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}
  - {name: box, fixed: true, box: {size: [0.8, 0.8, 0.5]}, pose: {xyz: [0, 0, 0.25]}}
  - {name: ball, sphere: {radius: 0.1}}
sensors:
  - name: eye
    depth_image: /eye/depth
    size: [320, 240]
    depth_error: {constant: 0.002, quadratic: 0.001}
    range: [0.3, 4]
    mount: {pose: {xyz: [0, 0, 2], rpy: [180, 0, 0]}}
  - name: scanner
    points: /scanner/points
    depth_error: {constant: 0.002, quadratic: 0.001}
    range: [0.3, 4]
    mount: {pose: {xyz: [0, 0, 2], rpy: [180, 0, 0]}}
pairs:
  - {between: [ball, eye]}
  - {between: [ball, scanner]}
  - {between: [ball, box]}
  - {between: [ball, floor]}
simulation:
  movers:
    - {object: ball, centre: {xyz: [3, 3, 1]}}
)";
double error_at(double z) { return 0.002 + 0.001 * z * z; }

class SimulatedCamerasTest : public testing::Test {
 protected:
  // Starts the robot on the cell with more arguments.
  void start(const std::string& text, const std::vector<std::string>& more = {}) {
    cell.emplace(text);
    robot.emplace(kRobot, with(with({cell->path(), "--rate", "50", "--camera-rate", "10"}, more),
                               dds_arguments(dds)));
  }
  int end() {
    robot->signal(SIGTERM);
    return robot->wait();
  }
  // Runs the daemon and the robot on a cell with the arm of camera.yaml and a person.
  void judge(const std::string& file);

  DdsOptions dds = own_dds();
  Participant client{dds};
  std::optional<CellFile> cell;
  std::optional<ChildProcess> robot;
};

std::int64_t stamp_of(const std_msgs_msg_dds__Header_& header) {
  return header.stamp.sec * std::int64_t{1'000'000'000} + header.stamp.nanosec;
}

TEST_F(SimulatedCamerasTest, SendDepthImagesOfTheBodiesOfTheCell) {
  RosReader<Image> images(client, kRosImage, "rt/eye/depth");
  RosReader<Info> infos(client, kRosCameraInfo, "rt/eye/camera_info");
  start(kBoxBelow);
  const Info* const info = infos.next();
  ASSERT_NE(info, nullptr) << robot->output();
  const double fx = info->k[0], cx = info->k[2], fy = info->k[4], cy = info->k[5];
  EXPECT_NEAR(2.0 * std::atan(160.0 / fx) * 180.0 / std::numbers::pi, 60.0, 1e-9);
  std::int64_t before = 0;
  std::set<std::vector<std::uint16_t>> different;
  for (int i = 0; i < 4; ++i) {
    const Image* const image = images.next();
    ASSERT_NE(image, nullptr) << robot->output();
    EXPECT_STREQ(image->encoding, "16UC1");
    EXPECT_GT(stamp_of(image->header), before);
    before = stamp_of(image->header);
    ASSERT_EQ(image->data._length, 320u * 240u * 2u);
    std::vector<std::uint16_t> pixels(320 * 240);
    std::memcpy(pixels.data(), image->data._buffer, image->data._length);
    std::size_t missing = 0;
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
      if (pixels[pixel] == 0) {
        ++missing;
        continue;
      }
      // The box covers +-0.4 m at a depth of 1.5 m; its sides are seen by no ray from above its
      // middle.
      const double x = (static_cast<double>(pixel % 320) - cx) / fx;
      const double y = (static_cast<double>(pixel / 320) - cy) / fy;
      const double widest = std::max(std::abs(x), std::abs(y)) * 1.5;
      if (std::abs(widest - 0.4) < 1e-9) continue;
      const double truth = widest < 0.4 ? 1.5 : 2.0;
      ASSERT_LE(std::abs(0.001 * pixels[pixel] - truth), error_at(truth) + 1e-12) << pixel;
    }
    EXPECT_NEAR(static_cast<double>(missing) / static_cast<double>(pixels.size()), 0.01, 0.004);
    different.insert(std::move(pixels));
  }
  EXPECT_EQ(different.size(), 4u);
  EXPECT_EQ(end(), 0);
  EXPECT_TRUE(robot->wrote("frames sent, 0 failed")) << robot->output();
}

TEST_F(SimulatedCamerasTest, SendPointsAndWhatTheCellDoesNotKnow) {
  RosReader<Points> clouds(client, kRosPointCloud2, "rt/scanner/points");
  start(kBoxBelow, {"--camera-missing", "0", "--person", "0.7,0:0.9,0", "--person-speed", "0.1"});
  const Points* const cloud = clouds.next();
  ASSERT_NE(cloud, nullptr) << robot->output();
  ASSERT_EQ(cloud->width * cloud->height, 320u * 240u);
  ASSERT_EQ(cloud->point_step, 16u);
  std::size_t of_person = 0, of_box = 0;
  for (std::size_t i = 0; i < 320 * 240; ++i) {
    float point[3];
    std::memcpy(point, cloud->data._buffer + 16 * i, sizeof point);
    if (std::isnan(point[2])) continue;
    of_box += std::abs(point[2] - 1.5F) <= error_at(1.5) && std::abs(point[0]) < 0.39F;
    of_person += point[2] < 1.4F && point[2] > 0.3F && point[0] > 0.3F;
  }
  EXPECT_GT(of_box, 5000u);
  EXPECT_GT(of_person, 500u);
}

// The mast swings above the floor, and the camera hangs 0.5 m below its frame. No message names a
// place: a picture agrees with the frame's transforms at its stamp only.
TEST_F(SimulatedCamerasTest, HangOnAFrameOfTfThatTheSimulationSends) {
  std::string text = kBoxBelow;
  const std::string mount = "mount: {pose: {xyz: [0, 0, 2], rpy: [180, 0, 0]}}";
  text.replace(text.find(mount), mount.size(),
               "mount: {frame: mast, pose: {xyz: [0, 0, -0.5], rpy: [180, 0, 0]}}");
  text.replace(text.find("rate_hz"), 0, "ros2: {world_frame: map}\n");
  text +=
      "    - {frame: mast, centre: {xyz: [0, 0, 2.5]}, amplitude: [0, 0, 0.3], frequency_hz: "
      "0.5}\n";
  RosReader<Image> images(client, kRosImage, "rt/eye/depth");
  RosReader<tf2_msgs_msg_dds__TFMessage_> transforms(client, kRosTf, "rt/tf");
  start(text, {"--camera-missing", "0", "--camera-noise", "0"});
  std::map<std::int64_t, double> heights;
  double least = 9.0, most = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Image* const image = images.next();
    ASSERT_NE(image, nullptr) << robot->output();
    const std::int64_t stamp = stamp_of(image->header);
    while (heights.empty() || heights.rbegin()->first < stamp) {
      const auto* const message = transforms.next();
      ASSERT_NE(message, nullptr) << robot->output();
      ASSERT_EQ(message->transforms._length, 1u);
      const auto& mast = message->transforms._buffer[0];
      EXPECT_STREQ(mast.header.frame_id, "map");
      EXPECT_STREQ(mast.child_frame_id, "mast");
      heights[stamp_of(mast.header)] = mast.transform.translation.z;
    }
    const auto after = heights.lower_bound(stamp);
    if (after == heights.begin()) continue;
    const auto before = std::prev(after);
    std::uint16_t corner = 0;
    std::memcpy(&corner, image->data._buffer, sizeof corner);
    const double share = static_cast<double>(stamp - before->first) /
                         static_cast<double>(after->first - before->first);
    const double height = before->second + share * (after->second - before->second) - 0.5;
    EXPECT_NEAR(0.001 * corner, height, 0.003) << "the floor, in the corner of the picture";
    least = std::min(least, height);
    most = std::max(most, height);
  }
  EXPECT_GT(most - least, 0.1) << "it has moved";
}

TEST_F(SimulatedCamerasTest, AreLeftOutWhereTheCellDoesNotStateTheirPlace) {
  std::string text = kBoxBelow;
  const std::string mount = "    mount: {pose: {xyz: [0, 0, 2], rpy: [180, 0, 0]}}\n";
  text.erase(text.find(mount), mount.size());
  start(text, {"--seconds", "0.2"});
  EXPECT_EQ(robot->wait(), 0);
  EXPECT_TRUE(robot->wrote("no camera is simulated")) << robot->output();
  EXPECT_TRUE(robot->wrote("where eye is")) << robot->output();
  start(kBoxBelow, {"--camera-size", "320"});
  EXPECT_EQ(robot->wait(), 2);
  start(kBoxBelow, {"--person", "1,0"});
  EXPECT_EQ(robot->wait(), 2);
}

// The zones of such a cell are left once the picture shows enough that is known.
TEST_F(SimulatedCamerasTest, AreUsedInCellsToStartFrom) {
  const ScratchFolder folder;
  write_text(folder / "arm.urdf", kScaraUrdf);
  const std::string file = folder / "cell.yaml";
  for (const char* bodies : {"camera", "table,person,camera"}) {
    ChildProcess made(
        kScene, {"new", "--robots", folder / "arm.urdf", "--on", bodies, "-o", file, "--force"});
    ASSERT_EQ(made.wait(), 0) << made.output();
    robot.emplace(kRobot, with({file, "--swing", "0.1"}, dds_arguments(dds)));
    ChildProcess daemon(kDaemon, with({file}, dds_arguments(dds)));
    const auto is_left = [&] { return daemon.told("zone-left", {" - camera'"}); };
    EXPECT_TRUE(eventually(is_left)) << bodies << ": " << daemon.output();
    end();
  }
}

void SimulatedCamerasTest::judge(const std::string& file) {
  ChildProcess daemon(kDaemon, with({file}, dds_arguments(dds)));
  std::size_t pairs = 0;
  for (int attempt = 0; attempt < 8 && pairs < 10; ++attempt) {
    ChildProcess simulated(kRobot, with({file, "--swing", "0.3", "--person", "1.8,-0.3:1.45,-0.15",
                                         "--camera-rate", "15", "--truth", "--seconds", "4"},
                                        dds_arguments(dds)));
    EXPECT_EQ(simulated.wait(), 0);
    EXPECT_FALSE(simulated.wrote(" 0 pixels")) << simulated.output();
    // "truth    hand - camera: 41 reports, least true distance ..., 0 not within the bounds"
    std::istringstream lines(simulated.output());
    pairs = 0;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("truth ") || line.find(", least true ") == line.npos) continue;
      pairs += line.find("camera") != line.npos;  // others are of two bodies
      EXPECT_TRUE(line.ends_with(", 0 not within the bounds")) << line;
    }
  }
  EXPECT_EQ(pairs, 10u);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
}

// A simulated person reaches the report: no bound is above the truth that the simulator knows. The
// simulator says so at its end, for as many reports as a busy machine has let it compare.
TEST_F(SimulatedCamerasTest, AndTheDaemonsBoundsAreNeverAboveWhatTheySaw) {
  judge(places::sources() + "/config/cells/camera.yaml");
}

// The text of that cell with other words in it, for a file that is elsewhere.
std::string camera_cell(const std::vector<std::pair<std::string, std::string>>& changes) {
  const std::string cells = places::sources() + "/config/cells/";
  std::string text = read_text(cells + "camera.yaml");
  const auto replace = [&](const std::string& before, const std::string& now) {
    for (std::size_t at = 0; (at = text.find(before, at)) != text.npos; at += now.size())
      text.replace(at, before.size(), now);
  };
  replace("seven_joint_arm/", cells + "seven_joint_arm/");
  for (const auto& [before, now] : changes) replace(before, now);
  return text;
}

// The same camera on a mast that sways, whose place comes by tf.
TEST_F(SimulatedCamerasTest, AndTheDaemonsBoundsAreNeverAboveWhatCamerasOnTfSaw) {
  const CellFile moved(
      camera_cell({{"mount: {pose:", "mount: {frame: mast, pose:"}}) +
      "\nros2: {world_frame: map}\nsimulation: {movers: [{frame: mast, amplitude: [0.1, 0.1, "
      "0], frequency_hz: 0.3}]}\n");
  judge(moved.path());
}

// This one knows the bodies of the cell. Until the person comes, it sees nothing else.
TEST_F(SimulatedCamerasTest, AndTheDaemonsBoundsAreNeverAboveWhatCamerasThatKnowTheCellSaw) {
  const CellFile known(
      camera_cell({{"    range: [0.3, 5]", "    range: [0.3, 5]\n    knows: true"}}));
  judge(known.path());
}

TEST(WalkingPerson, MovesWithoutLeapsAndNoFasterThanItSays) {
  const auto path = read_walking_path("2,0:1,0.5:0.8,-0.4,0.1");
  WalkingPerson person(std::get<WalkingPath>(path), 0.7);
  constexpr double kStep_s = 1e-3;
  const double most = person.max_speed() * kStep_s * (1.0 + 1e-6);
  std::vector<Vec3> before;
  double nearest = 9.0, fastest = 0.0;
  for (double t = 0.0; t < 1.2 * person.period_s(); t += kStep_s) {
    person.place(t);
    std::vector<Vec3> ends;
    for (const WalkingPerson::Limb& limb : person.limbs()) {
      for (const Vertex& vertex : limb.shape.vertices) {
        // The farthest points of the rounding, too.
        for (const double side : {-1.0, 1.0})
          ends.push_back(transform(limb.world_from_limb,
                                   vertex.position + Vec3(0, 0, side * limb.shape.radius)));
      }
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_LE((ends[i] - before[i]).norm(), most) << "at " << t;
      fastest = std::max(fastest, (ends[i] - before[i]).norm() / kStep_s);
    }
    for (const Vec3& end : ends)
      nearest = std::min(nearest, (end - Vec3(0.8, -0.4, end.z())).norm());
    before = std::move(ends);
  }
  EXPECT_LT(nearest, 0.01);
  EXPECT_GT(fastest, 0.5 * person.max_speed());
}

TEST(WalkingPerson, RefusesPathsThatLeadNowhere) {
  for (const char* const text :
       {"", "1,2", "1,2:1,2", "1:2", "1,2:x,3", "1,2:3,4,5,6", "1,2:1e9,0"})
    EXPECT_TRUE(std::holds_alternative<std::string>(read_walking_path(text))) << text;
}

// A frame of tf may be the world's, a link's or an object's: a daemon needs no transform then.
TEST(SimulatedWorld, HasThePlacesOfCamerasInFramesOfTf) {
  auto cell = std::get<Cell>(read_cell(places::sources() + "/config/cells/camera.yaml"));
  cell.ros.world_frame = "map";
  std::ranges::find(cell.scene.objects, "shelf", &Object::name)->frame = "rack";
  cell.simulation.frames = {{"mast", {.centre = {Vec3(1, 2, 3), Eigen::Quaterniond::Identity()}}}};
  SimulatedWorld world(cell,
                       [&cell](double, std::vector<JointSample>& joints) {
                         joints.assign(cell.scene.variables.size(), {});
                         for (std::uint32_t i = 0; i < joints.size(); ++i) joints[i].variable = i;
                       },
                       {});
  world.place(0.0);
  Sensor sensor = cell.scene.sensors[0];
  sensor.mount = {};
  sensor.mount.frame_from_root.position = {0, 0, 0.5};
  const auto position_in = [&](const std::string& frame) {
    sensor.mount.frame = frame;
    const auto found = world.sensor(sensor);
    EXPECT_EQ(found.has_value(), has_place(cell, sensor)) << frame;
    return found ? found->position : Vec3(-9, -9, -9);
  };
  EXPECT_EQ(position_in("map"), Vec3(0, 0, 0.5));
  EXPECT_EQ(position_in("mast"), Vec3(1, 2, 3.5));
  EXPECT_LT((position_in("rack") - Vec3(-1.0, -0.4, 0.95)).norm(), 1e-12);
  EXPECT_EQ(position_in("shelf"), Vec3(-9, -9, -9)) << "the name of an object is no frame";
  EXPECT_LT((position_in("shoulder") - Vec3(0, 0, 0.5 + 0.14 + 0.5)).norm(), 1e-12);
  EXPECT_EQ(position_in("elsewhere"), Vec3(-9, -9, -9));
  sensor.mount = {};
  sensor.frames_by_message = true;
  EXPECT_FALSE(world.sensor(sensor).has_value());
  cell.simulation.frames[0].name = sensor.name;
  EXPECT_EQ(world.sensor(sensor)->position, Vec3(1, 2, 3));
}

// The bodies of a robot are where its joints put them, as the tick finds it.
TEST(SimulatedWorld, HasTheFixedBodiesTheRobotAndThePeople) {
  const auto cell = std::get<Cell>(read_cell(places::sources() + "/config/cells/camera.yaml"));
  const auto path = std::get<WalkingPath>(read_walking_path("3,0:2,0"));
  SimulatedWorld world(cell,
                       [&cell](double t_s, std::vector<JointSample>& joints) {
                         joints.assign(cell.scene.variables.size(), {});
                         for (std::uint32_t i = 0; i < joints.size(); ++i) joints[i].variable = i;
                         joints[0].position = t_s;
                       },
                       {WalkingPerson(path, 0.5)});
  world.place(0.7);
  std::map<std::uint32_t, std::size_t> counts;
  for (const rendering::PlacedBody& body : world.bodies()) ++counts[body.label];
  EXPECT_EQ(counts[SimulatedWorld::kPerson], 6u);
  for (std::uint32_t i = 0; i < cell.scene.objects.size(); ++i) {
    const Object& object = cell.scene.objects[i];
    EXPECT_EQ(counts[i], object.is_seen() ? 0u : object.parts.size()) << object.name;
  }
  // All joints but the first one are 0: the arm stands upright and has turned about the vertical.
  const auto hand = std::ranges::find(cell.scene.objects, "hand", &Object::name);
  const std::optional<Pose>& place =
      world.object(static_cast<std::uint32_t>(hand - cell.scene.objects.begin()));
  ASSERT_TRUE(place.has_value());
  const double height = 0.5 + 0.14 + 0.2 + 0.24 + 0.16 + 0.24 + 0.16 + 0.06 + 0.01;
  EXPECT_LT((place->position - Vec3(0, 0, height)).norm(), 1e-12);
  EXPECT_LT((place->orientation * Vec3::UnitX() - Vec3(std::cos(0.7), std::sin(0.7), 0)).norm(),
            1e-12);
  const auto seen = world.sensor(cell.scene.sensors[0]);
  ASSERT_TRUE(seen.has_value());
  EXPECT_LT((seen->position - Vec3(1.2, 2.4, 1.9)).norm(), 1e-12);
}

}  // namespace
}  // namespace clearance::test
