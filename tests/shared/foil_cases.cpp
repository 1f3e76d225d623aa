#include "tests/shared/foil_cases.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/shared/poses.hpp"

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

// Points of the unit circle: in full precision, or with so few digits that opposite points have the
// same ones.
struct Circle {
  int count;
  double start;
  bool few_digits;

  Circle(Random& random, int points)
      : count(points), start(random.unit()), few_digits(random.chance(0.5)) {}
  [[nodiscard]] Vec3 point(int i) const {
    const double angle = 2.0 * std::numbers::pi * (i + (few_digits ? 0.5 : start)) / count;
    const auto on_grid = [&](double x) {
      return few_digits ? 0x1p-20 * std::round(0x1p20 * x) : x;
    };
    return {on_grid(std::cos(angle)), on_grid(std::sin(angle)), 0.0};
  }
};

// A prism of unit radius along z, given by its sides or by its vertices.
Body prism(const Circle& circle, double half_height, bool by_rows) {
  Body out;
  const Vec3 up = half_height * Vec3::UnitZ();
  for (int i = 0; i < circle.count; ++i) {
    const Vec3 p = circle.point(i);
    if (by_rows) {
      out.rows.push_back({p, 1.0});
    } else {
      out.points.push_back(p + up);
      out.points.push_back(p - up);
    }
  }
  if (!by_rows) return out;
  out.rows.push_back({Vec3::UnitZ(), half_height});
  out.rows.push_back({-Vec3::UnitZ(), half_height});
  return out;
}

Body lens(const Circle& rim, double half_thickness) {
  Body out{{}, {half_thickness * Vec3::UnitZ(), -half_thickness * Vec3::UnitZ()}, 0.0};
  for (int i = 0; i < rim.count; ++i) out.points.push_back(rim.point(i));
  return out;
}

Body foil(Random& random) {
  const double half_thickness = random.log_uniform(1e-12, 1e-9);
  if (random.chance(0.5)) return lens(Circle(random, random.integer(29, 45)), half_thickness);
  const Circle rim(random, random.integer(55, 88));
  return prism(rim, half_thickness, random.chance(0.5));
}

Quat tilted(Random& random) {
  if (random.chance(0.4)) return Quat::Identity();
  const double most = random.chance(0.5) ? 1e-6 : 3.0;
  const double angle = random.log_uniform(1e-16, most);
  return test::turned(random.direction(), angle);
}

}  // namespace

HardCase foils(Random& random) {
  constexpr double kHalfHeight = 1.25;
  Body plate = foil(random);
  const Circle base(random, random.integer(120, 140));
  HardCase c{"", std::move(plate), prism(base, kHalfHeight, random.chance(0.5)), {}, {}};
  const double azimuth = random.uniform(-3.0, 3.0);
  const Vec3 aside(std::cos(azimuth), std::sin(azimuth), 0.0);
  const Quat spin =
      test::turned(Vec3::UnitZ(), random.chance(0.5) ? 0.0 : random.uniform(-3.0, 3.0));
  c.pose_b.orientation = tilted(random) * spin;
  c.pose_b.position = random.uniform(0.0, 1.9) * aside;
  const double choice = random.unit();
  if (choice < 0.2) {  // an end on the plate or almost on it
    const double deep = random.chance(0.3) ? 0.0 : random.log_uniform(1e-18, 1e-2);
    c.pose_b.position.z() = kHalfHeight + random.sign() * deep;
  } else if (choice < 0.5) {  // disjoint, or touching by a side, a vertex or an end
    c.pose_b.position = 5.0 * (random.chance(0.5) ? aside : random.direction());
    const double gap = random.log_uniform(1e-17, 1.0);
    set_gap(c, random.chance(0.3) ? 0.0 : random.sign() * gap);
  } else {  // through the plate
    c.pose_b.position.z() = random.uniform(-1.0, 1.0);
  }
  if (random.chance(0.3)) {
    const Quat turn = random.rotation();
    move_together(c, turn, random.in_box(3.0));
  }
  if (random.chance(0.5)) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
  }
  return c;
}

}  // namespace clearance::hard
