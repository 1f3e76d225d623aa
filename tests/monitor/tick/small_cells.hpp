// Cells of capsules, spheres and boxes for the tests of the tick, and the true distance of
// capsules.
//
// The oracle is the closed form for two segments, in long double and with exact part offsets. It
// shares nothing with core/.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/scene/scene.hpp"
#include "core/shapes.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

inline constexpr std::int64_t kTick = 1'000'000;                   // ns
inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000;  // ns

[[nodiscard]] inline Part ball(double radius, const Pose& object_from_part = {}) {
  return {"ball", made(point(Vec3::Zero(), radius)), object_from_part};
}

// A capsule along x of the part. Its centre is the part's origin.
[[nodiscard]] inline Part capsule(double length, double radius, const Pose& object_from_part = {}) {
  const Vec3 end(0.5 * length, 0.0, 0.0);
  return {"capsule", made(segment(-end, end, radius)), object_from_part};
}

[[nodiscard]] inline Part block(const Vec3& half_extents, const Pose& object_from_part = {}) {
  return {"block", made(box(half_extents)), object_from_part};
}

// The half-space below z = 0 of the part.
[[nodiscard]] inline Part floor(const Pose& object_from_part = {}) {
  return {"floor", half_space(Vec3::UnitZ(), 0.0), object_from_part};
}

// A moving object. Most tests choose its pose themselves.
[[nodiscard]] inline Object moving(std::string name, std::vector<Part> parts) {
  Object object;
  object.may_jump = true;
  object.name = std::move(name);
  object.parts = std::move(parts);
  object.age_limit_ns = 20 * kTick;
  return object;
}

[[nodiscard]] inline Object fixed(std::string name, std::vector<Part> parts, const Pose& pose) {
  Object object = moving(std::move(name), std::move(parts));
  object.fixed = true;
  object.world_from_object = pose;
  return object;
}

// All pairs with a moving object; no published pairs and no zones.
[[nodiscard]] inline Scene cell_of(std::vector<Object> objects) {
  Scene scene;
  scene.name = "small";
  scene.revision = 7;
  scene.objects = std::move(objects);
  for (std::uint32_t a = 0; a < scene.objects.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.objects.size(); ++b) {
      if (!scene.objects[a].fixed || !scene.objects[b].fixed) scene.pairs.push_back({a, b, false});
    }
  }
  return scene;
}

// A zone over every pair of the cell.
[[nodiscard]] inline Zone zone_over(const Scene& scene, double enter_below, double leave_above) {
  Zone zone{"zone", "all", "all", enter_below, leave_above, {}};
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) zone.pairs.push_back(p);
  return zone;
}

[[nodiscard]] inline PoseSample sample(std::uint32_t object, const Pose& pose,
                                       std::int64_t stamp_ns) {
  PoseSample s;
  s.object = object;
  s.stamp_ns = stamp_ns;
  s.world_from_object = pose;
  return s;
}

using LongVec = Eigen::Matrix<long double, 3, 1>;

[[nodiscard]] inline LongVec exactly(const Pose& pose, const LongVec& point) {
  const Eigen::Quaternion<long double> q = pose.orientation.cast<long double>().normalized();
  return q.toRotationMatrix() * point + pose.position.cast<long double>();
}

// Both end points of a ball's or capsule's segment in the world.
[[nodiscard]] inline std::array<LongVec, 2> segment_in_world(const Part& part,
                                                             const Pose& world_from_object) {
  std::array<LongVec, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3& anchor = part.shape.anchors[i % part.shape.anchors.size()];
    ends[i] =
        exactly(world_from_object, exactly(part.object_from_part, anchor.cast<long double>()));
  }
  return ends;
}

[[nodiscard]] inline long double point_to_segment(const LongVec& p,
                                                  const std::array<LongVec, 2>& s) {
  const LongVec along = s[1] - s[0];
  const long double square = along.squaredNorm();
  const long double t = square > 0 ? (p - s[0]).dot(along) / square : 0.0L;
  return (s[0] + std::clamp(t, 0.0L, 1.0L) * along - p).norm();
}

[[nodiscard]] inline long double segment_to_segment(const std::array<LongVec, 2>& a,
                                                    const std::array<LongVec, 2>& b) {
  long double least = std::min(std::min(point_to_segment(a[0], b), point_to_segment(a[1], b)),
                               std::min(point_to_segment(b[0], a), point_to_segment(b[1], a)));
  const LongVec u = a[1] - a[0], v = b[1] - b[0], w = a[0] - b[0];
  const long double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
  const long double determinant = uu * vv - uv * uv;
  if (determinant <= 0) return least;
  const long double s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
  const long double t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
  if (s < 0 || s > 1 || t < 0 || t > 1) return least;
  return std::min(least, (w + s * u - t * v).norm());
}

// The true distance of two objects made of balls and capsules. Intersecting segments do not occur
// in random cells.
[[nodiscard]] inline long double true_distance(const Object& a, const Pose& world_from_a,
                                               const Object& b, const Pose& world_from_b) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Part& part_a : a.parts) {
    for (const Part& part_b : b.parts) {
      const long double apart = segment_to_segment(segment_in_world(part_a, world_from_a),
                                                   segment_in_world(part_b, world_from_b));
      least = std::min(least, apart - part_a.shape.radius - part_b.shape.radius);
    }
  }
  return least;
}

// The report of the pair of these two objects, in either order.
inline PairReport report_between(const Scene& scene, const Monitor& monitor, const std::string& a,
                                 const std::string& b) {
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    const std::string &first = scene.objects[scene.pairs[pair].first].name,
                      &second = scene.objects[scene.pairs[pair].second].name;
    if ((first == a && second == b) || (first == b && second == a)) return monitor.pair(pair);
  }
  ADD_FAILURE() << a << " - " << b << " is not watched";
  return {};
}

}  // namespace clearance::test
