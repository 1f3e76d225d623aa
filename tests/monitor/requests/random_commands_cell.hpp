// The cell of the campaign of random commands: where its bodies are, and who sends their poses.
#pragma once

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/loop/ports.hpp"
#include "tests/config/edit/drawn_change.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/poses.hpp"

namespace clearance::test {

// The cell's robot has the URDF kScaraUrdf, in the file scara.urdf.
inline const std::string kRandomCommandsCell = R"(name: campaign
units: {length: m, angle: rad}
rate_hz: 500
commands: {from: [planner], folders: [allowed]}
capacity: {objects: 2, parts: 4, pairs: 20, bytes: 20000}
templates:
  - {name: bin, box: {size: [0.2, 0.15, 0.1]}}
  - {name: rod, groups: [things], capsule: {from: [0, 0, -0.2], to: [0, 0, 0.2], radius: 0.03}}
  - name: twin
    margin: 0.01
    parts:
      - {name: left, sphere: {radius: 0.07}, pose: {xyz: [-0.1, 0, 0]}}
      - {name: right, box: {size: [0.1, 0.1, 0.1]}, pose: {xyz: [0.1, 0, 0], rpy: [0.5, 0, 0.2]}}
robots:
  - {name: arm, urdf: scara.urdf}
objects:
  - {name: table, groups: [things], fixed: true, pose: {xyz: [0.8, 0.9, 0]}, box: {size: [0.5, 0.5, 0.1]}}
  - {name: cart, groups: [movers], max_speed: 15, box: {size: [0.3, 0.2, 0.2]}} # on wheels
  - name: drone
    groups: [movers]
    parts:
      - {name: hull, capsule: {from: [-0.2, 0, 0], to: [0.2, 0, 0], radius: 0.05}}
      - {name: dome, sphere: {radius: 0.1}, pose: {xyz: [0, 0, 0.1]}}
  - {name: part, groups: [things], fixed: true, pose: {xyz: [2.1, 0, 0]}, box: {size: [0.1, 0.1, 0.1]}}
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -0.6}}
pairs:
  - {between: [arm, things]}
  - {between: [movers, things], publish: false} # most of them are far
  - {between: [movers, arm]}
  - {between: [movers, floor], publish: false}
allowed_collisions:
  - {between: [upper, part], reason: never near}
zones:
  - {name: stop, between: [finger, table], enter_below: 0.1, leave_above: 0.15}
  - {name: slow, between: [movers, things], enter_below: 0.2, leave_above: 0.25}
  - {name: arm_zone, between: [arm, things], enter_below: 0.05, leave_above: 0.08}
contacts:
  - {name: c0, between: [finger, part], depth: 0.05, by: test, reason: it grasps}
)";

// The joints shoulder, elbow and push.
using ArmPosition = std::array<double, 3>;

// The poses of everything that moves by itself: every name may become such an object.
struct Places {
  std::map<std::string, Pose> poses;
  ArmPosition arm{};
};

// Poses of the robot's links in closed form.
inline Pose link_in_world(const std::string& name, const ArmPosition& arm) {
  const auto swung = [](double angle) { return turned(Vec3::UnitZ(), angle); };
  const Pose upper{Vec3::Zero(), swung(arm[0])};
  const Pose lower{swung(arm[0]) * Vec3::UnitX(), swung(arm[0] + arm[1])};
  if (name == "upper") return upper;
  if (name == "lower") return lower;
  if (name == "finger")
    return {lower.position + lower.orientation * Vec3(1.0 + arm[2], 0, 0), lower.orientation};
  return {};
}

inline Pose composed(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.position + a_from_b.orientation.normalized() * b_from_c.position,
          (a_from_b.orientation * b_from_c.orientation).normalized()};
}

// The poses of all objects of a scene, by index.
inline std::vector<Pose> in_world(const Scene& scene, const Places& places) {
  std::vector<Pose> poses;
  for (const Object& object : scene.objects) {
    const auto sent = places.poses.find(object.name);
    poses.push_back(object.fixed                 ? object.world_from_object
                    : sent == places.poses.end() ? link_in_world(object.name, places.arm)
                                                 : sent->second);
  }
  for (const Robot& robot : scene.robots) {  // carriers come first
    if (!robot.is_attached) continue;
    const RobotBase& base = robot.base;
    const std::uint32_t on = base.kind == RobotBase::Kind::kObject
                                 ? base.object
                                 : scene.robots[base.robot].links[base.link].object;
    poses[robot.links[0].object] = composed(poses[on], base.base_from_root);
  }
  return poses;
}

// The joint variables of `arm`, and the objects whose poses are sent, by name.
inline bool is_sent(const Scene& scene, std::uint32_t object) {
  const auto has = [&](const RobotLink& link) { return link.object == object; };
  return !scene.objects[object].fixed && std::ranges::none_of(scene.robots, [&](const Robot& r) {
    return std::ranges::any_of(r.links, has);
  });
}

