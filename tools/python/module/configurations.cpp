#include "tools/python/module/configurations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "config/scene/chain_rounding.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/fixed_order.hpp"
#include "monitor/bodies/joint_quaternion.hpp"
#include "monitor/inputs/joint_batch.hpp"
#include "monitor/interface/gradient_rows.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/pair_bounds.hpp"

namespace clearance::python {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kMostVariables = 7;  // of a joint

void store(double* rows, std::size_t index, const Vec3& v) noexcept {
  if (rows != nullptr) std::copy_n(v.data(), 3, rows + 3 * index);
}

// Is this variable of the joint a length? The others are angles or entries of a quaternion.
bool is_length(JointType type, std::uint32_t variable) noexcept {
  return type == JointType::kPrismatic || (type == JointType::kPlanar && variable < 2) ||
         (type == JointType::kFloating && variable < 3);
}

}  // namespace

Configurations::Configurations(const Scene& scene)
    : scene_(scene),
      errors_(scene),
      kinematics_(scene.robots),
      variables_(scene.variables.size()),
      absent_robots_(scene),
      bases_(scene.robots.size()),
      known_(scene.objects.size()),
      is_link_(scene.objects.size()),
      parts_(parts_of(scene)),
      first_part_(first_parts(scene)),
      poses_(scene.objects.size()),
      spheres_(bounding_spheres(scene.objects.size(), parts_)) {
  for (TrackedVariable& variable : variables_)
    variable.input.has_value = variable.velocity_known = true;
  least_.assign(variables_.size(), -kLargestJoint);
  largest_.assign(variables_.size(), kLargestJoint);
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      for (std::uint32_t i = 0; i < variables_of(joint.type); ++i) {
        const std::uint32_t v = joint.variable + i;
        const JointVariable& limits = scene.variables[v];
        const double most = is_length(joint.type, i) ? kLargestLength : kLargestJoint;
        least_[v] = std::max(-most, limits.lower - limits.limit_tolerance);
        largest_[v] = std::min(most, limits.upper + limits.limit_tolerance);
      }
    }
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) is_link_[link.object] = true;
    }
  }
  std::uint32_t states = 0;
  for (const ObjectPair& pair : scene.pairs) {
    Pair& added =
        pairs_.emplace_back(Pair{.a = pair.first, .b = pair.second, .first_state = states});
    states += static_cast<std::uint32_t>(scene.objects[pair.first].parts.size() *
                                         scene.objects[pair.second].parts.size());
    added.first_term = static_cast<std::uint32_t>(terms_.size());
    for (const MovingJoint& moving : joints_between(scene, pair)) {
      const RobotJoint& joint = scene.robots[moving.robot].joints[moving.joint];
      terms_.push_back(
          {moving.robot, moving.joint, joint.variable, variables_of(joint.type), moving.moves_b});
    }
    added.end_term = static_cast<std::uint32_t>(terms_.size());
  }
  states_.resize(states);
  begin();
}

void Configurations::forget_tracking() noexcept {
  std::ranges::fill(states_, TrackingState());
  for (Pair& pair : pairs_) pair.closest = 0;
  first_looked_at_ = 0;
}

void Configurations::begin() {
  forget_tracking();
  chosen_.resize(pairs_.size());
  std::iota(chosen_.begin(), chosen_.end(), 0U);
  for (std::uint32_t i = 0; i < known_.size(); ++i) {
    known_[i] = false;
    if (scene_.objects[i].fixed && !scene_.objects[i].absent)
      put(i, scene_.objects[i].world_from_object);
  }
  std::ranges::fill(bases_, LinkState());
}

void Configurations::put(std::uint32_t object, const Pose& pose) noexcept {
  known_[object] = true;
  poses_[object] = pose;
  for (std::uint32_t part = first_part_[object]; part < first_part_[object + 1]; ++part)
    place_at(pose, parts_[part]);
}

void Configurations::place(std::uint32_t object, const Pose& world_from_object) {
  put(object, world_from_object);
  for (std::size_t robot = 0; robot < bases_.size(); ++robot) {
    const RobotBase& base = scene_.robots[robot].base;
    if (base.kind != RobotBase::Kind::kObject || base.object != object) continue;
    bases_[robot].known = bases_[robot].velocity_known = true;
    bases_[robot].pose = world_from_object;
  }
}

void Configurations::find_left_out(std::span<const double> joints) noexcept {
  absent_robots_.find_left_out(
      scene_, [&](std::uint32_t v) { return !std::isnan(joints[v]); },
      [&](std::uint32_t object) { return known_[object] != 0; });
}

