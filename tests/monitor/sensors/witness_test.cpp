// A camera tells where a robot is not where its joints say. Pictures are rendered of a machine that
// is off its model, with noise within the stated bound.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "monitor/sensors/sensors.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/intake/camera_texts.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/places.hpp"
#include "tools/rendering/depth_renderer.hpp"
#include "tools/rendering/measured_depth.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kEyeColumns = 320, kEyeRows = 240;
constexpr double kEyeFocal = 260.0;

const std::string kWitnessEye =
    "sensors:\n  - {name: eye, depth_image: /cam/image, size: [320, 240], depth_error: {constant: "
    "0.004, quadratic: 0.001}, range: [0.3, 6], witness: true, mount: {pose: {xyz: [1.9, 0, 1.5], "
    "rpy: [-1.8, 0, 1.5708]}}}\n";

// The shipped cell of two arms, with a camera that looks at them, and an obstacle pair for it.
Cell two_arms_and_eye(const std::string& errors = "") {
  const std::string file = test::places::sources() + "/config/cells/seven_joint_arms.yaml";
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string pairs = "pairs:\n";
  text.insert(text.find(pairs) + pairs.size(),
              "  - between: [left, eye]\n  - between: [right, eye]\n");
  return read_good(text + kWitnessEye + errors, file);
}

// A cell, the machine behind it, and its camera.
class WitnessedCell {
 public:
  explicit WitnessedCell(Cell cell, std::uint64_t seed = 1)
      : cell_(std::move(cell)),
        sensors_(cell_, SensorsOptions{.is_log = false}),
        monitor_(cell_.scene),
        random_(seed),
        renderer_({.width = kEyeColumns,
                   .height = kEyeRows,
                   .fx = kEyeFocal,
                   .fy = kEyeFocal,
                   .cx = 159.5,
                   .cy = 119.5}),
        off_(cell_.scene.variables.size(), 0.0) {
    exact_ = test::drawn_errors(Scene{}, random_);
    exact_.bases.resize(cell_.scene.robots.size());
    exact_.objects.resize(cell_.scene.objects.size());
    for (const Robot& robot : cell_.scene.robots) {
      exact_.frames.emplace_back(robot.joints.size());
      exact_.positions.emplace_back(robot.joints.size(), 0.0);
    }
    for (const JointVariable& variable : cell_.scene.variables)
      positions_.push_back(std::clamp(0.4, variable.lower, variable.upper));
  }

  // What the true machine is off its model by.
  std::vector<double>& off() noexcept { return off_; }
  test::DrawnErrors& errors() noexcept { return exact_; }
  Vec3& camera_shift() noexcept { return camera_shift_; }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  std::vector<double>& positions() noexcept { return positions_; }

