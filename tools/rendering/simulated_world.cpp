#include "tools/rendering/simulated_world.hpp"

#include <algorithm>
#include <utility>

namespace clearance {
namespace {

// The world, link or object that has this frame of tf, by the same rule as Mounts has.
std::optional<RobotBase> body_of(const Cell& cell, const std::string& frame) {
  const Scene& scene = cell.scene;
  RobotBase body;
  if (frame == cell.ros.world()) return body;
  body.kind = RobotBase::Kind::kLink;
  for (body.robot = 0; body.robot < scene.robots.size(); ++body.robot) {
    const auto& links = scene.robots[body.robot].links;
    for (body.link = 0; body.link < links.size(); ++body.link) {
      if (links[body.link].name == frame) return body;
    }
  }
  body.kind = RobotBase::Kind::kObject;
  for (body.object = 0; body.object < scene.objects.size(); ++body.object) {
    const Object& object = scene.objects[body.object];
    if (!object.frame.empty() && object.frame == frame) return body;
  }
  return std::nullopt;
}

const SimulatedFrame* mover_of(const Cell& cell, const std::string& frame) {
  const auto& frames = cell.simulation.frames;
  const auto found = std::ranges::find(frames, frame, &SimulatedFrame::name);
  return found == frames.end() ? nullptr : &*found;
}

}  // namespace

SimulatedWorld::SimulatedWorld(const Cell& cell, JointMotion joints,
                               std::vector<WalkingPerson> people)
    : cell_(cell),
      joints_(std::move(joints)),
      people_(std::move(people)),
      variables_(cell.scene.variables.size()),
      bases_(cell.scene.robots.size()),
      kinematics_(cell.scene.robots),
      objects_(cell.scene.objects.size()),
      of_robot_(cell.scene.objects.size(), false) {
  for (const Robot& robot : cell.scene.robots) {
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) of_robot_[link.object] = true;
    }
  }
}

std::string frame_of(const Sensor& sensor) {
  return sensor.frames_by_message ? sensor.name : sensor.mount.frame;
}

bool has_place(const Cell& cell, const Sensor& sensor) {
  const std::string frame = frame_of(sensor);
  return frame.empty() || body_of(cell, frame) || mover_of(cell, frame) != nullptr;
}

void SimulatedWorld::place(double t_s) {
  t_s_ = t_s;
  const std::vector<Object>& objects = cell_.scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects_[i].reset();
    if (objects[i].fixed) objects_[i] = objects[i].world_from_object;
  }
  poses_at(cell_.simulation, t_s, simulated_);
  for (const PoseAt& each : simulated_) objects_[each.object] = each.world_from_object;
  if (!cell_.scene.robots.empty()) place_robots(t_s);
  for (WalkingPerson& person : people_) person.place(t_s);
  add_bodies();
}

void SimulatedWorld::place_robots(double t_s) {
  const Scene& scene = cell_.scene;
  if (!variables_.empty()) joints_(t_s, samples_);
  for (const JointSample& sample : samples_) {
    variables_[sample.variable].input.has_value = true;
    variables_[sample.variable].position = sample.position;
  }
  for (std::size_t robot = 0; robot < bases_.size(); ++robot) {
    const RobotBase& base = scene.robots[robot].base;
    if (base.kind != RobotBase::Kind::kObject) continue;
    bases_[robot] = {};
    bases_[robot].known = objects_[base.object].has_value();
    if (bases_[robot].known) bases_[robot].pose = *objects_[base.object];
  }
  kinematics_.place(variables_, bases_);
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const std::vector<RobotLink>& links = scene.robots[robot].links;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const LinkState& state = kinematics_.links(robot)[i];
      if (links[i].object != RobotLink::kNoObject && state.known)
        objects_[links[i].object] = state.pose;
    }
  }
}

void SimulatedWorld::add_bodies() {
  bodies_.clear();
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const Object& object = cell_.scene.objects[i];
    if (!objects_[i] || object.absent || object.is_seen()) continue;
    for (const Part& part : object.parts)
      bodies_.push_back({&part.shape, compose(*objects_[i], part.object_from_part), i});
  }
  for (const WalkingPerson& person : people_) {
    for (const WalkingPerson::Limb& limb : person.limbs())
      bodies_.push_back({&limb.shape, limb.world_from_limb, kPerson});
  }
}

std::optional<Pose> SimulatedWorld::sensor(const Sensor& sensor) const {
  const std::string frame = frame_of(sensor);
  if (frame.empty()) return place_of(sensor.mount);
  std::optional<Pose> base;
  if (const auto body = body_of(cell_, frame)) {
    base = place_of(*body);
  } else if (const SimulatedFrame* const mover = mover_of(cell_, frame)) {
    base = frame_at(*mover, t_s_);
  }
  if (base) *base = compose(*base, sensor.mount.frame_from_root);
  return base;
}

std::optional<Pose> SimulatedWorld::place_of(const RobotBase& base) const {
  switch (base.kind) {
    case RobotBase::Kind::kWorld:
      return base.base_from_root;
    case RobotBase::Kind::kObject:
      if (!objects_[base.object]) return std::nullopt;
      return compose(*objects_[base.object], base.base_from_root);
    case RobotBase::Kind::kLink: {
      const LinkState& link = kinematics_.links(base.robot)[base.link];
      if (!link.known) return std::nullopt;
      return compose(link.pose, base.base_from_root);
    }
  }
  return std::nullopt;
}

}  // namespace clearance
