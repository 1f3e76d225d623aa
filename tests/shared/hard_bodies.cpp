#include "tests/shared/hard_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/shared/exact_placement.hpp"

namespace clearance::hard {
namespace {

constexpr double kPi = std::numbers::pi;

void add_row(Body& body, const Vec3& normal, double offset) {
  body.rows.push_back({normal, offset});
}

Vec3 perpendicular(const Vec3& n, Random& random) {
  const Vec3 v = n.cross(random.direction());
  return v / std::max(v.norm(), 1e-300);
}

// The value at the fraction u between `low` and `high` on a logarithmic scale.
double between(double u, double low, double high) { return low * std::pow(high / low, u); }

}  // namespace

Body box(const Vec3& half_extents) {
  Body out;
  for (int axis = 0; axis < 3; ++axis) {
    add_row(out, Vec3::Unit(axis), half_extents[axis]);
    add_row(out, -Vec3::Unit(axis), half_extents[axis]);
  }
  return out;
}

Body random_polytope(Random& random, int facets) {
  Body out;
  for (int k = 4; k < facets; ++k) add_row(out, random.direction(), random.uniform(0.5, 1.0));
  // The facets with a tetrahedron's normals make the body bounded.
  const Eigen::Quaterniond turn = random.rotation();
  for (const Vec3& n : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
    add_row(out, turn * n, random.uniform(0.9, 1.7));
  }
  return out;
}

Body random_hull(Random& random, int points) {
  Body out;
  const bool on_sphere = random.chance(0.5);
  for (int k = 0; k < points; ++k) {
    out.points.push_back(on_sphere ? random.direction() : random.in_box(1.0));
  }
  return out;
}

Body facet_ball(int order) {
  Body out;
  for (int ring = 0; ring <= order; ++ring) {
    const double polar = kPi * ring / order;
    const int around = std::max(1, static_cast<int>(std::lround(2 * order * std::sin(polar))));
    for (int k = 0; k < around; ++k) {
      const double azimuth = 2 * kPi * k / around;
      const double radius = ring == 0 || ring == order ? 0.0 : std::sin(polar);
      add_row(out, {radius * std::cos(azimuth), radius * std::sin(azimuth), std::cos(polar)}, 1.0);
    }
  }
  return out;
}

Body dual_ball(int order) {
  Body out;
  for (const HalfSpace& row : facet_ball(order).rows) out.points.push_back(row.normal);
  return out;
}

Body cone(int sides, double half_angle, double height) {
  Body out;
  for (int k = 0; k < sides; ++k) {
    const double azimuth = 2 * kPi * k / sides;
    const Vec3 n(std::cos(half_angle) * std::cos(azimuth), std::cos(half_angle) * std::sin(azimuth),
                 std::sin(half_angle));
    add_row(out, n, n.z() * height);
  }
  add_row(out, {0, 0, -1}, 0.0);
  return out;
}

Body wedge(double angle, double half_length) {
  Body out;
  const double c = std::cos(angle / 2), s = std::sin(angle / 2);
  add_row(out, {s, 0, c}, 0.0);
  add_row(out, {s, 0, -c}, 0.0);
  add_row(out, {-1, 0, 0}, 1.0);
  add_row(out, {0, 1, 0}, half_length);
  add_row(out, {0, -1, 0}, half_length);
  return out;
}

Body needle(Random& random, double aspect) {
  Body out;
  const int sides = random.integer(3, 8);
  const double start = random.uniform(0.0, 2 * kPi);
  for (int k = 0; k < sides; ++k) {
    const double azimuth = start + 2 * kPi * k / sides;
    // In some cases the prism is tapered towards one end.
    const double taper = random.chance(0.5) ? 1.0 / aspect : 0.0;
    add_row(out, {std::cos(azimuth), std::sin(azimuth), taper}, 1.0 / aspect);
  }
  add_row(out, {0, 0, 1}, 1.0);
  add_row(out, {0, 0, -1}, 1.0);
  return out;
}

Body sliver(Random& random, double flatness) {
  Body out;
  for (int k = 0; k < 4; ++k) {
    const Vec3 p = random.in_box(1.0);
    out.points.emplace_back(p.x(), p.y(), p.z() * flatness);
  }
  return out;
}

Body plate(Random& random, double thickness) {
  Body out;
  const int sides = random.integer(3, 12);
  for (int k = 0; k < sides; ++k) {
    const double azimuth = 2 * kPi * (k + random.uniform(-0.2, 0.2)) / sides;
    add_row(out, {std::cos(azimuth), std::sin(azimuth), 0}, random.uniform(0.7, 1.0));
  }
  add_row(out, {0, 0, 1}, thickness / 2);
  add_row(out, {0, 0, -1}, thickness / 2);
  return out;
}

Body link(int sides, double length, double thickness) {
  Body out;
  const double radius = 0.25;
  for (int end = 0; end < 2; ++end) {
    for (int k = 0; k <= sides; ++k) {
      const double azimuth = kPi * (k / static_cast<double>(sides) - 0.5) + kPi * end;
      const Vec3 n(std::cos(azimuth), std::sin(azimuth), 0);
      add_row(out, n, radius + std::abs(n.x()) * length / 2);
    }
  }
  add_row(out, {0, 0, 1}, thickness / 2);
  add_row(out, {0, 0, -1}, thickness / 2);
  return out;
}

Body lattice(Random& random) {
  Body out;
  if (random.chance(0.3)) {
    const int x = random.integer(1, 3), y = random.integer(1, 3), z = random.integer(1, 3);
    out = box(Vec3(x, y, z));
    if (random.chance(0.5)) add_row(out, {1, 1, 1}, random.integer(2, 6));
    if (random.chance(0.5)) add_row(out, {1, -1, 0}, random.integer(1, 4));
    return out;
  }
  const auto corner = [&](int x, int y, int z) { out.points.emplace_back(x, y, z); };
  corner(0, 0, 0);
  corner(random.integer(1, 4), 0, 0);
  corner(0, random.integer(1, 4), 0);
  corner(0, 0, random.integer(1, 4));
  for (int k = random.integer(0, 10); k > 0; --k) {
    const int x = random.integer(-4, 4), y = random.integer(-4, 4), z = random.integer(-4, 4);
    corner(x, y, z);
  }
  return out;
}

Body unbounded(Random& random) {
  Body out;
  const double tilt = random.chance(0.4) ? random.log_uniform(1e-5, 1e-2) : 0.0;
  const int sides = random.integer(3, 24);
  const int kind = random.integer(0, 7);
  switch (kind) {
    case 0:  // half-space
      add_row(out, {0, 0, 1}, 0.0);
      break;
    case 1:  // slab, or a wedge whose edge is far away
      add_row(out, {0, tilt, 1}, 0.5);
      add_row(out, {0, 0, -1}, 0.5);
      break;
    case 2:  // wedge
      out.rows = wedge(random.log_uniform(1e-5, 3.0), 1.0).rows;
      out.rows.resize(2);
      break;
    case 3:  // corner of three planes
      add_row(out, {1, tilt, 0}, 0.3);
      add_row(out, {0, 1, 0}, 0.2);
      add_row(out, {0, 0, 1}, 0.1);
      break;
    case 4:  // cone
      out.rows = cone(sides, random.log_uniform(1e-4, 1.4), 0.5).rows;
      out.rows.pop_back();
      break;
    case 5:  // prism without ends
      out.rows = plate(random, 1.0).rows;
      out.rows.resize(out.rows.size() - 2);
      break;
    case 6:  // prism with one end
      out.rows = plate(random, 1.0).rows;
      out.rows.pop_back();
      break;
    default:  // some facets of a polytope
      out.rows = random_polytope(random, random.integer(5, 20)).rows;
      out.rows.resize(static_cast<std::size_t>(random.integer(1, 3)));
  }
  Body turned = random.chance(0.5) ? rotated(out, random.rotation()) : out;
  // under a rotation its sides would not stay parallel
  const bool is_prism = kind == 5 || kind == 6;
  return is_prism ? out : turned;
}

Body rounded(Random& random) {
  Body out;
  out.radius = random.chance(0.2) ? 0.0 : random.log_uniform(1e-6, 1.0);
  const bool axis_aligned = random.chance(0.4);
  out.points.push_back(axis_aligned ? Vec3(0, 0, -0.5) : random.in_box(1.0));
  if (random.chance(0.6)) {
    const Vec3 direction = axis_aligned ? Vec3(0, 0, 1) : random.direction();
    const double length = random.chance(0.3) ? random.log_uniform(1e-9, 1e3) : 1.0;
    out.points.push_back(out.points[0] + length * direction);
  }
  return out;
}

Body any_bounded(Random& random) {
  const int kind = random.integer(0, 11), count = random.integer(3, 40);
  const double u = random.unit(), v = random.unit();
  switch (kind) {
    case 0:
      return box({between(u, 0.05, 1), between(v, 0.05, 1), random.log_uniform(0.05, 1)});
    case 1:
      return random_hull(random, count + 2);
    case 2:
      return facet_ball(2 + count / 8);
    case 3:
      return dual_ball(2 + count / 10);
    case 4:
      return cone(count, between(u, 0.01, 1.5), 1.0);
    case 5:
      return needle(random, between(u, 10, 1e6));
    case 6:
      return sliver(random, between(u, 1e-9, 0.1));
    case 7:
      return plate(random, between(u, 1e-9, 0.1));
    case 8:
      return link(2 + count / 5, 0.5 + v, between(u, 1e-3, 0.3));
    case 9:
      return lattice(random);
    case 10:
      return wedge(between(u, 1e-6, 2.5), between(v, 0.01, 1));
    default:
      return random_polytope(random, count + 1);
  }
}

Body with_duplicate_rows(Body body, Random& random) {
  const std::size_t count = body.rows.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (random.chance(0.4)) continue;
    HalfSpace row = body.rows[k];
    switch (random.integer(0, 2)) {
      case 0:  // the same doubles
        break;
      case 1: {  // exactly the same plane
        const double factor = std::ldexp(1.0, random.integer(-40, 40));
        row = {row.normal * factor, row.offset * factor};
        break;
      }
      default: {  // almost the same plane
        const double length = row.normal.norm();
        const double tilt = random.log_uniform(1e-16, 1e-4);
        row.normal += perpendicular(row.normal, random) * length * tilt;
      }
    }
    body.rows.insert(body.rows.begin() + random.integer(0, static_cast<int>(body.rows.size())),
                     row);
  }
  return body;
}