  // A picture, and the tick that gets it. Returns the rays that met the robot.
  RaysOfRobot look(std::uint32_t robot) {
    now_ += test::camera::kFrame;
    ++frame_;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < positions_.size(); ++v)
      joints.push_back(test::joint(v, positions_[v], now_));
    sensors_.add({}, joints, now_);
    monitor_.tick({}, joints, now_);
    send_picture();
    sensors_.settle(
        now_ + 25'000'000, [&](const SeenCloud* cloud) { return monitor_.uses(cloud); },
        [&](std::uint32_t sensor, const SensorFrame& frame) { monitor_.show(sensor, frame); });
    now_ += test::kTick;
    for (JointSample& sample : joints) sample.stamp_ns = now_;
    sensors_.add({}, joints, now_);
    monitor_.tick({}, joints, now_);
    return sensors_.status(0).robots[robot].rays;
  }
  // Pictures until the robot is denied; 0: it is not in `most` of them.
  int pictures_until_denied(std::uint32_t robot, int most = 12) {
    for (int i = 1; i <= most; ++i) {
      look(robot);
      if (is_unknown(robot)) return i;
    }
    return 0;
  }
  [[nodiscard]] bool is_unknown(std::uint32_t robot) const {
    for (const RobotLink& link : cell_.scene.robots[robot].links) {
      if (link.object == RobotLink::kNoObject || cell_.scene.objects[link.object].fixed) continue;
      return monitor_.present_pose(link.object).state == PresentPose::State::kContradicted;
    }
    return false;
  }

 private:
  void send_picture() {
    const Scene& scene = cell_.scene;
    std::vector<double> truth = positions_;
    for (std::size_t v = 0; v < truth.size(); ++v) truth[v] += off_[v];
    const std::vector<Pose> poses =
        test::true_poses(scene, truth, std::vector<Pose>(scene.objects.size()), exact_);
    std::vector<rendering::PlacedBody> bodies;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].is_seen()) continue;
      for (const Part& part : scene.objects[i].parts)
        bodies.push_back({&part.shape, compose(poses[i], part.object_from_part), i});
    }
    Pose camera = scene.sensors[0].mount.base_from_root;
    camera.position += camera_shift_;
    renderer_.render(camera, bodies);
    std::vector<std::byte> bytes;
    rendering::measure(renderer_.depth(), DepthImage::Format::kMillimetres16,
                       {.bound = {.constant = 0.004, .quadratic = 0.001},
                        .range = {.least = 0.3, .greatest = 6.0},
                        .missing_share = 0.02,
                        .seed = 7},
                       frame_, bytes);
    test::camera::InfoText info;
    info.width = kEyeColumns;
    info.height = kEyeRows;
    info.k = {kEyeFocal, 0, 159.5, 0, kEyeFocal, 119.5, 0, 0, 1};
    info.p = {kEyeFocal, 0, 159.5, 0, 0, kEyeFocal, 119.5, 0, 0, 0, 1, 0};
    info.stamp_ns = now_;
    test::camera::ImageText image;
    image.width = kEyeColumns;
    image.height = kEyeRows;
    image.step = 2 * kEyeColumns;
    image.stamp_ns = now_;
    image.data.resize(bytes.size());
    std::memcpy(image.data.data(), bytes.data(), bytes.size());
    add(RawSensorMessage::Type::kCameraInfo, "/cam/camera_info", info.cdr());
    add(RawSensorMessage::Type::kImage, "/cam/image", image.cdr());
  }
  void add(RawSensorMessage::Type type, const std::string& topic,
           const std::vector<std::byte>& cdr) {
    sensors_.add({.type = type, .topic = topic, .sent_ns = now_ + 1000, .writer = 1, .cdr = cdr},
                 {.realtime_ns = now_ + 1000, .monotonic_ns = now_ + 1000});
  }

  Cell cell_;
  Sensors sensors_;
  Monitor monitor_;
  Random random_;
  rendering::DepthRenderer renderer_;
  std::vector<double> positions_, off_;
  test::DrawnErrors exact_;
  Vec3 camera_shift_ = Vec3::Zero();
  std::int64_t now_ = test::camera::kStart;
  std::uint64_t frame_ = 0;
};

std::uint32_t variable_of(const Cell& cell, const std::string& name) {
  for (std::uint32_t v = 0; v < cell.scene.variables.size(); ++v)
    if (cell.scene.variables[v].name == name) return v;
  ADD_FAILURE() << name;
  return 0;
}

TEST(SecondWitness, AgreesWithAMachineThatIsAsStated) {
  WitnessedCell watched(two_arms_and_eye());
  for (int i = 0; i < 12; ++i) {
    for (std::size_t v = 0; v < watched.positions().size(); ++v)
      watched.positions()[v] += 0.002 * std::sin(0.3 * i + static_cast<double>(v));
    const RaysOfRobot rays = watched.look(0);
    EXPECT_GT(rays.agreeing, 100u);
    EXPECT_EQ(rays.through, 0u);
    EXPECT_LT(std::abs(rays.residual_p50), 0.001);
    EXPECT_GE(rays.residual_p90, std::abs(rays.residual_p50));
    EXPECT_LT(rays.residual_p90, 0.0105) << "the noise at the greatest depth of the arm";
    EXPECT_FALSE(watched.is_unknown(0));
    EXPECT_FALSE(watched.is_unknown(1));
  }
}

// The mean of the medians of eight pictures, m; the robot must not be denied meanwhile.
double mean_residual(WitnessedCell& watched, std::uint32_t robot) {
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    sum += watched.look(robot).residual_p50;
    EXPECT_FALSE(watched.is_unknown(robot));
  }
  return sum / 8;
}

// A median over hundreds of rays is sure to a small part of the noise, which is 8 mm here. Most of
// these rays meet links that a lost zero of the second joint hardly moves.
TEST(SecondWitness, ShowsALostZeroBeforeItDeniesTheRobot) {
  const auto residual = [](double lost, const std::string& errors, std::uint32_t robot = 0) {
    WitnessedCell watched(two_arms_and_eye(errors));
    watched.off()[variable_of(watched.cell(), "left_joint2")] = lost;
    return mean_residual(watched, robot);
  };
  const std::string stated = "errors: {joints: {position: 0.02}}\n";
  for (const std::string& errors : {std::string(), stated}) {
    const double good = residual(0.0, errors);
    EXPECT_LT(std::abs(good), 0.0002) << errors;
    EXPECT_LT(residual(0.004, errors), good - 0.0001) << "nearer: " << errors;
    EXPECT_GT(residual(-0.004, errors), good + 0.0001) << "farther: " << errors;
  }
  EXPECT_GT(residual(-0.01, stated), residual(-0.004, stated)) << "it grows with the fault";
  EXPECT_NEAR(residual(0.004, stated, 1), residual(0.0, stated, 1), 1e-6) << "the other arm";
}

