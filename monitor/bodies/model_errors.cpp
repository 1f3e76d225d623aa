#include "monitor/bodies/model_errors.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/support_function.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// Covers the rounding of places, directions and sums: relative to the result, and to the angles
// times the coordinates, which are known to 2^-44.
constexpr double kOutward = 1.0 + 1e-9;
constexpr double kPlaceError = 0x1p-44;
constexpr double kNearlyFlat = 1e-12;  // rad: derivatives of edges are known better

double length_at_most(const Vec3& v) noexcept {
  return std::abs(v.x()) + std::abs(v.y()) + std::abs(v.z());
}

// The angle between two orientations is twice the angle between their quaternions, which is at most
// this for less than a radian.
double turn_at_most(const Eigen::Quaterniond& p, const Eigen::Quaterniond& q) noexcept {
  const double less = (p.coeffs() - q.coeffs()).cwiseAbs().sum();
  const double more = (p.coeffs() + q.coeffs()).cwiseAbs().sum();
  const double chord = std::min(less, more);
  return chord < 0.4 ? 2.1 * chord : kInfinity;
}

// Only these have vertices, or a sphere around them, whose displacement bounds that of all points.
bool has_points(const PosedPart& part) noexcept {
  return part.keeps_direction && part.shape->bounded();
}

}  // namespace

struct ModelErrors::Chains {
  std::uint32_t tip_a, tip_b, common;
  double translation = 0.0, angle = 0.0;  // of both: m, rad
};

ModelErrors::ModelErrors(const Scene& scene) : stated_(scene) {
  for (const ErrorSource& source : stated_.sources()) {
    parent_.push_back(source.parent);
    screws_.push_back({.turn = source.turn, .slide = source.slide});
    rotations_.push_back(source.rotation);
    any_rotation_ = any_rotation_ || source.rotation > 0.0;
  }
  origins_.resize(parent_.size(), Vec3::Zero());
  turns_.resize(parent_.size());
  sums_.resize(parent_.size());
  for (Sums& sums : sums_) sums.is_known = false;
}

// A source comes after the one that carries it.
void ModelErrors::place(std::span<const TrackedObject> objects,
                        const RobotInputs& robots) noexcept {
  farthest_ = 0.0;
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    const ErrorSource& source = stated_.sources()[i];
    const bool was_known = sums_[i].is_known;
    Sums& sums = sums_[i];
    sums = source.parent == ErrorSource::kNone ? Sums{} : sums_[source.parent];
    const Pose* pose = nullptr;
    if (source.on_link) {
      const LinkState& link = robots.links(source.robot)[source.link];
      sums.is_known = sums.is_known && link.known && !link.late;
      pose = &link.pose;
    } else {
      const TrackedObject& object = objects[source.object];
      sums.is_known = sums.is_known && object.input.has_value && !object.input.late;
      pose = &object.pose;
    }
    if (!sums.is_known) continue;
    const Eigen::Quaterniond turn = pose->orientation.normalized();
    const Vec3 origin = pose->position + turn * source.origin, axis = turn * source.axis;
    const double shifted = was_known ? length_at_most(origin - origins_[i]) : kInfinity;
    const double turned = was_known ? turn_at_most(turn, turns_[i]) : kInfinity;
    const double angle = source.angle();
    sums.translation += source.translation;
    sums.slide += source.slide;
    sums.angle += angle;
    if (angle > 0.0) {
      // Between the ticks, the origin leaves its chord by an eighth of this at most.
      sums.drift_shift += angle * (shifted + turned * turned * length_at_most(source.origin));
      sums.drift_turn += angle * turned;
    }
    if (source.slide > 0.0) sums.drift_shift += source.slide * turned;
    if (source.parent != ErrorSource::kNone)
      sums.length += length_at_most(origin - origins_[source.parent]);
    origins_[i] = origin;
    turns_[i] = turn;
    screws_[i].axis = axis;
    screws_[i].moment = axis.cross(origin);
    farthest_ = std::max(farthest_, length_at_most(origin));
  }
}

ModelErrors::Sums ModelErrors::sums_between(std::uint32_t source,
                                            std::uint32_t common) const noexcept {
  if (source == common) return {};
  Sums sums = sums_[source];
  if (common == ErrorSource::kNone) return sums;
  const Sums& less = sums_[common];
  sums.translation -= less.translation;
  sums.slide -= less.slide;
  sums.angle -= less.angle;
  sums.length -= less.length;
  return sums;
}

// The moment of a line about an axis is how much a turn about the axis shifts the line's points
// along it.
double ModelErrors::share(std::uint32_t source, const Line& line) const noexcept {
  const Screw& screw = screws_[source];
  double sum = screw.turn * std::abs(screw.axis.dot(line.moment) - screw.moment.dot(line.along));
  if (screw.slide > 0.0) sum += screw.slide * std::abs(screw.axis.dot(line.along));
  if (rotations_[source] > 0.0)
    sum += rotations_[source] * (line.moment - origins_[source].cross(line.along)).norm();
  return sum;
}

double ModelErrors::shares(std::uint32_t tip, std::uint32_t common,
                           const Line& line) const noexcept {
  double sum = 0.0;
  for (std::uint32_t s = tip; s != common; s = parent_[s]) sum += share(s, line);
  return sum;
}

double ModelErrors::shares(const Chains& chains, const Line& line) const noexcept {
  return chains.translation + shares(chains.tip_a, chains.common, line) +
         shares(chains.tip_b, chains.common, line);
}

