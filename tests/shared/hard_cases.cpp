#include "tests/shared/hard_cases.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/shared/exact_oracle.hpp"
#include "tests/shared/exact_placement.hpp"
#include "tests/shared/extreme_cases.hpp"
#include "tests/shared/foil_cases.hpp"
#include "tests/shared/hostile_cases.hpp"
#include "tests/shared/sharp_cases.hpp"
#include "tests/shared/slender_cases.hpp"
#include "tests/shared/tied_cases.hpp"

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

Quat small_turn(const Vec3& axis, double angle) {
  const Vec3 v = axis * std::sin(angle / 2);
  return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

// Arguments are drawn in separate statements, because compilers evaluate the arguments of a call in
// different orders.
Quat random_turn(Random& random, double least, double most) {
  const double angle = random.log_uniform(least, most);
  return small_turn(random.direction(), angle);
}

Vec3 random_offset(Random& random, double least, double most) {
  const double length = random.log_uniform(least, most);
  return length * random.direction();
}

// Places B beside A in a random direction, disjoint from it if both are bounded.
void place_beside(HardCase& c, Random& random) {
  const double reach = std::sqrt(3.0) * (extent(c.a) + extent(c.b));
  const double distance = reach * (random.chance(0.5) ? 1.0 : random.log_uniform(1, 10));
  c.pose_b.position = c.pose_a.position + distance * random.direction();
}

HardCase placed(Body a, Body b, Random& random) {
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_a.orientation = random.rotation();
  c.pose_b.orientation = random.rotation();
  place_beside(c, random);
  return c;
}

// A gap between contact and a clear distance, relative to `size`; a quarter of the gaps are
// overlaps.
double any_gap(Random& random, double size) {
  const double magnitude = size * random.log_uniform(1e-16, 1.0);
  return random.chance(0.25) ? -magnitude : magnitude;
}

HardCase anywhere(Body a, Body b, Random& random) {
  HardCase c = placed(std::move(a), std::move(b), random);
  if (random.chance(0.6)) set_gap(c, any_gap(random, 1.0));
  return c;
}

// Moves the whole pair rigidly, up to rounding.
void move_world(HardCase& c, Random& random, double least, double most) {
  const Quat turn = random.rotation();
  move_together(c, turn, random_offset(random, least, most));
}

HardCase random_pair(Random& random) {
  Body a = any_bounded(random), b = any_bounded(random);
  return anywhere(std::move(a), std::move(b), random);
}

HardCase facet_balls(Random& random) {
  const auto ball = [&] {
    const int order = random.integer(2, 8);
    return random.chance(0.3) ? dual_ball(order) : facet_ball(order);
  };
  Body a = ball(), b = ball();
  return anywhere(std::move(a), std::move(b), random);
}

// Boxes face to face, edge to face, or vertex to vertex, parallel up to `tilt`.
HardCase parallel_boxes(Random& random) {
  const Vec3 half_a = Vec3::Constant(0.1) + random.in_box(1.0).cwiseAbs();
  Vec3 half_b = Vec3::Constant(0.1) + random.in_box(1.0).cwiseAbs();
  if (random.chance(0.3)) half_b = half_a;
  HardCase c{"", box(half_a), box(half_b), {}, {}};
  const double gap = random.chance(0.3) ? 0.0 : random.log_uniform(1e-16, 1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double touch = half_a[axis] + half_b[axis], flush = half_a[axis] - half_b[axis];
    const int how = axis == 2 ? 0 : random.integer(0, 3);
    c.pose_b.position[axis] = how == 0   ? touch + gap
                              : how == 1 ? flush
                              : how == 2 ? 0.0
                                         : random.uniform(-touch, touch);
  }
  if (random.chance(0.6)) {
    const double tilt = random.log_uniform(1e-16, 1e-3);
    c.pose_b.orientation = random_turn(random, tilt, tilt);
    c.note = "tilt " + std::to_string(std::log10(tilt));
  }
  if (random.chance(0.7)) move_world(c, random, 0.1, 10.0);
  return c;
}

// Blades edge to edge, whose edges cross or are parallel up to a tilt.
HardCase edges(Random& random) {
  const double angle_a = random.log_uniform(1e-5, 2.5), angle_b = random.log_uniform(1e-5, 2.5);
  Body a = wedge(angle_a, 1.0), b = rotated(wedge(angle_b, 1.0), Quat(0, 0, 0, 1));
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  const double angle = random.chance(0.3)   ? 0.0
                       : random.chance(0.5) ? random.log_uniform(1e-16, 1e-3)
                                            : random.uniform(0.0, 1.5);
  c.pose_b.orientation = small_turn(Vec3::UnitX(), angle);
  const double offset = random.chance(0.5) ? 0.0 : random.uniform(-1.2, 1.2);
  c.pose_b.position = {random.chance(0.3) ? 0.0 : any_gap(random, 1.0), offset, 0.0};
  if (random.chance(0.7)) move_world(c, random, 0.1, 10.0);
  return c;
}

HardCase slivers(Random& random) {
  const auto thin = [&] {
    switch (random.integer(0, 3)) {
      case 0:
        return needle(random, random.log_uniform(1e2, 1e6));
      case 1:
        return sliver(random, random.log_uniform(1e-9, 1e-2));
      case 2:
        return plate(random, random.log_uniform(1e-9, 1e-3));
      default:
        return wedge(random.log_uniform(1e-6, 1e-2), 1.0);
    }
  };
  Body a = thin();
  Body b = random.chance(0.5) ? thin() : any_bounded(random);
  return anywhere(std::move(a), std::move(b), random);
}

// Tips at which many facets meet: tip to tip, on a common axis up to a tilt, or against a face.
HardCase tips(Random& random) {
  const auto tip = [&] {
    const int sides = random.integer(3, 40);
    return cone(sides, random.log_uniform(1e-3, 1.55), 1.0);
  };
  HardCase c{"", tip(), random.chance(0.5) ? tip() : box(Vec3(0.5, 0.5, 1.0)), {}, {}};
  const double tilt = random.chance(0.3) ? 0.0 : random.log_uniform(1e-16, 1.0);
  const double spin = random.chance(0.5) ? 0.0 : random.uniform(-3.0, 3.0);
  const Quat upside_down(0, 1, 0, 0);
  c.pose_b.orientation =
      small_turn(random.direction(), tilt) * upside_down * small_turn(Vec3::UnitZ(), spin);
  c.pose_b.position = {0.0, 0.0, 2.0 + (random.chance(0.3) ? 0.0 : any_gap(random, 0.5))};
  if (random.chance(0.5)) c.pose_b.position.x() = random.log_uniform(1e-16, 1.0);
  if (random.chance(0.5)) move_world(c, random, 0.1, 10.0);
  return c;
}

HardCase badly_described(Random& random) {
  const auto body = [&] {
    Body out = random.chance(0.5) ? random_polytope(random, random.integer(4, 24))
                                  : box(Vec3::Constant(0.1) + random.in_box(1.0).cwiseAbs());
    if (random.chance(0.5)) {
      out = with_split_facets(std::move(out), random, random.log_uniform(1e-15, 1e-3));
    }
    if (random.chance(0.5)) out = with_redundant_rows(std::move(out), random);
    if (random.chance(0.5)) out = with_duplicate_rows(std::move(out), random);
    if (random.chance(0.5)) out = with_scaled_rows(std::move(out), random);
    return out;
  };
  Body a = body(), b = body();
  return anywhere(std::move(a), std::move(b), random);
}

HardCase sizes(Random& random) {
  double size_a = random.log_uniform(1e-9, 1e9), size_b = random.log_uniform(1e-9, 1e9);
  if (random.chance(0.3)) size_b = size_a;
  const auto body = [&](double size) {
    Body out = any_bounded(random);
    return scaled(size < 1e-2 ? random_hull(random, 12) : std::move(out), size);
  };
  Body a = body(size_a), b = body(size_b);
  HardCase c = placed(std::move(a), std::move(b), random);
  if (random.chance(0.7)) set_gap(c, any_gap(random, random.chance(0.5) ? size_a : size_b));
  return c;
}

// Bodies far from the world's origin, or with coordinates far from the origin of their own frame.
HardCase far_from_origin(Random& random) {
  HardCase c = random_pair(random);
  if (random.chance(0.7)) {
    move_world(c, random, 1e3, 1e7);
  }
  if (random.chance(0.4)) {
    const Vec3 offset = random_offset(random, 1e2, 1e7);
    c.a = shifted(std::move(c.a), offset);
    c.pose_a.position -= c.pose_a.orientation * offset;
  }
  return c;
}

// Contact decided by integers: a gap of exactly zero or one unit, or exactly flush faces.
HardCase lattices(Random& random) {
  HardCase c{"", lattice(random), lattice(random), {}, {}};
  for (int axis = 0; axis < 3; ++axis) c.pose_b.position[axis] = random.integer(-6, 6);
  if (random.chance(0.5)) {
    const Quat turns[] = {{1, 1, 0, 0}, {0, 0, 1, 0}, {1, 1, 1, 1}, {1, 0, 0, -1}, {0, 1, 1, 0}};
    c.pose_b.orientation =
        turns[random.integer(0, 4)].normalized();  // by 90, 180 or 120 degrees, which is exact
  }
  if (random.chance(0.3)) move_world(c, random, 0.1, 10.0);
  return c;
}

HardCase deep(Random& random) {
  Body a = any_bounded(random);
  const double size = random.log_uniform(1e-3, 1.0);
  Body b = random.chance(0.3) ? a : scaled(any_bounded(random), size);
  HardCase c = placed(std::move(a), std::move(b), random);
  c.pose_b.position = random.chance(0.3) ? Vec3::Zero() : random.in_box(0.3);
  if (random.chance(0.3)) c.pose_b.orientation = c.pose_a.orientation;
  return c;
}

HardCase floors(Random& random) {
  Body floor;
  floor.rows.push_back({Vec3(0, 0, 1), 0.0});
  HardCase c = placed(std::move(floor), any_bounded(random), random);
  if (random.chance(0.5)) c.pose_a.orientation = Quat(1, 0, 0, 0);
  if (random.chance(0.3)) c.pose_b.orientation = c.pose_a.orientation;
  if (random.chance(0.7)) set_gap(c, any_gap(random, 1.0));
  if (random.chance(0.5)) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
  }
  return c;
}

