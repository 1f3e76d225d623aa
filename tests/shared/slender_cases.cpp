#include "tests/shared/slender_cases.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/shared/poses.hpp"

namespace clearance::hard {
namespace {

Body segment(Random& random) {
  const Vec3 end = random.uniform(0.1, 2.0) * Vec3::UnitX();
  const double radius = random.chance(0.5) ? 0.0 : random.log_uniform(1e-3, 0.3);
  return {{}, {-end, end}, radius};
}

// An unbounded wedge that opens downwards. The origin is its tip, or lies on its edge.
Body wedge_without_end(Random& random) {
  const double opening = random.log_uniform(1e-5, 1e-2);
  const int sides = random.chance(0.5) ? 2 : random.integer(3, 8);
  Body out;
  for (int k = 0; k < sides; ++k) {
    const double azimuth = 2 * std::numbers::pi * k / sides;
    out.rows.push_back({Vec3(std::cos(azimuth), std::sin(azimuth), opening), 0.0});
  }
  if (sides == 2) out.rows[1].normal = {-1.0, 0.0, opening};
  if (random.chance(0.5) && sides == 2) out.rows.push_back({Vec3::UnitY(), 1.0});
  return out;
}

Body broad_wedge(Random& random) {
  const auto slope = [&] { return random.log_uniform(1e-6, 1e-2); };
  Body out;
  out.rows.push_back({Vec3(slope(), 0.0, 1.0), 0.5});
  out.rows.push_back({Vec3(-slope(), 0.0, 1.0), 0.5});
  return out;
}

// The sides have equal slopes or independent ones. In some cases they do not meet in one tip.
Body broad_cone(Random& random) {
  const auto slope = [&] { return random.log_uniform(1e-5, 1e-2); };
  const double alike = random.chance(0.5) ? slope() : 0.0;
  const int sides = random.integer(3, 8);
  const bool tip = random.chance(0.7);
  Body out;
  for (int k = 0; k < sides; ++k) {
    const double azimuth = 2 * std::numbers::pi * (k + random.uniform(0.0, 0.5)) / sides;
    const double leaning = alike > 0.0 ? alike : slope();
    const double offset = tip ? 0.5 : 0.5 + random.log_uniform(1e-16, 1e-2);
    out.rows.push_back(
        {Vec3(leaning * std::cos(azimuth), leaning * std::sin(azimuth), 1.0), offset});
  }
  return out;
}

// The two bodies in either order. The offset of their origins is up to `apart` along each axis.
HardCase with_any_bounded(Body wedge, double apart, Random& random) {
  Body other = any_bounded(random);
  if (random.chance(0.5)) std::swap(wedge, other);
  HardCase c{"", std::move(wedge), std::move(other), {}, {}};
  c.pose_b.position = random.in_box(apart);
  if (random.chance(0.5)) c.pose_b.orientation = random.rotation();
  if (random.chance(0.5)) move_together(c, random.rotation(), random.in_box(1.0));
  return c;
}

}  // namespace

HardCase crossing_axes(Random& random) {
  Body a = segment(random), b = segment(random);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_b.orientation = test::turned(Vec3::UnitZ(), random.log_uniform(1e-16, 1e-2));
  c.pose_b.position.x() = random.uniform(-0.5, 0.5);
  if (random.chance(0.5)) c.pose_b.position.z() = random.log_uniform(1e-16, 1e-2);
  if (random.chance(0.7)) move_together(c, random.rotation(), random.in_box(1.0));
  return c;
}

HardCase twisted_images(Random& random) {
  Body a;
  for (int k = random.integer(5, 8); k > 0; --k) {
    a.points.emplace_back(random.integer(-2, 2), random.integer(-2, 2), random.integer(-2, 2));
  }
  // Together with these points, any of the others form a solid.
  for (const Vec3& corner : {Vec3(2, 2, 0), Vec3(-2, 2, 0), Vec3(0, 2, 1), Vec3(0, 1, 0)}) {
    a.points.push_back(corner);
  }
  const Eigen::Quaterniond turn = random.rotation();  // so that no edge is parallel to an axis
  a = rotated(std::move(a), turn);
  Body b = a;
  for (Vec3& point : b.points) point = -point;
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_b.orientation = test::turned(random.direction(), random.log_uniform(1e-12, 0.1));
  c.pose_b.position = turn * (8.0 * Vec3::UnitY() + random.in_box(1.0));
  set_gap(c, random.log_uniform(1e-9, 1.0));
  move_together(c, random.rotation());
  return c;
}

HardCase slender_wedges(Random& random) {
  return with_any_bounded(wedge_without_end(random), 10.0, random);
}

HardCase broad_wedges(Random& random) {
  Body wedge = broad_wedge(random);
  return with_any_bounded(std::move(wedge), random.chance(0.5) ? 3.0 : 10.0, random);
}

HardCase broad_cones(Random& random) {
  Body cone = broad_cone(random);
  return with_any_bounded(std::move(cone), random.chance(0.5) ? 3.0 : 10.0, random);
}

}  // namespace clearance::hard
