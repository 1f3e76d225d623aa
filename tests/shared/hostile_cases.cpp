#include "tests/shared/hostile_cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/shared/poses.hpp"

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

double either_sign(Random& random, double magnitude) { return random.sign() * magnitude; }

// Moves B away from A, and in most cases back to a small gap or overlap.
void part(HardCase& c, const Vec3& direction, double size, Random& random) {
  c.pose_b.position = c.pose_a.position + 3.0 * size * direction;
  if (random.chance(0.2)) return;
  const double gap = size * random.log_uniform(1e-16, 1.0);
  set_gap(c, random.chance(0.25) ? -gap : gap);
}

Body thin_body(Random& random) {
  const double aspect = random.log_uniform(1e2, 1e6);
  return random.chance(0.5) ? needle(random, aspect) : plate(random, 1.0 / aspect);
}

// The vertices of a prism with n sides.
Body prism_corners(Random& random) {
  Body out;
  const int sides = random.integer(3, 8);
  const double height = random.log_uniform(1e-3, 1.0);
  for (int k = 0; k < sides; ++k) {
    const double azimuth = 2 * std::numbers::pi * k / sides;
    for (const double z : {-height, height}) {
      out.points.emplace_back(std::cos(azimuth), std::sin(azimuth), z);
    }
  }
  return out;
}

}  // namespace

HardCase crumpled(Random& random) {
  const double off = random.log_uniform(1e-3, 1e7);
  const auto body = [&] {
    const double tilt = random.log_uniform(1e-12, 1e-6);
    Body out = with_split_facets(thin_body(random), random, tilt);
    const Quat turn = random.rotation();
    return shifted(rotated(std::move(out), turn), off * random.direction());
  };
  Body a = body(), b = body();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_a.orientation = random.rotation();
  c.pose_b.orientation = random.chance(0.3) ? c.pose_a.orientation : random.rotation();
  part(c, random.direction(), off + 1.0, random);
  return c;
}

HardCase ulp_quads(Random& random) {
  const Quat turn = random.rotation();
  const auto body = [&] { return rotated(prism_corners(random), turn); };
  Body a = body(), b = random.chance(0.5) ? a : body();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  if (random.chance(0.5)) c.pose_a.orientation = c.pose_b.orientation = random.rotation();
  if (random.chance(0.3)) c.pose_b.orientation = test::turned(random.direction(), 1e-15);
  const Vec3 up = c.pose_a.orientation * (turn * Vec3::UnitZ());
  part(c, up, 1.0, random);
  if (random.chance(0.5)) c.pose_b.position += random.in_box(0.5);
  return c;
}

HardCase dust(Random& random) {
  const double size =
      random.chance(0.5) ? random.log_uniform(1e-10, 1e-6) : random.log_uniform(1e6, 1e11);
  const double thinnest = 2e-12 / size;
  const auto body = [&] {
    switch (random.integer(0, 3)) {
      case 0:
        return scaled(box({1.0, std::max(thinnest, random.log_uniform(1e-6, 1.0)), 1.0}), size);
      case 1:
        return scaled(random_hull(random, 8), size);
      case 2:
        return Body{{}, {size * random.in_box(1.0)}, 0.0};
      default:
        return box({1.0, 0.5, 0.25});
    }
  };
  Body a = body(), b = body();
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  if (random.chance(0.7)) c.pose_b.orientation = random.rotation();
  const double reach = extent(c.a) + extent(c.b);
  c.pose_b.position = (random.chance(0.8) ? 2.0 : 0.1) * reach * random.direction();
  if (random.chance(0.2)) {
    c.pose_b.position.x() = either_sign(random, std::numeric_limits<double>::denorm_min());
  }
  return c;
}

HardCase far_poses(Random& random) {
  Body a = any_bounded(random), b = any_bounded(random);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  const double far = random.log_uniform(1e9, 1e12);
  c.pose_a.position = random.in_box(far);
  c.pose_a.orientation = random.rotation();
  c.pose_b.orientation = random.chance(0.3) ? c.pose_a.orientation : random.rotation();
  c.pose_b.position = c.pose_a.position + 3.0 * random.direction();
  for (Pose* pose : {&c.pose_a, &c.pose_b}) {
    if (random.chance(0.3)) pose->position[random.integer(0, 2)] = -0.0;
    if (random.chance(0.2)) pose->orientation = Quat(-0.0, -1.0, 0.0, -0.0);
  }
  return c;
}

HardCase selfsame(Random& random) {
  Body body = random.chance(0.2) ? unbounded(random) : any_bounded(random);
  HardCase c{"", body, body, {}, {}};
  c.pose_a.orientation = random.chance(0.3) ? Quat(0, 0, 1, 0) : random.rotation();
  if (random.chance(0.5)) c.pose_a.position = random.in_box(10.0);
  c.pose_b = c.pose_a;
  switch (random.integer(0, 4)) {
    case 0:
      break;
    case 1:
      c.pose_b.orientation.coeffs() *= -1.0;
      break;
    case 2:
      c.pose_b.orientation.coeffs() *= 1.0 + random.uniform(-9e-7, 9e-7);
      break;
    case 3: {
      double& x = c.pose_b.orientation.coeffs()[random.integer(0, 3)];
      x = std::nextafter(x, random.chance(0.5) ? 2.0 : -2.0);
      break;
    }
    default: {
      double& x = c.pose_b.position[random.integer(0, 2)];
      x = std::nextafter(x, random.chance(0.5) ? 1e9 : -1e9);
    }
  }
  return c;
}

HardCase razors(Random& random) {
  const double off = random.chance(0.5) ? 0.0 : random.log_uniform(1e-2, 1e6);
  const auto blade = [&](double sign) {
    const double angle = random.log_uniform(1e-6, 1.0), length = random.log_uniform(1e-2, 1e3);
    Body out = wedge(angle, length);
    // about z, which makes the edge point to -x
    if (sign < 0.0) out = rotated(std::move(out), Quat(0, 0, 0, 1));
    return shifted(std::move(out), {0.0, random.uniform(-off, off), random.uniform(-1e-3, 1e-3)});
  };
  Body a = blade(1.0), b = blade(-1.0);
  HardCase c{"", std::move(a), std::move(b), {}, {}};
  c.pose_b.orientation = test::turned(Vec3::UnitX(), random.log_uniform(1e-16, 1e-3));
  c.pose_b.position.x() = random.log_uniform(1e-12, 1.0);
  if (random.chance(0.5)) move_together(c, random.rotation());
  return c;
}

}  // namespace clearance::hard