HardCase without_end(Random& random) {
  Body a = unbounded(random);
  Body b = random.chance(0.4) ? unbounded(random) : any_bounded(random);
  HardCase c = placed(std::move(a), std::move(b), random);
  const double choice = random.unit();
  if (choice < 0.4) {
    c.pose_b.orientation = c.pose_a.orientation;
  } else if (choice < 0.6) {
    c.pose_b.orientation = c.pose_a.orientation * random_turn(random, 1e-16, 1e-3);
  } else if (choice < 0.8) {
    c.pose_a.orientation = Quat(1, 0, 0, 0);
    c.pose_b.orientation = random.chance(0.5) ? Quat(0, 1, 0, 0) : Quat(1, 0, 0, 0);
  }
  if (random.chance(0.5)) set_gap(c, any_gap(random, 1.0));
  return c;
}

HardCase links(Random& random) {
  const auto body = [&] {
    const int sides = random.integer(2, 16);
    const double length = random.uniform(0.3, 3.0);
    return link(sides, length, random.log_uniform(1e-3, 0.3));
  };
  Body a = body(), b = body();
  HardCase c = anywhere(std::move(a), std::move(b), random);
  if (random.chance(0.3)) c.pose_b.orientation = c.pose_a.orientation;
  return c;
}

// Spheres and capsules. Their cores may touch or lie within each other, while their surfaces
// overlap deeply.
HardCase round_bodies(Random& random) {
  Body a = rounded(random);
  Body b = random.chance(0.4)   ? rounded(random)
           : random.chance(0.3) ? unbounded(random)
           : random.chance(0.5) ? box(Vec3(0.5, 0.5, 0.5))
                                : any_bounded(random);
  if (random.chance(0.1)) b.radius = random.log_uniform(1e-6, 1.0);
  HardCase c = placed(std::move(a), std::move(b), random);
  if (random.chance(0.4)) c.pose_a.orientation = c.pose_b.orientation = Quat(1, 0, 0, 0);
  if (random.chance(0.6)) set_gap(c, any_gap(random, 1.0));
  if (random.chance(0.2)) c.pose_b.position = c.pose_a.position;
  return c;
}

