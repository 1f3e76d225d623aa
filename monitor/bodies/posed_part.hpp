// One convex part of one object, placed in the world for this tick.
//
// The exact pose of a part is its object's pose times its offset. Queries get that product in
// doubles. The difference of the two is bounded here and becomes part of the bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/tracked_object.hpp"

namespace clearance {

// A sphere that holds the part. The radius of an unbounded part is infinite.
struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = kInfinity;  // m, rounding of the centre included
};

struct PosedPart {
  std::uint32_t object = 0;           // index into Scene::objects
  std::uint32_t index_in_object = 0;  // into Object::parts

  // For this tick, once the object has had a pose.
  bool placed = false;
  Sphere sphere_in_world;
  Pose world_from_part;      // as the queries use it
  double shift_error = 0.0;  // its position is at most this far from the exact one, m
  double turn_error = 0.0;   // |R - R_exact| is at most this
  // An upper bound of the motion of a point of its sphere about the sphere's centre, m, by all
  // rotation so far (TrackedObject::accumulated_turn).
  double turning = 0.0;
  double coordinates = 0.0;  // the sum of the absolute coordinates of its sphere and position, m
  Mat3 world_from_part_rotation = Mat3::Identity();

  // Constants of the scene.
  const ConvexBody* shape = nullptr;
  Pose object_from_part;
  double bounding_radius = kInfinity;  // no point of it is farther from its object's origin, m
  double extent = kInfinity;           // no point of it is farther from the part's origin, m
  Sphere sphere_in_part;
  double offset_length = 0.0;  // from its object's origin to the part's origin, m
  double sphere_offset = 0.0;  // from there to the sphere's centre, m
  // True when a direction that separates it from another part still bounds their distance after
  // both have moved (carried_gap.hpp). This is so for bounded bodies and half-spaces. For other
  // unbounded bodies, rounding leaves open how far along their rays a direction holds. No direction
  // separates all that a sensor sees.
  bool keeps_direction = false;
};

// All parts of the scene, object by object; none placed yet.
[[nodiscard]] std::vector<PosedPart> parts_of(const Scene& scene);

// The parts of object i are first[i] .. first[i + 1], the latter excluded.
[[nodiscard]] std::vector<std::uint32_t> first_parts(const Scene& scene);

// Places the parts of these objects at their poses in this tick. Objects without a pose are left
// out.
void pose_parts(std::span<const TrackedObject> objects, std::span<const std::uint32_t> changed,
                std::span<const std::uint32_t> first, std::vector<PosedPart>& parts) noexcept;

// Places a part at its pose in this tick. Requires that its object has a pose.
void place(const TrackedObject& object, PosedPart& part) noexcept;

// Places a part as it is when its object has this pose.
void place_at(const Pose& world_from_object, PosedPart& part) noexcept;

// The largest difference, m, between the distance of two parts at this tick's poses as queries use
// them and that at the exact poses.
[[nodiscard]] double placing_error(const PosedPart& a, const PosedPart& b) noexcept;

}  // namespace clearance
