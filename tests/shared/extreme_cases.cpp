#include "tests/shared/extreme_cases.hpp"

#include <cmath>
#include <numbers>

#include "tests/shared/poses.hpp"

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

// A prism without ends along z, given by small integers if `plain`.
Body column(Random& random, bool plain) {
  Body out;
  switch (random.integer(0, 3)) {
    case 0:  // floor or wall
      out.rows.push_back({random.chance(0.5) ? Vec3(0, 0, 1) : Vec3(1, 0, 0), 0.5});
      break;
    case 1: {  // slab
      const Vec3 n(random.integer(-2, 2), 1, plain ? 0 : random.integer(-2, 2));
      out.rows.push_back({n, 0.5});
      out.rows.push_back({-n, 0.25});
      break;
    }
    case 2:  // wedge
      out.rows.push_back({Vec3(1, random.integer(1, 3), 0), 0.5});
      out.rows.push_back({Vec3(1, -random.integer(1, 3), 0), 0.25});
      break;
    default: {  // prism
      const int sides = random.integer(3, 9);
      for (int k = 0; k < sides; ++k) {
        const double azimuth = 2 * std::numbers::pi * k / sides;
        out.rows.push_back({Vec3(std::cos(azimuth), std::sin(azimuth), 0), 0.5});
      }
      if (random.chance(0.3)) out.rows.push_back({Vec3(0, 0, 1), 1.0});
    }
  }
  return out;
}

}  // namespace

HardCase columns(Random& random) {
  const bool turned = random.chance(0.6);
  Body a = column(random, turned), b = column(random, turned);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  if (turned) {
    c.pose_b.orientation = test::turned(Vec3::UnitZ(), random.uniform(-3.0, 3.0));
    if (random.chance(0.3))
      c.pose_a.orientation = test::turned(Vec3::UnitZ(), random.uniform(-3.0, 3.0));
  } else {
    c.pose_a.orientation = c.pose_b.orientation = random.rotation();
  }
  c.pose_b.position = random.in_box(3.0);
  if (random.chance(0.5)) set_gap(c, random.log_uniform(1e-16, 1.0));
  return c;
}

HardCase pierced(Random& random) {
  const auto thin = [&] {
    const double thickness = random.log_uniform(1e-6, 1e-1);
    switch (random.integer(0, 2)) {
      case 0:
        return needle(random, random.log_uniform(10, 1e6));
      case 1:
        return plate(random, thickness);
      default:
        return box({1.0, thickness, 0.1});
    }
  };
  Body a = thin(), b = thin();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_a.orientation = random.rotation();
  c.pose_b.orientation = random.chance(0.5) ? random.rotation() : c.pose_a.orientation;
  const double off = random.log_uniform(1e-12, 1.0);
  c.pose_b.position = random.in_box(off);
  return c;
}

HardCase crossed_bars(Random& random) {
  const auto bar = [&] {
    const double width = random.chance(0.5) ? 0.1 : random.log_uniform(1e-3, 0.3);
    return rotated(box({1.0, width, width}),
                   test::turned(Vec3::UnitX(), random.chance(0.7) ? std::numbers::pi / 4 : 0.0));
  };
  Body a = bar(), b = random.chance(0.5) ? a : bar();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  const double turn = random.chance(0.5) ? std::numbers::pi / 2 : random.uniform(0.01, 3.0);
  c.pose_b.orientation = test::turned(Vec3::UnitZ(), turn);
  c.pose_b.position.z() = random.chance(0.3) ? 0.0 : random.log_uniform(1e-16, 0.3);
  if (random.chance(0.4)) {
    const double off = random.log_uniform(1e-17, 0.1);
    c.pose_b.position += off * random.direction();
  }
  return c;
}

HardCase bare_cores(Random& random) {
  const auto core = [&] {
    Body out;
    out.points.push_back(random.chance(0.5) ? Vec3::Zero() : random.in_box(1.0));
    if (random.chance(0.7)) {
      const double length = random.log_uniform(2e-12, 10.0);
      const Vec3 direction =
          random.chance(0.5) ? Vec3::Unit(random.integer(0, 2)) : random.direction();
      out.points.push_back(out.points[0] + length * direction);
    }
    if (random.chance(0.3)) out.radius = random.log_uniform(1e-9, 1.0);
    return out;
  };
  Body a = core();
  const bool two_cores = random.chance(0.5);
  Body b = two_cores ? core() : any_bounded(random);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  if (random.chance(0.5)) c.pose_b.orientation = random.rotation();
  if (random.chance(0.3)) c.pose_a.orientation = c.pose_b.orientation;
  if (random.chance(0.6)) {
    const double off = random.log_uniform(1e-17, 2.0);
    c.pose_b.position = off * random.direction();
  }
  return c;
}

}  // namespace clearance::hard