// Quaternions as far from unit length as is accepted, and rotations that almost permute the axes.
HardCase odd_poses(Random& random) {
  HardCase c = random_pair(random);
  const Quat turns[] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 1, 1, 1}, {1, 0, 0, -1}};
  for (Pose* pose : {&c.pose_a, &c.pose_b}) {
    if (random.chance(0.6)) pose->orientation = turns[random.integer(0, 4)].normalized();
    if (random.chance(0.4)) {
      pose->orientation = pose->orientation * random_turn(random, 1e-17, 1e-8);
    }
    pose->orientation.coeffs() *= random.chance(0.5) ? random.uniform(1.0 - 9e-7, 1.0 + 9e-7) : 1.0;
  }
  return c;
}

constexpr CaseFamily kCaseFamilies[] = {{"random", random_pair},
                                        {"facet_balls", facet_balls},
                                        {"parallel_boxes", parallel_boxes},
                                        {"edges", edges},
                                        {"slivers", slivers},
                                        {"tips", tips},
                                        {"badly_described", badly_described},
                                        {"sizes", sizes},
                                        {"far_from_origin", far_from_origin},
                                        {"lattices", lattices},
                                        {"deep", deep},
                                        {"floors", floors},
                                        {"without_end", without_end},
                                        {"links", links},
                                        {"round", round_bodies},
                                        {"odd_poses", odd_poses},
                                        {"shared_corners", shared_corners},
                                        {"nested", nested},
                                        {"twin_facets", twin_facets},
                                        {"tiny_gaps", tiny_gaps},
                                        {"mirrored", mirrored},
                                        {"columns", columns},
                                        {"pierced", pierced},
                                        {"crossed_bars", crossed_bars},
                                        {"bare_cores", bare_cores},
                                        {"crumpled", crumpled},
                                        {"ulp_quads", ulp_quads},
                                        {"dust", dust},
                                        {"far_poses", far_poses},
                                        {"selfsame", selfsame},
                                        {"razors", razors},
                                        {"foils", foils},
                                        {"crossing_axes", crossing_axes},
                                        {"twisted_images", twisted_images},
                                        {"slender_wedges", slender_wedges},
                                        {"broad_wedges", broad_wedges},
                                        {"broad_cones", broad_cones},
                                        {"sharp_corners", sharp_corners},
                                        {"open_boxes", open_boxes}};

}  // namespace

std::span<const CaseFamily> case_families() { return kCaseFamilies; }

HardCase case_of(const std::string& family, std::uint64_t seed) {
  const auto* const found = std::ranges::find(kCaseFamilies, family, &CaseFamily::name);
  if (found == std::end(kCaseFamilies)) throw std::invalid_argument("no hard family " + family);
  Random random(seed);
  return found->make(random);
}

void move_together(HardCase& c, const Quat& turn, const Vec3& shift) {
  for (Pose* pose : {&c.pose_a, &c.pose_b}) {
    pose->position = turn * pose->position + shift;
    pose->orientation = turn * pose->orientation;
  }
}

void set_gap(HardCase& c, double gap) {
  const oracle::ExactDistance now = oracle::exact_distance(c.a, c.pose_a, c.b, c.pose_b);
  if (now.cores_meet()) return;
  const Vec3 apart = oracle::to_vec(now.point_on_b) - oracle::to_vec(now.point_on_a);
  const double length = apart.norm();
  if (!(length > 0.0)) return;
  c.pose_b.position += apart / length * (gap - now.lower);
}

}  // namespace clearance::hard
