#include "tests/shared/tied_cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

const Quat kTurns[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1},  {1, 1, 0, 0},
                       {1, 0, 1, 0}, {1, 0, 0, 1}, {1, 1, 1, 1}, {1, -1, 0, 0}, {0, 1, 1, 0}};

Quat any_turn(Random& random) { return kTurns[random.integer(0, 9)].normalized(); }

// Places both bodies by the same pose. Coordinates that were equal stay exactly equal.
void place_both(HardCase& c, Random& random) {
  if (random.chance(0.4)) return;
  c.pose_a.orientation = c.pose_b.orientation =
      random.chance(0.5) ? random.rotation() : any_turn(random);
  if (random.chance(0.5)) {
    const double far = random.log_uniform(1e-3, 1e6);
    c.pose_a.position = c.pose_b.position = random.in_box(far);
  }
}

double any_sign(Random& random, double magnitude) { return random.sign() * magnitude; }

}  // namespace

HardCase shared_corners(Random& random) {
  HardCase c{"", random_hull(random, random.integer(6, 16)), {}, {}, {}};
  if (random.chance(0.3)) c.a = lattice(random);
  if (c.a.points.empty()) c.a = dual_ball(random.integer(2, 3));
  // The vertices that are extreme in one direction are copied to B, together with vertices farther
  // in that direction.
  const Vec3 direction = random.direction();
  const auto height = [&](const Vec3& p) { return direction.dot(p); };
  std::sort(c.a.points.begin(), c.a.points.end(),
            [&](const Vec3& p, const Vec3& q) { return height(p) > height(q); });
  const auto common = static_cast<std::ptrdiff_t>(random.integer(1, 4));
  c.b.points.assign(c.a.points.begin(), c.a.points.begin() + common);
  const double top = height(c.a.points.front());
  for (int k = random.integer(4, 8); k > 0; --k) {
    const Vec3 p = random.in_box(1.0);
    const double up = top - height(p) + random.log_uniform(1e-6, 1.0);
    c.b.points.push_back(p + up * direction);
  }
  place_both(c, random);
  return c;
}

HardCase nested(Random& random) {
  const int kind = random.integer(0, 3), order = random.integer(2, 6);
  Body outer = kind == 0   ? facet_ball(order)
               : kind == 1 ? dual_ball(order)
               : kind == 2 ? box(Vec3::Constant(1.0))
                           : lattice(random);
  const double size = random.chance(0.3)   ? 1.0
                      : random.chance(0.5) ? 1.0 - random.log_uniform(1e-16, 0.5)
                                           : std::ldexp(1.0, -random.integer(1, 20));
  Body inner = scaled(outer, size);
  HardCase c{"", std::move(outer), std::move(inner), {}, {}};
  place_both(c, random);
  if (random.chance(0.6)) {
    const double off = random.log_uniform(1e-17, 0.3);
    const Vec3 shift = random.chance(0.5) ? Vec3::Constant(off) : Vec3(off * random.direction());
    c.pose_b.position += shift;
  }
  if (random.chance(0.5)) std::swap(c.a, c.b);
  return c;
}

HardCase twin_facets(Random& random) {
  const auto body = [&] {
    const int sides = random.integer(3, 8);
    Body out = random.chance(0.5) ? box(Vec3::Constant(0.2) + random.in_box(0.6).cwiseAbs())
                                  : plate(random, random.log_uniform(1e-3, 1.0));
    if (sides > 5) out = rotated(std::move(out), any_turn(random));
    return with_split_facets(std::move(out), random, random.log_uniform(1e-14, 1e-12));
  };
  Body a = body(), b = body();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_b.orientation = any_turn(random);
  const double reach = 2.0 * (extent(c.a) + extent(c.b));
  c.pose_b.position = Vec3::Unit(random.integer(0, 2)) * any_sign(random, reach);
  if (random.chance(0.4)) c.pose_b.position += random.in_box(0.5);
  set_gap(c, random.chance(0.3) ? 0.0 : any_sign(random, random.log_uniform(1e-16, 0.1)));
  if (random.chance(0.5)) move_together(c, random.rotation());
  return c;
}

HardCase tiny_gaps(Random& random) {
  const auto body = [&](double side) {
    const double size = std::ldexp(1.0, random.integer(-30, 30));
    Body out = random.chance(0.6) ? box({size, size, size}) : lattice(random);
    double support = 0.0;
    for (const HalfSpace& row : out.rows) {
      if (row.normal.cwiseAbs() == Vec3::UnitX()) support = std::max(support, row.offset);
    }
    for (const Vec3& p : out.points) support = std::max(support, side * p.x());
    return shifted(std::move(out), Vec3(-side * support, 0, 0));
  };
  Body a = body(1.0), b = body(-1.0);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  const double least = std::numeric_limits<double>::denorm_min();
  const double gap = random.chance(0.2)   ? 0.0
                     : random.chance(0.2) ? least
                                          : random.log_uniform(1e-320, 1e-12);
  c.pose_b.position.x() = any_sign(random, gap);
  if (random.chance(0.3)) c.pose_b.orientation = Quat(1, 1, 0, 0).normalized();  // about x
  return c;
}

HardCase mirrored(Random& random) {
  Body body = lattice(random);
  HardCase c{"", body, body, {}, {}};
  c.pose_b.orientation = any_turn(random);
  const int along = random.integer(0, 8), across = random.integer(0, 8);
  const Vec3 directions[] = {{1, 1, 0}, {1, 1, 1}, {1, 0, 0}, {0, 1, -1}, {1, -1, 1}};
  c.pose_b.position = along * directions[random.integer(0, 4)];
  if (random.chance(0.3)) c.pose_b.position += 0.5 * across * directions[random.integer(0, 4)];
  if (random.chance(0.3)) {
    const double off = random.log_uniform(1e-17, 1e-9);
    c.pose_b.position += off * random.direction();
  }
  return c;
}

HardCase open_boxes(Random& random) {
  const auto open_box = [&] {
    Body out;
    const Body whole = box(Vec3(random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), 0.5));
    for (const HalfSpace& row : whole.rows) {
      if (random.chance(0.7)) out.rows.push_back(row);
    }
    return out.rows.empty() ? whole : out;
  };
  Body a = open_box(), b = open_box();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  const Quat common = random.chance(0.8) ? random.rotation() : any_turn(random);
  const double tilt = random.log_uniform(1e-17, 1e-8);
  const auto nearly = [&](const Quat& turn) {
    Quat out = turn;
    for (int k = 0; k < 4; ++k) out.coeffs()[k] += random.uniform(-tilt, tilt);
    return out;
  };
  c.pose_a.orientation = common;
  c.pose_b.orientation =
      nearly(random.chance(0.7) ? common : common * any_turn(random).normalized());
  c.pose_a.position = random.in_box(1.0);
  c.pose_b.position = c.pose_a.position + random.in_box(random.chance(0.5) ? 1.0 : 3.0);
  return c;
}

}  // namespace clearance::hard
