#include "monitor/pairs/kept_near.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "core/distance.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/interface/pair_name.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMostAxes = 2;           // variables between two links
constexpr std::size_t kMostQueries = 400'000;  // for a pair: a tenth of a second
// m: more than all rounding of sums, of forward kinematics and of placed parts.
constexpr double kSlack = 1e-9;

// A variable between two links.
struct Axis {
  std::uint32_t variable = 0;
  double low = 0.0, high = 0.0;
  double reach = 0.0;  // m: a change by 1 moves no point of the two links farther than this
};

// A link of a robot that carries an object.
struct Carried {
  std::uint32_t robot = 0, link = 0;
};

class BuildProof {
 public:
  BuildProof(const Scene& scene, double metres);
  // Tells whether the pair is nearer in every posture.
  [[nodiscard]] bool holds(const ObjectPair& pair);

 private:
  using Cell = std::array<double, 2 * kMostAxes>;  // the middle and half the width of each axis

  [[nodiscard]] bool add_axes(const Robot& robot, std::uint32_t link, std::uint32_t root,
                              double radius);
  [[nodiscard]] bool add_axis(const RobotJoint& joint, double reach);
  [[nodiscard]] std::uint32_t common_link(const Robot& robot, std::uint32_t a,
                                          std::uint32_t b) const;
  [[nodiscard]] double radius_of(std::uint32_t object) const;
  void place(const ObjectPair& pair, const Cell& cell);
  [[nodiscard]] bool holds_in(const ObjectPair& pair, const Cell& cell);

  const Scene& scene_;
  double metres_;
  std::vector<PosedPart> parts_;
  std::vector<std::uint32_t> first_part_;
  std::vector<std::optional<Carried>> carried_;  // by object
  std::vector<Robot> robot_;                     // one: that of the pair, standing on the world
  std::vector<TrackedVariable> variables_;
  std::optional<ForwardKinematics> kinematics_;
  std::uint32_t robot_index_ = std::numeric_limits<std::uint32_t>::max();
  Carried a_, b_;
  std::vector<Axis> axes_;
  std::size_t queries_ = 0;                // for the pair
  std::uint32_t last_a_ = 0, last_b_ = 0;  // the parts that were near in the last cell
};

BuildProof::BuildProof(const Scene& scene, double metres)
    : scene_(scene),
      metres_(metres),
      parts_(parts_of(scene)),
      first_part_(first_parts(scene)),
      carried_(scene.objects.size()),
      variables_(scene.variables.size()) {
  for (TrackedVariable& variable : variables_) variable.input.has_value = true;
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    if (scene.robots[r].is_attached) continue;
    for (std::uint32_t i = 0; i < scene.robots[r].links.size(); ++i) {
      const std::uint32_t object = scene.robots[r].links[i].object;
      if (object != RobotLink::kNoObject) carried_[object] = Carried{r, i};
    }
  }
}

double BuildProof::radius_of(std::uint32_t object) const {
  double radius = 0.0;
  for (std::uint32_t i = first_part_[object]; i < first_part_[object + 1]; ++i)
    radius = std::max(radius, parts_[i].bounding_radius);
  return radius;
}

// A parent has a lower index than its child.
std::uint32_t BuildProof::common_link(const Robot& robot, std::uint32_t a, std::uint32_t b) const {
  while (a != b) {
    std::uint32_t& later = a > b ? a : b;
    later = robot.joints[later - 1].parent;
  }
  return a;
}

// One variable may move several joints, as of a gripper: their reaches add up.
bool BuildProof::add_axis(const RobotJoint& joint, double reach) {
  const JointVariable& variable = scene_.variables[joint.variable];
  const double factor = std::abs(joint.multiplier);
  double low = variable.lower - variable.limit_tolerance;
  double high = variable.upper + variable.limit_tolerance;
  const bool turns = joint.type != JointType::kPrismatic;
  if (!std::isfinite(low) || !std::isfinite(high)) {
    if (!turns || factor != 1.0) return false;
    low = -std::numbers::pi;
    high = std::numbers::pi;
  }
  const auto same = std::ranges::find(axes_, joint.variable, &Axis::variable);
  if (same != axes_.end()) {
    same->reach += factor * reach;
    return true;
  }
  axes_.push_back({joint.variable, low, high, factor * reach});
  return axes_.size() <= kMostAxes;
}

// From the link inwards: `radius` bounds how far its points are from the origin of the last frame.
bool BuildProof::add_axes(const Robot& robot, std::uint32_t link, std::uint32_t root,
                          double radius) {
  for (std::uint32_t i = link; i != root; i = robot.joints[i - 1].parent) {
    const RobotJoint& joint = robot.joints[i - 1];
    if (variables_of(joint.type) > 1) return false;
    const bool slides = joint.type == JointType::kPrismatic;
    if (joint.type != JointType::kFixed && !add_axis(joint, slides ? 1.0 : radius)) return false;
    if (slides) {
      const JointVariable& variable = scene_.variables[joint.variable];
      radius += std::abs(joint.offset) +
                std::abs(joint.multiplier) *
                    (std::max(std::abs(variable.lower), std::abs(variable.upper)) +
                     variable.limit_tolerance);
    }
    radius += joint.parent_from_joint.position.norm();
  }
  return true;
}

