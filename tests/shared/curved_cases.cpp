#include "tests/shared/curved_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/shared/poses.hpp"

namespace clearance::hard {

using oracle::CurvedBody;

CurvedBody truncated_cone_of(double low, double high, double half_length) {
  CurvedBody body;
  body.shape.kind = CurvedShape::Kind::kTruncatedCone;
  body.shape.discs = {Disc{-half_length, low}, Disc{half_length, high}};
  return body;
}

CurvedBody box_of(const Vec3& half) {
  CurvedBody body;
  for (int i = 0; i < 8; ++i) {
    body.points.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                             i & 4 ? half.z() : -half.z());
  }
  return body;
}

CurvedBody ellipsoid_of(const Vec3& semi_axes) {
  CurvedBody body;
  body.shape.kind = CurvedShape::Kind::kEllipsoid;
  body.shape.semi_axes = semi_axes;
  return body;
}

namespace {

CurvedBody hull_of(std::vector<Vec3> points) {
  CurvedBody body;
  body.points = std::move(points);
  return body;
}

// A cylinder, a cone or a truncated cone.
CurvedBody any_cone(Random& random, double least) {
  const double r = random.log_uniform(least, 1.0), h = random.log_uniform(least, 1.0);
  const int kind = random.integer(0, 3);
  if (kind == 0) return truncated_cone_of(r, r, h);
  if (kind == 1) return truncated_cone_of(r, 0.0, h);
  const double s = random.log_uniform(least, 1.0);
  return kind == 2 ? truncated_cone_of(r, s, h) : truncated_cone_of(0.0, s, h);
}

CurvedBody any_curved(Random& random, double least) {
  if (random.chance(0.6)) return any_cone(random, least);
  const double x = random.log_uniform(least, 1.0), y = random.log_uniform(least, 1.0);
  return ellipsoid_of({x, y, random.log_uniform(least, 1.0)});
}

CurvedBody any_polyhedron(Random& random) {
  switch (random.integer(0, 3)) {
    case 0:
      return hull_of({random.in_box(0.5)});
    case 1:
      return hull_of({random.in_box(0.5), random.in_box(0.5)});
    case 2:
      return box_of({random.log_uniform(0.01, 1.0), random.log_uniform(0.01, 1.0), 0.5});
    default: {
      std::vector<Vec3> points;
      for (int i = 0; i < 9; ++i) points.push_back(random.in_box(0.7));
      return hull_of(points);
    }
  }
}

void maybe_round(Random& random, CurvedBody& body) {
  if (random.chance(0.3)) body.radius = random.log_uniform(1e-3, 0.5);
}

double gap_of(Random& random) { return random.chance(0.15) ? 0.0 : random.log_uniform(1e-14, 2.0); }

double tilt_of(Random& random) {
  return random.chance(0.25) ? 0.0 : random.log_uniform(1e-14, 1e-3);
}

// Moves both bodies together in half of the cases, after which nothing is parallel to the world's
// axes.
void move_together(Random& random, CurvedCase& c) {
  if (random.chance(0.5)) return;
  const Pose world = random.pose(random.log_uniform(0.1, 10.0));
  c.pose_a = compose(world, c.pose_a);
  c.pose_b = compose(world, c.pose_b);
}

// The support point along n of the rotated body; a radius adds to it.
Vec3 support_point(const CurvedBody& body, const Eigen::Quaterniond& turn, const Vec3& n) {
  const Vec3 m = turn.conjugate() * n;
  Vec3 best = Vec3::Zero();
  if (!body.points.empty()) {
    best = *std::max_element(body.points.begin(), body.points.end(),
                             [&](const Vec3& p, const Vec3& q) { return m.dot(p) < m.dot(q); });
  } else if (body.shape.kind == CurvedShape::Kind::kEllipsoid) {
    const Vec3 axes = body.shape.semi_axes, stretched = axes.cwiseProduct(m);
    best = axes.cwiseProduct(stretched) / stretched.norm();
  } else {
    const Vec3 across(m.x(), m.y(), 0.0);
    double support_value = -kInfinity;
    for (const Disc& disc : body.shape.discs) {
      Vec3 p(0.0, 0.0, disc.height);
      if (!across.isZero()) p += disc.radius * across.normalized();
      if (m.dot(p) > support_value) best = p;
      support_value = std::max(support_value, m.dot(p));
    }
  }
  return turn * best + body.radius * n;
}

// Places B so that its support point along -n lies `gap` beyond A's support point along n. The
// distance is then `gap`.
void face(CurvedCase& c, const Vec3& n, double gap) {
  const Vec3 on_a = support_point(c.a, c.pose_a.orientation, n);
  const Vec3 on_b = support_point(c.b, c.pose_b.orientation, -n);
  c.pose_b.position = c.pose_a.position + on_a + gap * n - on_b;
}

CurvedCase of_any_kinds(Random& random) {
  CurvedCase c;
  c.a = any_curved(random, 0.05);
  c.b = random.chance(0.5) ? any_curved(random, 0.05) : any_polyhedron(random);
  maybe_round(random, c.a);
  maybe_round(random, c.b);
  if (random.chance(0.5)) std::swap(c.a, c.b);
  c.pose_a = random.pose(1.5);
  c.pose_b = random.pose(1.5);
  if (random.chance(0.4)) face(c, random.direction(), gap_of(random));
  return c;
}

CurvedCase of_thin_ones(Random& random) {
  CurvedCase c;
  const auto thin = [&]() -> CurvedBody {
    const double ratio = random.log_uniform(1e-4, 1e-2);
    switch (random.integer(0, 3)) {
      case 0:
        return ellipsoid_of({1.0, random.uniform(0.5, 1.0), ratio});
      case 1:
        return ellipsoid_of({ratio, ratio * random.uniform(0.5, 1.0), 1.0});
      case 2:
        return truncated_cone_of(1.0, random.chance(0.5) ? 0.0 : 1.0, ratio);
      default:
        return truncated_cone_of(ratio, random.chance(0.5) ? 0.0 : ratio, 1.0);
    }
  };
  c.a = thin();
  c.b = random.chance(0.7) ? thin() : any_curved(random, 0.1);
  c.pose_b.orientation = random.rotation();
  face(c, random.direction(), gap_of(random));
  move_together(random, c);
  return c;
}

CurvedCase of_parallel_caps(Random& random) {
  CurvedCase c;
  c.a = any_cone(random, 0.05);
  c.b = random.chance(0.8) ? any_cone(random, 0.05) : box_of({0.5, 0.3, 0.2});
  maybe_round(random, c.b);
  c.pose_b.orientation = test::turned(random.direction(), tilt_of(random));
  face(c, Vec3::UnitZ(), gap_of(random));
  c.pose_b.position += Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0.0);
  move_together(random, c);
  return c;
}

