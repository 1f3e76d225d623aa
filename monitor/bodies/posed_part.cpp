#include "monitor/bodies/posed_part.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/curved_extent.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

bool is_identity(const Eigen::Quaterniond& q) noexcept {
  return q.x() == 0.0 && q.y() == 0.0 && q.z() == 0.0;
}

// The relative rounding of hypotenuses and sums in the extents of curved bodies.
constexpr double kCurvedRounding = 0x1p-50;

Sphere sphere_around(const CurvedShape& curved, double radius) noexcept {
  const Vec3 centre = middle(curved);
  const double farthest = rounded_up(farthest_from(curved, centre) * (1.0 + kCurvedRounding));
  return {.centre = centre, .radius = rounded_up(farthest + radius)};
}

Sphere sphere_around(const ConvexBody& shape) noexcept {
  if (shape.is_curved()) return sphere_around(shape.curved, shape.radius);
  Vec3 low = Vec3::Constant(kInfinity);
  Vec3 high = Vec3::Constant(-kInfinity);
  for (const Vec3& anchor : shape.anchors) {
    low = low.cwiseMin(anchor);
    high = high.cwiseMax(anchor);
  }
  Sphere sphere{.centre = 0.5 * (low + high), .radius = kInfinity};
  if (!shape.bounded()) return sphere;
  double farthest = 0.0;
  for (const Vec3& anchor : shape.anchors) {
    farthest = std::max(farthest, (anchor - sphere.centre).norm());
  }
  sphere.radius = rounded_up(rounded_up(farthest) + shape.position_error + shape.radius);
  return sphere;
}

// The largest distance of a point of a curved part from the origin of its object, without the
// part's radius.
double curved_radius_about_origin(const Part& part) noexcept {
  const Pose& pose = part.object_from_part;
  const Vec3 origin = -(rotation_matrix(pose.orientation).transpose() * pose.position);
  const double farthest = farthest_from(part.shape.curved, origin);
  return farthest * (1.0 + kCurvedRounding) + kPlacingError * pose.position.norm();
}

// The largest distance of a point of the part from the origin of its object.
double radius_about_origin(const Part& part) noexcept {
  if (!part.shape.bounded()) return kInfinity;
  double farthest = part.shape.is_curved() ? curved_radius_about_origin(part) : 0.0;
  for (const Vec3& anchor : part.shape.anchors) {
    farthest = std::max(farthest, transform(part.object_from_part, anchor).norm());
  }
  const double error = kPlacingError * (part.object_from_part.position.norm() +
                                        part.shape.bounding_radius + part.shape.position_error);
  return rounded_up(rounded_up(farthest) + error + part.shape.position_error + part.shape.radius);
}

double extent_of(const ConvexBody& shape) noexcept {
  if (!shape.bounded()) return kInfinity;
  return rounded_up(shape.bounding_radius + shape.position_error + shape.radius);
}

// Computes turn * point + origin, one coordinate after the other. Vector code would wait 7 ns,
// because the rotation and the position have just been written and are still in the store buffer.
inline void put(const Mat3& turn, const Vec3& point, const Vec3& origin, Vec3& placed) noexcept {
  for (int i = 0; i < 3; ++i) {
    placed[i] =
        turn(i, 0) * point.x() + turn(i, 1) * point.y() + turn(i, 2) * point.z() + origin[i];
  }
}

// The same for the length of a position that was just written.
inline double length_of(const Vec3& v) noexcept {
  return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}

inline double sum_of_sizes(const Vec3& v) noexcept {
  return std::abs(v.x()) + std::abs(v.y()) + std::abs(v.z());
}

