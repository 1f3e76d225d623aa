// One convex part of one object, placed in the world for this tick.
//
// The exact place of a part is its object's pose times its offset. What the queries get is that
// product in doubles, so how far the two may be apart is kept with it and becomes part of the
// bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// A sphere that holds the part; where it is unbounded, the radius is infinite.
struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = kInfinity;  // m, rounding of the centre included
};

struct PosedPart {
  std::uint32_t object = 0;           // index into Scene::objects
  std::uint32_t index_in_object = 0;  // into Object::parts

  // Of this tick, once the object has been seen.
  bool placed = false;
  Sphere sphere_in_world;
  Pose world_from_part;      // as the queries use it
  double shift_error = 0.0;  // its position is at most this far from the exact one, m
  double turn_error = 0.0;   // |R - R_exact| is at most this
  // How far turning, in all (TrackedObject::turned), can have moved a point of its sphere about the
  // sphere's middle, m.
  double turning = 0.0;
  double coordinates = 0.0;  // absolute, of its sphere and its position, all together, m
  Mat3 world_from_part_rotation = Mat3::Identity();

  // From the scene.
  const ConvexBody* shape = nullptr;
  Pose object_from_part;
  double reach = kInfinity;   // no point of it is farther from its object's origin, m
  double extent = kInfinity;  // no point of it is farther from its own origin, m
  Sphere sphere_in_part;
  double offset_length = 0.0, sphere_offset = 0.0;  // from its object's origin to its own, and on
                                                    // to the sphere's centre, m
  // A direction that separates it from another part goes on doing so, by as much more or less as
  // the two are shifted along it: bounded, or a half-space. Of other unbounded bodies rounding
  // leaves open how far along their rays a direction holds.
  bool keeps_direction = false;
};

// All parts of the scene, object by object; none placed yet.
[[nodiscard]] std::vector<PosedPart> parts_of(const Scene& scene);

// The parts of object i are first[i] .. first[i + 1], the latter excluded.
[[nodiscard]] std::vector<std::uint32_t> first_parts(const Scene& scene);

// Puts the parts of these objects, as far as they have been seen, where they are in this tick.
void pose_parts(const std::vector<TrackedObject>& objects, std::span<const std::uint32_t> changed,
                std::span<const std::uint32_t> first, std::vector<PosedPart>& parts) noexcept;

// Puts a part where its object, which has been seen, is in this tick.
void place(const TrackedObject& object, PosedPart& part) noexcept;

// Puts a part where it is when its object has this pose.
void place_at(const Pose& world_from_object, PosedPart& part) noexcept;

// How far this tick's poses of two parts, as the queries use them, can bring the parts nearer to
// each other or farther apart than the exact poses do, m.
[[nodiscard]] double placing_error(const PosedPart& a, const PosedPart& b) noexcept;

}  // namespace clearance
