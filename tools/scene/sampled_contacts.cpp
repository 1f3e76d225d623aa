#include "tools/scene/sampled_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/write/seeded_draw.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "monitor/bodies/forward_kinematics.hpp"

namespace clearance {
namespace {

// One robot with joint positions that the caller sets.
class Posable {
 public:
  explicit Posable(const Scene& scene)
      : scene_(scene), robot_(scene.robots.front()), kinematics_(scene.robots) {
    variables_.resize(scene.variables.size());
    for (TrackedVariable& variable : variables_)
      variable.input.has_value = variable.velocity_known = true;
    for (const RobotJoint& joint : robot_.joints) {
      if (joint.type == JointType::kFloating) variables_[joint.variable + 6].position = 1.0;
      if (variables_of(joint.type) == 1) single_.push_back({joint.variable, joint.type});
    }
    std::ranges::sort(single_, {}, &Single::variable);
    const auto same = std::ranges::unique(single_, {}, &Single::variable);
    single_.erase(same.begin(), same.end());
  }

  void pose_at_zero() {
    for (const Single& joint : single_) {
      const JointVariable& limits = scene_.variables[joint.variable];
      variables_[joint.variable].position = std::clamp(0.0, limits.lower, limits.upper);
    }
    kinematics_.place(variables_, bases_);
  }

  void pose_at_random(SeededDraw& draw) {
    for (const Single& joint : single_) {
      const JointVariable& limits = scene_.variables[joint.variable];
      const bool limited = std::isfinite(limits.lower) && std::isfinite(limits.upper);
      variables_[joint.variable].position = limited ? draw.uniform(limits.lower, limits.upper)
                                            : joint.type == JointType::kPrismatic
                                                ? draw.uniform(-1.0, 1.0)
                                                : draw.uniform(-std::numbers::pi, std::numbers::pi);
    }
    kinematics_.place(variables_, bases_);
  }

  [[nodiscard]] const Pose& pose_of(std::uint32_t link) const {
    return kinematics_.links(0)[link].pose;
  }

 private:
  struct Single {
    std::uint32_t variable;
    JointType type;
  };