TEST(SecondWitness, SeesALostZeroOfAJointInFivePictures) {
  WitnessedCell watched(two_arms_and_eye());
  watched.off()[variable_of(watched.cell(), "left_joint2")] = -0.2;
  EXPECT_EQ(watched.pictures_until_denied(0), 5);
  EXPECT_FALSE(watched.is_unknown(1)) << "the other arm is where its joints say";
}

// Something nearer than the robot may stand in front of it.
TEST(SecondWitness, IsNotSureOfWhatIsNearer) {
  WitnessedCell watched(two_arms_and_eye());
  watched.off()[variable_of(watched.cell(), "left_joint2")] = 0.2;
  EXPECT_EQ(watched.pictures_until_denied(0), 0);
}

TEST(SecondWitness, TakesARobotBackAfterFivePicturesOfIt) {
  WitnessedCell watched(two_arms_and_eye());
  const std::uint32_t lift = variable_of(watched.cell(), "left_joint2");
  watched.off()[lift] = -0.2;
  ASSERT_GT(watched.pictures_until_denied(0), 0);
  watched.off()[lift] = 0.0;
  for (int i = 1; i < 5; ++i) {
    watched.look(0);
    EXPECT_TRUE(watched.is_unknown(0)) << i;
  }
  watched.look(0);
  EXPECT_FALSE(watched.is_unknown(0));
}

TEST(SecondWitness, SeesABumpedCamera) {
  WitnessedCell watched(two_arms_and_eye());
  watched.camera_shift() = Vec3(0.0, 0.06, 0.0);
  EXPECT_GT(watched.pictures_until_denied(0), 0);
}

// The smallest of these sizes with which a fault is found, in either direction, within 5
// pictures; infinity: none.
template <class Apply>
double smallest_found(const Apply& apply, std::initializer_list<double> sizes) {
  for (const double size : sizes) {
    for (const double sign : {1.0, -1.0}) {
      WitnessedCell watched(two_arms_and_eye());
      // The arm is stretched to the side, so that its links stand apart.
      watched.positions()[variable_of(watched.cell(), "left_joint1")] = 1.2;
      watched.positions()[variable_of(watched.cell(), "left_joint4")] = 0.9;
      apply(watched, sign * size);
      if (watched.pictures_until_denied(0, 5) > 0) return size;
    }
  }
  return kInfinity;
}

TEST(SecondWitness, FindsSmallFaults) {
  const std::initializer_list<double> angles = {0.01, 0.02, 0.04}, lengths = {0.005, 0.01};
  for (const auto& [joint, most] :
       {std::pair("left_joint1", 0.04), {"left_joint2", 0.01}, {"left_joint4", 0.02}}) {
    const auto lose_zero = [&, name = joint](WitnessedCell& watched, double by) {
      watched.off()[variable_of(watched.cell(), name)] = by;
    };
    const double found = smallest_found(lose_zero, angles);
    EXPECT_LE(found, most) << joint;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto bump_base = [&](WitnessedCell& watched, double by) {
      watched.errors().bases[0].shift[axis] = by;
    };
    const auto bump_camera = [&](WitnessedCell& watched, double by) {
      watched.camera_shift()[axis] = by;
    };
    const double base = smallest_found(bump_base, lengths);
    const double camera = smallest_found(bump_camera, lengths);
    EXPECT_LE(std::max(base, camera), 0.01) << axis;
  }
}

TEST(SecondWitness, AllowsWhatIsStated) {
  WitnessedCell strict(two_arms_and_eye()),
      allowing(two_arms_and_eye("errors: {joints: {position: 0.02}}\n"));
  for (WitnessedCell* watched : {&strict, &allowing})
    watched->off()[variable_of(watched->cell(), "left_joint2")] = -0.02;
  EXPECT_EQ(allowing.pictures_until_denied(0), 0);
  EXPECT_EQ(allowing.look(0).through, 0u);
  EXPECT_GT(strict.look(0).through, 0u);
}

}  // namespace
}  // namespace clearance