// One batch per sender and tick, on the path from one place to the next.
class RandomSenders final : public PoseSource {
 public:
  static constexpr int kTicksOfMotion = 40;

  explicit RandomSenders(Clock& clock) : clock_(clock) {
    for (const char* name : {"robot", "camera"}) batches_.emplace_back().source = SourceName(name);
  }

  // The members up to next() are for the test, while the loop waits.
  // Sends for this scene from now on, all but what is silent ("arm": the joints).
  void send_for(const Scene& scene, const std::set<std::string>& silent) {
    scene_ = &scene;
    objects_.clear();
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      const Object& object = scene.objects[i];
      const bool is_known =
          object.source.empty() || object.source == "robot" || object.source == "camera";
      if (object.source == "camera") of_camera_.insert(object.name);
      if (object.source == "robot") of_camera_.erase(object.name);
      if (is_sent(scene, i) && is_known && !silent.contains(object.name)) objects_.push_back(i);
    }
    sends_joints_ = !silent.contains("arm");
  }
  void begin_motion(const Places& to) {
    from_ = now_;
    to_ = to;
    tick_ = 0;
  }
  void place(const Places& places) { from_ = to_ = now_ = places; }
  [[nodiscard]] const Places& now() const { return now_; }
  // The stamp of the last pose that was sent for an object, or of the joints ("arm").
  std::map<std::string, std::int64_t> last_sent;

  // Any thread: the motion goes on from the next tick on.
  std::atomic<bool> moves{false};

  const PoseBatch* next() noexcept override {
    if (turn_ == 0) fill();
    if (turn_ == batches_.size()) {
      turn_ = 0;
      return nullptr;
    }
    return &batches_[turn_++];
  }

  // The samples of one object, or of the joints ("arm"), which has been silent since.
  [[nodiscard]] PoseBatch batch_of(const std::string& name, std::int64_t stamp_ns) const {
    PoseBatch batch;
    batch.source = SourceName("robot");
    batch.scene_revision = scene_->revision;
    if (name == "arm") return with_joints(std::move(batch), stamp_ns);
    const auto found = std::ranges::find(scene_->objects, name, &Object::name);
    if (of_camera_.contains(name)) batch.source = SourceName("camera");
    batch.samples.push_back(sample(static_cast<std::uint32_t>(found - scene_->objects.begin()),
                                   now_.poses.at(name), stamp_ns));
    return batch;
  }

  // The batches of one tick at this time.
  [[nodiscard]] const std::vector<PoseBatch>& batches_at(std::int64_t stamp_ns) {
    for (PoseBatch& batch : batches_) {
      batch.clear();
      batch.scene_revision = scene_->revision;
      ++batch.sequence_number;
    }
    for (const std::uint32_t i : objects_) {
      const Object& object = scene_->objects[i];
      PoseBatch& batch = batches_[of_camera_.contains(object.name)];
      batch.samples.push_back(sample(i, now_.poses.at(object.name), stamp_ns));
      last_sent[object.name] = stamp_ns;
    }
    if (!sends_joints_) return batches_;
    batches_[0] = with_joints(std::move(batches_[0]), stamp_ns);
    last_sent["arm"] = stamp_ns;
    return batches_;
  }

 private:
  [[nodiscard]] PoseBatch with_joints(PoseBatch batch, std::int64_t stamp_ns) const {
    for (std::uint32_t v = 0; v < scene_->variables.size(); ++v)
      batch.joints.push_back({.variable = v, .stamp_ns = stamp_ns, .position = now_.arm[v]});
    return batch;
  }
  void fill() {
    if (moves && tick_ < kTicksOfMotion) {
      const double s = static_cast<double>(++tick_) / kTicksOfMotion;
      for (auto& [name, pose] : now_.poses)
        pose = s == 1.0 ? to_.poses.at(name) : between(from_.poses.at(name), to_.poses.at(name), s);
      for (std::size_t i = 0; i < now_.arm.size(); ++i)
        now_.arm[i] = s == 1.0 ? to_.arm[i] : from_.arm[i] + s * (to_.arm[i] - from_.arm[i]);
    }
    (void)batches_at(clock_.realtime_ns());
  }

  Clock& clock_;
  const Scene* scene_ = nullptr;
  std::vector<std::uint32_t> objects_;
  // An object without a stated source belongs to the one that has sent it last.
  std::set<std::string> of_camera_;
  bool sends_joints_ = true;
  Places from_, to_, now_;
  int tick_ = kTicksOfMotion;
  std::vector<PoseBatch> batches_;
  std::size_t turn_ = 0;
};

}  // namespace clearance::test