std::optional<Configurations::Implausible> Configurations::implausible(
    std::span<const double> joints) {
  find_left_out(joints);
  for (std::uint32_t v = 0; v < joints.size(); ++v) {
    if (absent_robots_.is_left_out(scene_.variables[v].robot)) continue;
    if (!(joints[v] >= least_[v] && joints[v] <= largest_[v])) return Implausible{v};
  }
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (absent_robots_.is_left_out(r)) continue;
    for (const RobotJoint& joint : scene_.robots[r].joints) {
      const double length = wrong_length(joint, [&](std::uint32_t v) { return joints[v]; });
      if (length != 1.0) return Implausible{joint.variable + 3, length};
    }
  }
  return std::nullopt;
}

void Configurations::place_links() noexcept {
  kinematics_.place(variables_, bases_);
  for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot) {
    const std::vector<RobotLink>& links = scene_.robots[robot].links;
    const std::span<const LinkState> states = kinematics_.links(robot);
    for (std::size_t link = 0; link < links.size(); ++link) {
      const std::uint32_t object = links[link].object;
      if (object == RobotLink::kNoObject) continue;
      if (scene_.objects[object].fixed && !scene_.objects[object].absent) continue;
      known_[object] = false;
      if (states[link].known && !absent_robots_.is_left_out(robot)) put(object, states[link].pose);
    }
  }
}

void Configurations::query(const Pair& pair, std::uint32_t part_pair, Closest& closest) noexcept {
  const std::uint32_t parts_of_b = first_part_[pair.b + 1] - first_part_[pair.b];
  const PosedPart& a = parts_[first_part_[pair.a] + part_pair / parts_of_b];
  const PosedPart& b = parts_[first_part_[pair.b] + part_pair % parts_of_b];
  const DistanceResult found = distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part,
                                        states_[pair.first_state + part_pair]);
  const DistanceBounds bounds =
      widened(for_exact_poses(found, a, b), errors_.largest(pair.a, pair.b));
  if (bounds.upper < closest.upper || closest.lower == kInfinity) {
    closest.part_pair = part_pair;
    closest.found = found;
  }
  closest.lower = std::min(closest.lower, bounds.lower);
  closest.upper = std::min(closest.upper, bounds.upper);
}

bool Configurations::is_known(const Pair& pair) const noexcept {
  return known_[pair.a] && known_[pair.b] && first_part_[pair.a] < first_part_[pair.a + 1] &&
         first_part_[pair.b] < first_part_[pair.b + 1];
}

bool Configurations::is_absent(const Pair& pair) const noexcept {
  const auto is_left_out = [&](std::uint32_t object) {
    return scene_.objects[object].absent && !known_[object];
  };
  return is_left_out(pair.a) || is_left_out(pair.b);
}

void Configurations::write_unknown(std::size_t index,
                                   const ConfigurationResults& to) const noexcept {
  to.distance[index] = kUnknown;
  to.lower[index] = -kInfinity;
  to.upper[index] = kInfinity;
  to.status[index] = static_cast<std::uint8_t>(PairStatus::kUnknown);
  if (to.part_a != nullptr) to.part_a[index] = to.part_b[index] = 0;
  for (double* const rows : {to.witness_a, to.witness_b, to.normal})
    store(rows, index, Vec3::Constant(kUnknown));
  if (to.gradient != nullptr)
    std::fill_n(to.gradient + index * variables_.size(), variables_.size(), kUnknown);
}