  const Scene& scene_;
  const Robot& robot_;
  ForwardKinematics kinematics_;
  std::vector<TrackedVariable> variables_;
  std::vector<Single> single_;       // each variable once, also one that other joints mimic
  std::vector<LinkState> bases_{1};  // the world
};

// The nearest link above that has shapes; kNoObject: there is none.
std::uint32_t above(const Robot& robot, std::uint32_t link) {
  while (link > 0) {
    link = robot.joints[link - 1].parent;
    if (robot.links[link].object != RobotLink::kNoObject) return link;
  }
  return RobotLink::kNoObject;
}

// A pair with the links of its objects and the tracking states of its queries.
struct Watched {
  SampledPair pair;
  std::uint32_t first_link, second_link;
  std::vector<TrackingState> states;  // by part pair
};

std::vector<Watched> pairs_of(const Scene& scene) {
  const Robot& robot = scene.robots.front();
  std::vector<Watched> pairs;
  for (std::uint32_t a = 0; a < robot.links.size(); ++a) {
    for (std::uint32_t b = a + 1; b < robot.links.size(); ++b) {
      const std::uint32_t first = robot.links[a].object, second = robot.links[b].object;
      if (first == RobotLink::kNoObject || second == RobotLink::kNoObject) continue;
      const Object &object_a = scene.objects[first], &object_b = scene.objects[second];
      if (object_a.fixed && object_b.fixed) continue;
      pairs.push_back(
          {.pair = {.first = first,
                    .second = second,
                    .adjacent = above(robot, b) == a || above(robot, a) == b},
           .first_link = a,
           .second_link = b,
           .states = std::vector<TrackingState>(object_a.parts.size() * object_b.parts.size())});
    }
  }
  return pairs;
}

// The distance, m; 0 where no gap is certified.
double distance_of(const Scene& scene, const Posable& robot, Watched& watched) {
  const Object& a = scene.objects[watched.pair.first];
  const Object& b = scene.objects[watched.pair.second];
  double least = kInfinity;
  std::size_t state = 0;
  for (const Part& part_a : a.parts) {
    const Pose pose_a = compose(robot.pose_of(watched.first_link), part_a.object_from_part);
    for (const Part& part_b : b.parts) {
      const Pose pose_b = compose(robot.pose_of(watched.second_link), part_b.object_from_part);
      const DistanceResult found =
          distance(part_a.shape, part_b.shape, relative_pose(pose_a, pose_b),
                   watched.states[state++], {.depth = false});
      least = std::min(least, std::max(found.lower, 0.0));
    }
  }
  return least;
}

// A link that one joint moves, and that joint is a revolute one with a vertical axis. An axis is
// the same in the frames of both links of its joint.
bool turns_level(const Robot& robot, const Posable& posed, std::uint32_t link) {
  bool turns = false;
  for (; link > 0; link = robot.joints[link - 1].parent) {
    const RobotJoint& joint = robot.joints[link - 1];
    if (joint.type == JointType::kFixed) continue;
    const bool revolves =
        joint.type == JointType::kRevolute || joint.type == JointType::kContinuous;
    const Vec3 axis = posed.pose_of(link).orientation * joint.axis;
    if (turns || !revolves || std::abs(axis.z()) < 1.0 - 1e-9) return false;
    turns = true;
  }
  return turns;
}

// A bound of the object along the direction, m: by the distance from a half-space far outside.
double farthest(const Object& object, const Pose& pose, const Vec3& direction) {
  constexpr double kFar = 1e4;  // m
  const HalfSpace outside{-direction, -kFar};
  const auto wall = std::get<ConvexBody>(polyhedron_from_halfspaces({&outside, 1}));
  double least = kInfinity;
  for (const Part& part : object.parts) {
    const Pose placed = compose(pose, part.object_from_part);
    TrackingState state;
    least =
        std::min(least, distance(wall, part.shape, relative_pose(Pose{}, placed), state, {}).lower);
  }
  return kFar - least;
}

LinkExtent extent_of(const Object& object, const Pose& pose) {
  LinkExtent extent;
  for (int axis = 0; axis < 3; ++axis) {
    extent.low[axis] = -farthest(object, pose, -Vec3::Unit(axis));
    extent.high[axis] = farthest(object, pose, Vec3::Unit(axis));
  }
  return extent;
}

}  // namespace

std::vector<LinkExtent> extents_at_zero(const Scene& scene) {
  const Robot& robot = scene.robots.front();
  Posable posed(scene);
  posed.pose_at_zero();
  std::vector<LinkExtent> extents;
  for (std::uint32_t link = 0; link < robot.links.size(); ++link) {
    const std::uint32_t object = robot.links[link].object;
    if (object == RobotLink::kNoObject) continue;
    extents.push_back(extent_of(scene.objects[object], posed.pose_of(link)));
    extents.back().object = object;
    extents.back().turns_level = turns_level(robot, posed, link);
  }
  return extents;
}

double reach_to_the_front(const Scene& scene) {
  constexpr int kConfigurations = 5'000;
  const Robot& robot = scene.robots.front();
  Posable posed(scene);
  posed.pose_at_zero();
  SeededDraw draw(1);
  double reach = -kInfinity;
  for (int i = 0; i <= kConfigurations; ++i) {
    for (std::uint32_t link = 0; link < robot.links.size(); ++link) {
      const std::uint32_t object = robot.links[link].object;
      if (object == RobotLink::kNoObject) continue;
      reach = std::max(reach, farthest(scene.objects[object], posed.pose_of(link), Vec3::UnitX()));
    }
    posed.pose_at_random(draw);
  }
  return reach;
}

std::vector<SampledPair> sample_contacts(const Scene& scene, const SamplingOptions& options) {
  std::vector<Watched> pairs = pairs_of(scene);
  Posable robot(scene);
  robot.pose_at_zero();
  for (Watched& watched : pairs)
    watched.pair.touch_at_zero = !(distance_of(scene, robot, watched) > 0.0);
  SeededDraw draw(options.seed);
  const std::uint64_t step = std::max<std::uint64_t>(1, options.samples / 100);
  for (std::uint64_t i = 0; i < options.samples; ++i) {
    if (options.progress && i % step == 0)
      options.progress(static_cast<double>(i) / static_cast<double>(options.samples));
    robot.pose_at_random(draw);
    for (Watched& watched : pairs) {
      const double apart = distance_of(scene, robot, watched);
      watched.pair.touching += !(apart > 0.0);
      watched.pair.least = std::min(watched.pair.least, apart);
    }
  }
  if (options.progress) options.progress(1.0);
  std::vector<SampledPair> sampled;
  for (const Watched& watched : pairs) sampled.push_back(watched.pair);
  return sampled;
}

}  // namespace clearance
