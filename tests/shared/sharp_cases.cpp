#include "tests/shared/sharp_cases.hpp"

#include <utility>

namespace clearance::hard {
namespace {

// The edge of this body is at z = 0. At x = 0 it has a facet with a sharp corner. At x = -1 it has
// another one, unless the body is a needle, whose edge is only a vertex.
Body sharp_body(double opening, double middle, bool needle) {
  Body out;
  out.rows.push_back({Vec3(0.0, 1.0, -opening), middle});
  out.rows.push_back({Vec3(0.0, -1.0, -opening), -middle});
  out.rows.push_back({Vec3::UnitZ(), 1.0});
  out.rows.push_back({Vec3::UnitX(), 0.0});
  out.rows.push_back({Vec3(-1.0, 0.0, needle ? -1.0 : 0.0), needle ? 0.0 : 1.0});
  return out;
}

// A body with a vertex, an edge along z or a facet normal to x at x = 0. The rest of it has x > 0.
Body body_above(Random& random) {
  const int kind = random.integer(0, 2);
  if (kind == 2) return shifted(box(Vec3(0.25, 0.25, 0.5)), Vec3(0.25, 0.0, 0.0));
  Body out;
  out.points = {{0.0, 0.0, 0.0}, {1.0, 0.5, -0.5}, {1.0, -0.5, -0.5}, {1.0, 0.0, -1.0}};
  if (kind == 1) out.points.emplace_back(0.0, 0.0, -0.75);
  return out;
}

struct SharpPair {
  Body above, sharp;
  double middle;
};

SharpPair sharp_pair(Random& random) {
  const double opening = random.log_uniform(1e-11, 1.0), middle = random.chance(0.5) ? 1.0 : 0.0;
  return {body_above(random), sharp_body(opening, middle, random.chance(0.3)), middle};
}

}  // namespace

HardCase sharp_corners(Random& random) {
  SharpPair pair = sharp_pair(random);
  HardCase c{"", std::move(pair.above), std::move(pair.sharp), {}, {}};
  const double past = random.log_uniform(1e-17, 0.5);
  c.pose_a.position = {random.log_uniform(1e-15, 1.0), pair.middle, random.sign() * past};
  if (random.chance(0.3)) c.pose_a.position.x() = random.uniform(-1.0, 0.0);
  if (random.chance(0.5)) c.pose_a.position.y() += random.integer(-2, 2) * 0x1p-53;
  if (random.chance(0.3)) move_together(c, random.rotation(), random.in_box(1.0));
  return c;
}

HardMotion past_corners(Random& random, int steps) {
  SharpPair pair = sharp_pair(random);
  HardMotion m{"past_corners", std::move(pair.above), std::move(pair.sharp), {}};
  const double above = random.log_uniform(1e-15, 1.0), from = random.log_uniform(1e-15, 1.0);
  for (int k = 0; k < steps; ++k) {
    Pose pose;
    pose.position = {above, pair.middle, from * (1.0 - 2.0 * k / steps)};
    m.poses.emplace_back(pose, Pose{});
  }
  return m;
}

}  // namespace clearance::hard