bool BuildProof::holds(const ObjectPair& pair) {
  if (!carried_[pair.first] || !carried_[pair.second]) return false;
  for (const std::uint32_t object : {pair.first, pair.second})
    if (first_part_[object] == first_part_[object + 1]) return false;
  a_ = *carried_[pair.first];
  b_ = *carried_[pair.second];
  if (a_.robot != b_.robot) return false;
  const Robot& robot = scene_.robots[a_.robot];
  const std::uint32_t root = common_link(robot, a_.link, b_.link);
  axes_.clear();
  if (!add_axes(robot, a_.link, root, radius_of(pair.first)) ||
      !add_axes(robot, b_.link, root, radius_of(pair.second)))
    return false;
  if (robot_index_ != a_.robot) {
    robot_index_ = a_.robot;
    robot_.assign(1, robot);
    robot_.front().base = RobotBase{};
    kinematics_.emplace(robot_);
  }
  Cell whole{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!std::isfinite(axes_[i].reach)) return false;
    whole[2 * i] = 0.5 * (axes_[i].low + axes_[i].high);
    whole[2 * i + 1] = 0.5 * (axes_[i].high - axes_[i].low);
  }
  queries_ = 0;
  last_a_ = first_part_[pair.first];
  last_b_ = first_part_[pair.second];
  return holds_in(pair, whole);
}

void BuildProof::place(const ObjectPair& pair, const Cell& cell) {
  for (std::size_t i = 0; i < axes_.size(); ++i)
    variables_[axes_[i].variable].position = cell[2 * i];
  kinematics_->place(variables_, {});
  const auto links = kinematics_->links(0);
  for (const auto& [object, link] : {std::pair(pair.first, a_.link), {pair.second, b_.link}}) {
    for (std::uint32_t i = first_part_[object]; i < first_part_[object + 1]; ++i)
      place_at(links[link].pose, parts_[i]);
  }
}

// One near pair of parts is enough. If no pair of them is near in the middle, the pair is not. A
// pair of links that no axis moves is near in the middle only if that decides.
bool BuildProof::holds_in(const ObjectPair& pair, const Cell& cell) {
  if (queries_ > kMostQueries) return false;
  place(pair, cell);
  double moved = kSlack;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    moved += axes_[i].reach * cell[2 * i + 1];
    if (axes_[i].reach * cell[2 * i + 1] > axes_[widest].reach * cell[2 * widest + 1]) widest = i;
  }
  bool is_near = false;
  const auto decides = [&](std::uint32_t a, std::uint32_t b) {
    ++queries_;
    TrackingState cold;
    const DistanceResult found =
        distance(*parts_[a].shape, *parts_[b].shape, parts_[a].world_from_part,
                 parts_[b].world_from_part, cold);
    const double upper = std::max(0.0, found.upper);
    is_near |= upper + kSlack < metres_;
    return upper + moved < metres_;
  };
  if (decides(last_a_, last_b_)) return true;
  for (std::uint32_t a = first_part_[pair.first]; a < first_part_[pair.first + 1]; ++a) {
    for (std::uint32_t b = first_part_[pair.second]; b < first_part_[pair.second + 1]; ++b) {
      if (!decides(a, b)) continue;
      last_a_ = a;
      last_b_ = b;
      return true;
    }
  }
  if (!is_near) return false;
  Cell half = cell;
  half[2 * widest + 1] *= 0.5;
  for (const double side : {-1.0, 1.0}) {
    half[2 * widest] = cell[2 * widest] + side * half[2 * widest + 1];
    if (!holds_in(pair, half)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> kept_nearer(const Scene& scene, double metres) {
  std::vector<std::uint32_t> kept;
  if (!(metres > 0.0) || scene.robots.empty()) return kept;
  BuildProof proof(scene, metres);
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    if (proof.holds(scene.pairs[pair])) kept.push_back(pair);
  }
  return kept;
}

std::string kept_nearer_text(const Scene& scene, double metres,
                             const std::vector<std::uint32_t>& pairs) {
  constexpr std::size_t kMostNamed = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(pairs.size(), kMostNamed); ++i)
    names += (i == 0 ? "" : ", ") + pair_name(scene, pairs[i]);
  if (pairs.size() > kMostNamed)
    names += " and " + std::to_string(pairs.size() - kMostNamed) + " more";
  const std::string limit = std::to_string(metres);
  return "left out of " + limit.substr(0, limit.find_last_not_of('0') + 1) + " m: " + names +
         ": the robot's own build keeps these nearer in every posture (proved over all positions "
         "of the joints between them)";
}

}  // namespace clearance