Body with_redundant_rows(Body body, Random& random) {
  oracle::ExactBody exact(body);
  for (int k = random.integer(1, 8); k > 0; --k) {
    const Vec3 n = random.direction();
    const oracle::Support at = exact.support(oracle::primitive(oracle::exact(n)));
    if (at.is_ray) continue;
    const double slack = random.chance(0.5) ? 0.0 : random.log_uniform(1e-16, 10.0);
    add_row(body, n, n.dot(oracle::to_vec(at.vector)) + slack);
  }
  return body;
}

Body with_split_facets(Body body, Random& random, double tilt) {
  const std::vector<HalfSpace> rows = std::move(body.rows);
  body.rows.clear();
  for (const HalfSpace& row : rows) {
    for (int k = random.integer(1, 4); k > 0; --k) {
      const Vec3 aside = perpendicular(row.normal, random) * row.normal.norm();
      const Vec3 n = row.normal + aside * tilt;
      add_row(body, n, row.offset * (1.0 + random.uniform(-0.1, 0.1) * tilt));
    }
  }
  return body;
}

Body with_scaled_rows(Body body, Random& random) {
  for (HalfSpace& row : body.rows) {
    const double factor = random.log_uniform(1e-9, 1e9);
    row = {row.normal * factor, row.offset * factor};
  }
  return body;
}

Body scaled(Body body, double factor) {
  for (HalfSpace& row : body.rows) row.offset *= factor;
  for (Vec3& point : body.points) point *= factor;
  body.radius *= factor;
  return body;
}

Body shifted(Body body, const Vec3& offset) {
  for (HalfSpace& row : body.rows) row.offset += row.normal.dot(offset);
  for (Vec3& point : body.points) point += offset;
  return body;
}

Body rotated(Body body, const Eigen::Quaterniond& rotation) {
  for (HalfSpace& row : body.rows) row.normal = rotation * row.normal;
  for (Vec3& point : body.points) point = rotation * point;
  return body;
}

double extent(const Body& body) {
  oracle::ExactBody exact(body);
  double out = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      oracle::IntegerVec direction;
      direction[static_cast<std::size_t>(axis)] = side;
      const oracle::Support at = exact.support(direction);
      if (!at.is_ray) out = std::max(out, oracle::to_vec(at.vector).cwiseAbs().maxCoeff());
    }
  }
  return out + body.radius;
}

}  // namespace clearance::hard