void Configurations::evaluate(Pair& pair, std::size_t index, double enough,
                              const ConfigurationResults& to) noexcept {
  if (!is_known(pair)) {
    write_unknown(index, to);
    if (is_absent(pair)) to.status[index] = static_cast<std::uint8_t>(PairStatus::kAbsent);
    return;
  }
  const std::uint32_t first_a = first_part_[pair.a], first_b = first_part_[pair.b];
  const std::uint32_t parts_of_a = first_part_[pair.a + 1] - first_a;
  const std::uint32_t parts_of_b = first_part_[pair.b + 1] - first_b;
  double* const rates = to.gradient == nullptr ? nullptr : to.gradient + index * variables_.size();
  const double error = errors_.largest(pair.a, pair.b);
  const auto apart = [&](std::uint32_t i) {
    const Sphere& a = parts_[first_a + i / parts_of_b].sphere_in_world;
    const Sphere& b = parts_[first_b + i % parts_of_b].sphere_in_world;
    return least_between(a, b);
  };
  Closest closest;
  double beyond = kInfinity;  // no part pair that was not queried for being far is nearer, m
  const auto look = [&](std::uint32_t i) {
    const double least = apart(i);
    if (least - error >= enough) {
      beyond = std::min(beyond, rounded_down(least - error));
    } else if (least <= closest.upper) {
      query(pair, i, closest);
    }
  };
  look(pair.closest);
  for (std::uint32_t i = 0; i < parts_of_a * parts_of_b; ++i)
    if (i != pair.closest) look(i);
  if (closest.lower == kInfinity) {
    write_unknown(index, to);
    to.lower[index] = beyond;
    return;
  }
  closest.lower = std::min(closest.lower, beyond);
  pair.closest = closest.part_pair;

  const PosedPart& a = parts_[first_a + closest.part_pair / parts_of_b];
  const DistanceResult& found = closest.found;
  const Mat3& turn = a.world_from_part_rotation;
  const Vec3 on_a = turn * found.point_on_a + a.world_from_part.position;
  const Vec3 on_b = turn * found.point_on_b + a.world_from_part.position;
  const Vec3 normal = turn * found.normal;
  to.lower[index] = closest.lower;
  to.upper[index] = closest.upper;
  to.distance[index] = std::clamp(found.distance, closest.lower, closest.upper);
  to.status[index] = static_cast<std::uint8_t>(status_of(found.status));
  if (to.part_a != nullptr) {
    to.part_a[index] = closest.part_pair / parts_of_b;
    to.part_b[index] = closest.part_pair % parts_of_b;
  }
  store(to.witness_a, index, on_a);
  store(to.witness_b, index, on_b);
  store(to.normal, index, normal);
  if (rates != nullptr) differentiate(pair, on_a, on_b, normal, rates);
}

// monitor/pairs/differentiate.hpp explains the sum.
void Configurations::differentiate(const Pair& pair, const Vec3& on_a, const Vec3& on_b,
                                   const Vec3& normal, double* rates) noexcept {
  std::fill_n(rates, variables_.size(), 0.0);
  for (std::uint32_t t = pair.first_term; t < pair.end_term; ++t) {
    const Term& term = terms_[t];
    const RobotJoint& joint = scene_.robots[term.robot].joints[term.joint];
    const std::span<const LinkState> links = kinematics_.links(term.robot);
    std::array<JointScrew, kMostVariables> screws;
    screws_of(joint, links[joint.parent], links[term.joint + 1], variables_,
              std::span(screws).first(term.count));
    for (std::uint32_t i = 0; i < term.count; ++i) {
      const Vec3 arm = (term.moves_b ? on_b : on_a) - screws[i].origin;
      const double along = dot(normal, screws[i].linear + cross(screws[i].angular, arm));
      rates[term.first_variable + i] += term.moves_b ? along : -along;
    }
  }
}

void Configurations::place(std::span<const double> joints) noexcept {
  find_left_out(joints);
  for (std::size_t v = 0; v < joints.size(); ++v) {
    variables_[v].input.has_value = !std::isnan(joints[v]);
    variables_[v].position = variables_[v].input.has_value ? joints[v] : 0.0;
  }
  place_links();
}

void Configurations::evaluate(std::span<const double> joints,
                              const ConfigurationResults& to) noexcept {
  place(joints);
  for (std::size_t i = 0; i < chosen_.size(); ++i) evaluate(pairs_[chosen_[i]], i, kInfinity, to);
}

// The pair that was below the limit in the configuration before comes first.
Verdict Configurations::decide(std::span<const double> joints, double limit,
                               const ConfigurationResults& to) noexcept {
  place(joints);
  for (std::size_t i = 0; i < chosen_.size(); ++i) write_unknown(i, to);
  Verdict verdict = Verdict::kFree;
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const std::size_t i = k == 0 ? first_looked_at_ : k <= first_looked_at_ ? k - 1 : k;
    Pair& pair = pairs_[chosen_[i]];
    if (is_known(pair)) {
      const double apart = rounded_down(least_between(placed(spheres_[pair.a], poses_[pair.a]),
                                                      placed(spheres_[pair.b], poses_[pair.b])) -
                                        errors_.largest(pair.a, pair.b));
      if (apart >= limit) {
        to.lower[i] = apart;
        continue;
      }
    }
    evaluate(pair, i, limit, to);
    if (to.upper[i] < limit) {
      first_looked_at_ = i;
      return Verdict::kBelow;
    }
    if (!(to.lower[i] >= limit) && !is_absent(pair)) verdict = Verdict::kUndecided;
  }
  return verdict;
}

}  // namespace clearance::python