CurvedCase of_one_axis(Random& random) {
  CurvedCase c;
  c.a = any_curved(random, 0.01);
  c.b = any_curved(random, 0.01);
  maybe_round(random, c.a);
  if (random.chance(0.5)) c.pose_b.orientation = test::turned(Vec3::UnitX(), tilt_of(random));
  face(c, Vec3::UnitZ(), gap_of(random));
  if (random.chance(0.3)) c.pose_b.position.x() += random.log_uniform(1e-14, 1e-3);
  move_together(random, c);
  return c;
}

CurvedCase of_rims(Random& random) {
  CurvedCase c;
  c.a = any_cone(random, 0.1);
  c.b = any_cone(random, 0.1);
  const double angle = random.uniform(0.1, 1.4);
  const Vec3 n(std::sin(angle), 0.0, std::cos(angle));
  c.pose_b.orientation = random.chance(0.5)
                             ? test::turned(Vec3::UnitZ(), random.uniform(0.0, 6.0))
                             : test::turned(Vec3::UnitY(), random.uniform(-1.5, 1.5));
  face(c, n, gap_of(random));
  move_together(random, c);
  return c;
}

CurvedCase of_an_apex(Random& random) {
  CurvedCase c;
  c.a = truncated_cone_of(random.log_uniform(1e-3, 1.0), 0.0, random.log_uniform(0.05, 1.0));
  c.b = random.chance(0.6) ? any_curved(random, 0.05) : any_polyhedron(random);
  c.pose_b.orientation = random.rotation();
  const Vec3 n = Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1.0).normalized();
  face(c, n, gap_of(random));
  move_together(random, c);
  return c;
}