// The product of the two poses. Orientations that need no product are kept to the bit, so that
// parallel faces stay parallel, and a rotated floor stays where it is. The product's quaternion is
// not normalised: a pose means its exact normalisation. Returns the product's rotation.
Mat3 compose_with_error(const Pose& world_from_object, PosedPart& part) noexcept {
  const Pose& offset = part.object_from_part;
  const bool offset_turns = !is_identity(offset.orientation);
  const bool object_turns = !is_identity(world_from_object.orientation);
  if (!offset_turns && offset.position.isZero(0.0)) {
    part.world_from_part = world_from_object;
    part.shift_error = part.turn_error = 0.0;
    return rotation_matrix(world_from_object.orientation);
  }
  const Mat3 turn = rotation_matrix(world_from_object.orientation);
  put(turn, offset.position, world_from_object.position, part.world_from_part.position);
  if (!offset_turns) {
    part.world_from_part.orientation = world_from_object.orientation;
  } else if (!object_turns) {
    part.world_from_part.orientation = offset.orientation;
  } else {
    part.world_from_part.orientation = world_from_object.orientation * offset.orientation;
  }
  part.turn_error = offset_turns && object_turns ? kPlacingError : 0.0;
  part.shift_error = kPlacingError * (length_of(world_from_object.position) + part.offset_length);
  return offset_turns ? rotation_matrix(part.world_from_part.orientation) : turn;
}

void place_sphere(const Mat3& turn, PosedPart& part) noexcept {
  const Vec3& position = part.world_from_part.position;
  Sphere& sphere = part.sphere_in_world;
  put(turn, part.sphere_in_part.centre, position, sphere.centre);
  const double error = kPlacingError * (part.sphere_offset + length_of(position)) +
                       part.shift_error + swept(part.turn_error, part.sphere_offset);
  sphere.radius = rounded_up(part.sphere_in_part.radius + error);
  part.coordinates = sum_of_sizes(sphere.centre) + sum_of_sizes(position);
}

// The largest change of the distance of the two parts by the orientation error of `part`. A
// rotation of the part about its origin equals the opposite rotation of the other part about the
// same point, so the smaller arm counts.
double turning_error(const PosedPart& part, const PosedPart& other) noexcept {
  if (part.turn_error == 0.0) return 0.0;
  if (part.extent <= other.extent) return swept(part.turn_error, part.extent);
  const double to_other =
      (part.world_from_part.position - other.world_from_part.position).norm() + other.extent;
  return swept(part.turn_error, std::min(part.extent, rounded_up(to_other)));
}

}  // namespace

std::vector<PosedPart> parts_of(const Scene& scene) {
  std::vector<PosedPart> parts;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    for (std::uint32_t j = 0; j < object.parts.size(); ++j) {
      const Part& part = object.parts[j];
      PosedPart placed;
      placed.object = i;
      placed.index_in_object = j;
      placed.shape = &part.shape;
      placed.object_from_part = part.object_from_part;
      placed.bounding_radius = radius_about_origin(part);
      placed.extent = extent_of(part.shape);
      placed.sphere_in_part = sphere_around(part.shape);
      placed.offset_length = part.object_from_part.position.norm();
      placed.sphere_offset = placed.sphere_in_part.centre.norm();
      placed.keeps_direction =
          (part.shape.bounded() || part.shape.is_half_space()) && !object.is_seen();
      parts.push_back(placed);
    }
  }
  return parts;
}

std::vector<std::uint32_t> first_parts(const Scene& scene) {
  std::vector<std::uint32_t> first{0};
  for (const Object& object : scene.objects) {
    first.push_back(first.back() + static_cast<std::uint32_t>(object.parts.size()));
  }
  return first;
}

void pose_parts(std::span<const TrackedObject> objects, std::span<const std::uint32_t> changed,
                std::span<const std::uint32_t> first, std::vector<PosedPart>& parts) noexcept {
  for (const std::uint32_t i : changed) {
    if (!objects[i].input.has_value) continue;
    for (std::uint32_t part = first[i]; part < first[i + 1]; ++part) place(objects[i], parts[part]);
  }
}

void place(const TrackedObject& object, PosedPart& part) noexcept {
  part.turning = swept(object.accumulated_turn, part.sphere_in_part.radius);
  if (object.moved || !part.placed) place_at(object.pose, part);
}

void place_at(const Pose& world_from_object, PosedPart& part) noexcept {
  const Mat3 turn = compose_with_error(world_from_object, part);
  place_sphere(turn, part);
  part.world_from_part_rotation = turn;
  part.placed = true;
}

double placing_error(const PosedPart& a, const PosedPart& b) noexcept {
  return rounded_up(a.shift_error + b.shift_error + turning_error(a, b) + turning_error(b, a));
}

}  // namespace clearance
