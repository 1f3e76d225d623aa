// A cell of two arms, the true machine behind it, and a camera that looks at it with noise within
// the stated bound.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
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

namespace clearance::test {

inline constexpr std::uint32_t kEyeColumns = 320, kEyeRows = 240;
inline constexpr double kEyeFocal = 260.0;

inline const std::string kWitnessEye =
    "sensors:\n  - {name: eye, depth_image: /cam/image, size: [320, 240], depth_error: {constant: "
    "0.004, quadratic: 0.001}, range: [0.3, 6], witness: true, mount: {pose: {xyz: [1.9, 0, 1.5], "
    "rpy: [-1.8, 0, 1.5708]}}}\n";

// The shipped cell of two arms, with a camera that looks at them, and an obstacle pair for it.
inline Cell two_arms_and_eye(const std::string& errors = "") {
  const std::string file = places::sources() + "/config/cells/seven_joint_arms.yaml";
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
    exact_ = drawn_errors(Scene{}, random_);
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
  DrawnErrors& errors() noexcept { return exact_; }
  Vec3& camera_shift() noexcept { return camera_shift_; }
  // Between two pictures.
  void set_period(std::int64_t period_ns) noexcept { period_ns_ = period_ns; }
  // Bodies that the camera sees and the cell does not know. The shapes must outlive this.
  std::vector<rendering::PlacedBody>& others() noexcept { return others_; }
  // Places one of them in a link of the true machine, for the pictures that follow.
  void hold(const ConvexBody* shape, std::uint32_t object, const Pose& object_from_shape) {
    held_ = shape;
    holder_ = object;
    object_from_held_ = object_from_shape;
  }
  // The cell has this object, and the machine does not: what it stands for is held or beside it.
  void leave_to_the_cell(std::uint32_t object) { imagined_.insert(object); }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  [[nodiscard]] SensorStatus status() const { return sensors_.status(0); }
  // The true place of an object in the last picture.
  [[nodiscard]] const Pose& place(std::uint32_t object) const { return poses_[object]; }
  std::vector<double>& positions() noexcept { return positions_; }

  // A picture, and the tick that gets it. Returns the rays that met the robot.
  RaysOfRobot look(std::uint32_t robot) {
    now_ += period_ns_;
    ++frame_;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < positions_.size(); ++v)
      joints.push_back(joint(v, positions_[v], now_));
    sensors_.add({}, joints, now_);
    monitor_.tick({}, joints, now_);
    send_picture();
    sensors_.settle(
        now_ + 25'000'000, [&](const SeenCloud* cloud) { return monitor_.uses(cloud); },
        [&](std::uint32_t sensor, const SensorFrame& frame) { monitor_.show(sensor, frame); });
    now_ += kTick;
    for (JointSample& sample : joints) sample.stamp_ns = now_;
    sensors_.add({}, joints, now_);
    monitor_.tick({}, joints, now_);
    return sensors_.status(0).robots[robot].rays;
  }
  // Of an object from what the camera sees, m.
  [[nodiscard]] PairReport distance_from_seen(std::uint32_t object) const {
    for (std::uint32_t p = 0; p < cell_.scene.pairs.size(); ++p) {
      const auto& pair = cell_.scene.pairs[p];
      const std::uint32_t eye = cell_.scene.sensors[0].object;
      if ((pair.first == object && pair.second == eye) ||
          (pair.first == eye && pair.second == object))
        return monitor_.pair(p);
    }
    ADD_FAILURE() << cell_.scene.objects[object].name << " has no pair with the camera";
    return {};
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
    poses_ = true_poses(scene, truth, std::vector<Pose>(scene.objects.size()), exact_);
    std::vector<rendering::PlacedBody> bodies = others_;
    if (held_ != nullptr) bodies.push_back({held_, compose(poses_[holder_], object_from_held_), 0});
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].is_seen() || imagined_.contains(i)) continue;
      for (const Part& part : scene.objects[i].parts)
        bodies.push_back({&part.shape, compose(poses_[i], part.object_from_part), i});
    }
    Pose camera = scene.sensors[0].mount.base_from_root;
    const auto& [shift, turn] = exact_.objects[scene.sensors[0].object];
    camera.position += camera_shift_ + camera.orientation * shift;
    if (turn.norm() > 0.0)
      camera.orientation = camera.orientation * Eigen::AngleAxisd(turn.norm(), turn.normalized());
    renderer_.render(camera, bodies);
    std::vector<std::byte> bytes;
    rendering::measure(renderer_.depth(), DepthImage::Format::kMillimetres16,
                       {.bound = {.constant = 0.004, .quadratic = 0.001},
                        .range = {.least = 0.3, .greatest = 6.0},
                        .missing_share = 0.02,
                        .seed = 7},
                       frame_, bytes);
    camera::InfoText info;
    info.width = kEyeColumns;
    info.height = kEyeRows;
    info.k = {kEyeFocal, 0, 159.5, 0, kEyeFocal, 119.5, 0, 0, 1};
    info.p = {kEyeFocal, 0, 159.5, 0, 0, kEyeFocal, 119.5, 0, 0, 0, 1, 0};
    info.stamp_ns = now_;
    camera::ImageText image;
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
  DrawnErrors exact_;
  Vec3 camera_shift_ = Vec3::Zero();
  std::vector<rendering::PlacedBody> others_;
  std::set<std::uint32_t> imagined_;
  const ConvexBody* held_ = nullptr;
  std::uint32_t holder_ = 0;
  Pose object_from_held_;
  std::vector<Pose> poses_;
  std::int64_t now_ = camera::kStart, period_ns_ = camera::kFrame;
  std::uint64_t frame_ = 0;
};

inline std::uint32_t variable_of(const Cell& cell, const std::string& name) {
  for (std::uint32_t v = 0; v < cell.scene.variables.size(); ++v)
    if (cell.scene.variables[v].name == name) return v;
  ADD_FAILURE() << name;
  return 0;
}

}  // namespace clearance::test