// Two bodies side by side, with parallel generators up to a tilt.
CurvedCase of_tilted_sides(Random& random) {
  CurvedCase c;
  c.a = any_cone(random, 0.1);
  c.b = random.chance(0.7) ? c.a : box_of({0.4, 0.3, 0.5});
  if (random.chance(0.5)) c.pose_b.orientation = test::turned(Vec3::UnitX(), 3.14159265358979);
  c.pose_b.orientation = test::turned(random.direction(), tilt_of(random)) * c.pose_b.orientation;
  const Disc &low = c.a.shape.discs[0], &high = c.a.shape.discs[1];
  const Vec3 n = Vec3(high.height - low.height, 0.0, low.radius - high.radius).normalized();
  face(c, n, gap_of(random));
  move_together(random, c);
  return c;
}

CurvedCase of_one_centre(Random& random) {
  CurvedCase c;
  c.a = any_curved(random, 0.05);
  c.b = random.chance(0.7) ? any_curved(random, 0.05) : any_polyhedron(random);
  if (random.chance(0.7)) c.pose_b.orientation = random.rotation();
  if (random.chance(0.5)) c.pose_b.position = random.log_uniform(1e-14, 1e-1) * random.direction();
  return c;
}

CurvedCase of_nearly_spherical_ones(Random& random) {
  CurvedCase c;
  const auto body = [&] {
    const double off = random.log_uniform(1e-14, 1e-7), r = random.log_uniform(0.1, 1.0);
    return ellipsoid_of({r, r * (1.0 + off), r * (1.0 + off * random.unit())});
  };
  c.a = body();
  c.b = random.chance(0.7) ? body() : any_curved(random, 0.1);
  c.pose_b.orientation = random.rotation();
  face(c, random.direction(), gap_of(random));
  move_together(random, c);
  return c;
}

constexpr CurvedFamily kFamilies[] = {{"any", of_any_kinds},
                                      {"thin", of_thin_ones},
                                      {"caps", of_parallel_caps},
                                      {"axis", of_one_axis},
                                      {"rims", of_rims},
                                      {"apex", of_an_apex},
                                      {"tilted", of_tilted_sides},
                                      {"centre", of_one_centre},
                                      {"nearly_spherical", of_nearly_spherical_ones}};

}  // namespace

std::span<const CurvedFamily> curved_families() { return kFamilies; }

ShapeResult curved_model(const CurvedBody& body) {
  const std::array<Disc, 2>& discs = body.shape.discs;
  switch (body.shape.kind) {
    case CurvedShape::Kind::kEllipsoid:
      return ellipsoid(body.shape.semi_axes, body.radius);
    case CurvedShape::Kind::kTruncatedCone:
      return truncated_cone(discs[0].radius, discs[1].radius, discs[1].height, body.radius);
    case CurvedShape::Kind::kNone:
      break;
  }
  if (body.points.size() == 1) return point(body.points[0], body.radius);
  if (body.points.size() == 2) return segment(body.points[0], body.points[1], body.radius);
  ShapeResult made = polyhedron_from_vertices(body.points);
  if (auto* hull = std::get_if<ConvexBody>(&made)) hull->radius = body.radius;
  return made;
}

}  // namespace clearance::hard