// The greatest sum over the part's points, less their depth. Moving along an edge changes the sum
// by no more than the angle, so a vertex from which all edges descend more steeply is the only one
// that counts. `at`: a point of the part.
double ModelErrors::most_on(const PosedPart& part, const Vec3& towards, const Chains& chains,
                            Vec3& at, bool& is_pointed) const noexcept {
  const ConvexBody& shape = *part.shape;
  is_pointed = false;
  at = part.sphere_in_world.centre;
  if (shape.is_curved())
    return shares(chains, Line(at, towards)) + chains.angle * part.sphere_in_world.radius;
  const Vec3 m = part.world_from_part_rotation.transpose() * towards;
  const Vertex& vertex = shape.vertices[static_cast<std::size_t>(support(shape, m).anchor)];
  is_pointed = true;
  for (std::int32_t i = 0; i < vertex.edges; ++i)
    is_pointed = is_pointed && m.dot(shape.outgoing_of(vertex, i)) < -(chains.angle + kNearlyFlat);
  if (!is_pointed) return kInfinity;
  at = part.world_from_part_rotation * vertex.position + part.world_from_part.position;
  return shares(chains, Line(at, towards));
}

double ModelErrors::most_on_vertices(const PosedPart& part, const Vec3& towards,
                                     const Chains& chains) const noexcept {
  const ConvexBody& shape = *part.shape;
  const Vec3 m = part.world_from_part_rotation.transpose() * towards;
  double highest = -kInfinity;
  for (const Vertex& vertex : shape.vertices) highest = std::max(highest, m.dot(vertex.position));
  const double open = 2.0 * chains.angle * part.sphere_in_world.radius;
  double most = 0.0;
  for (const Vertex& vertex : shape.vertices) {
    const double depth = highest - m.dot(vertex.position);
    if (depth > open) continue;
    const Vec3 at = part.world_from_part_rotation * vertex.position + part.world_from_part.position;
    most = std::max(most, shares(chains, Line(at, towards)) - depth);
  }
  return most;
}

// All sources are taken to displace one of the two parts relative to the other. Either part will
// do: a pointed one gives the least.
ErrorAlong ModelErrors::along(const PosedPart& a, const PosedPart& b, const Vec3& normal,
                              const ErrorsBetween& between, double moved) const noexcept {
  Chains chains{stated_.source_of(a.object), stated_.source_of(b.object), between.common};
  const Sums sums_a = sums_between(chains.tip_a, chains.common),
             sums_b = sums_between(chains.tip_b, chains.common);
  if (!sums_a.is_known || !sums_b.is_known) return {between.largest, 0.0};
  chains.translation = sums_a.translation + sums_b.translation;
  chains.angle = sums_a.angle + sums_b.angle;

  double first = kInfinity;
  Vec3 at = Vec3::Zero();
  const PosedPart* on = nullptr;
  bool is_pointed = false;
  // What is nearer to its sources has shorter lever arms, and less of second order.
  const bool b_is_first = chains.tip_a == chains.common;
  const PosedPart* const parts[] = {b_is_first ? &b : &a, b_is_first ? &a : &b};
  for (const PosedPart* part : parts) {
    if (is_pointed || !has_points(*part)) continue;
    Vec3 point;
    const double most =
        most_on(*part, part == &a ? normal : Vec3(-normal), chains, point, is_pointed);
    if (on != nullptr && !(most < first)) continue;
    first = most;
    at = point;
    on = part;
  }
  if (on == nullptr) return {between.largest, 0.0};
  if (!is_pointed) {
    for (const PosedPart* part : parts) {
      if (!has_points(*part) || part->shape->is_curved()) continue;
      first = std::min(first, most_on_vertices(*part, part == &a ? normal : Vec3(-normal), chains));
    }
  }

  // No point that was tried is farther from `at` than `across`, or from an origin than `arm`.
  double across = 2.0 * on->sphere_in_world.radius;
  if (!is_pointed && has_points(a) && has_points(b))
    across = 2.0 * (a.sphere_in_world.radius + b.sphere_in_world.radius) +
             length_at_most(a.sphere_in_world.centre - b.sphere_in_world.centre);
  const auto arm_of = [&](std::uint32_t tip, const Sums& sums) {
    return tip == chains.common ? 0.0 : length_at_most(at - origins_[tip]) + sums.length + across;
  };
  const double arm_a = arm_of(chains.tip_a, sums_a), arm_b = arm_of(chains.tip_b, sums_b);
  const double displaced = chains.translation + sums_a.slide + sums_b.slide + sums_a.angle * arm_a +
                           sums_b.angle * arm_b;
  const double second = chains.angle * (1.0 + 2.0 * chains.angle) * displaced;
  const double rounding = kPlaceError * chains.angle * (a.coordinates + b.coordinates + farthest_);
  const double loss =
      kOutward * (first + second + stated_.shape_error(a.object) + stated_.shape_error(b.object)) +
      rounding;
  // The parts' own motion changes their distance from the sources, too. Twice: between the ticks
  // they may be farther from both places than these are from each other.
  // The direction of the tick before may have been on the other part.
  const double both = 2.0 * (has_points(a) ? a.sphere_in_world.radius : 0.0) +
                      2.0 * (has_points(b) ? b.sphere_in_world.radius : 0.0) +
                      (has_points(a) && has_points(b)
                           ? length_at_most(a.sphere_in_world.centre - b.sphere_in_world.centre)
                           : 0.0);
  const double drift = sums_a.drift_shift + sums_b.drift_shift +
                       sums_a.drift_turn * (arm_a + both) + sums_b.drift_turn * (arm_b + both) +
                       chains.angle * moved;
  return {std::min(loss, between.largest), 2.0 * kOutward * drift};
}

}  // namespace clearance
