// Models around a body: containment is checked in 50 digits, error bounds by samples, and laws in
// addition.
#include "tools/scene/fitting/enclosing_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/shapes.hpp"
#include "tests/shared/curved_oracle.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using oracle::Real;
using test::made;

// A round body, a long one, a thin one, or one with a protruding vertex.
ConvexBody some_body(int seed, double scale = 1.0, const Pose& pose = Pose{}) {
  Random random(static_cast<std::uint64_t>(seed) + 700);
  std::vector<Vec3> points;
  const Vec3 stretch(random.log_uniform(0.02, 1.0), random.log_uniform(0.1, 1.0), 1.0);
  const Vec3 off = random.in_box(0.5);
  const int count = random.integer(6, 60);
  for (int i = 0; i < count; ++i) {
    const Vec3 p = random.chance(0.5) ? random.direction() : random.in_box(0.8);
    points.emplace_back(scale * transform(pose, off + stretch.cwiseProduct(p)));
  }
  return made(polyhedron_from_vertices(points));
}

// The point `p` in the frame of `pose`, in 50 digits.
std::array<Real, 3> seen_from(const Pose& pose, const Vec3& p) {
  const Eigen::Quaterniond& q = pose.orientation;
  const Real w(q.w()), x(q.x()), y(q.y()), z(q.z());
  const Real s = 2 / Real(w * w + x * x + y * y + z * z);
  const Real rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
  std::array<Real, 3> own;
  for (int column = 0; column < 3; ++column) {
    own[static_cast<std::size_t>(column)] = 0;
    for (int row = 0; row < 3; ++row) {
      own[static_cast<std::size_t>(column)] +=
          rows[row][column] * (Real(p[row]) - Real(pose.position[row]));
    }
  }
  return own;
}

// Returns true if the vertex lies in the model, by the definition of the model's shape.
bool holds(const EnclosingModel& model, const Vec3& vertex) {
  const std::array<Real, 3> x = seen_from(model.frame_from_shape, vertex);
  const CurvedShape& shape = model.shape.curved;
  const Real radius(model.shape.radius);
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    Real sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Real part = x[static_cast<std::size_t>(i)] / Real(shape.semi_axes[i]);
      sum += part * part;
    }
    return sum <= 1;
  }
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    const Real r(shape.discs[0].radius);
    return x[0] * x[0] + x[1] * x[1] <= r * r && abs(x[2]) <= Real(shape.discs[1].height);
  }
  if (model.kind == ModelKind::kPolyhedron) {
    return std::all_of(model.shape.facets.begin(), model.shape.facets.end(), [&](const Facet& f) {
      const Real along =
          Real(f.normal.x()) * x[0] + Real(f.normal.y()) * x[1] + Real(f.normal.z()) * x[2];
      return along <= Real(f.offset) + Real(1e-15);
    });
  }
  // Spheres, capsules and boxes are all a box around the origin with a ball around each of its
  // points.
  Vec3 half = Vec3::Zero();
  for (const Vec3& p : model.shape.anchors) half = half.cwiseMax(p);
  Real past = 0;
  for (int i = 0; i < 3; ++i) {
    const Real over = abs(x[static_cast<std::size_t>(i)]) - Real(half[i]);
    if (over > 0) past += over * over;
  }
  return past <= radius * radius;
}

// A random point of the model's surface.
Vec3 sample(const EnclosingModel& model, Random& random) {
  const Vec3 n = random.direction();
  Vec3 p = Vec3::Zero();
  const CurvedShape& shape = model.shape.curved;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    p = shape.semi_axes.cwiseProduct(n);
  } else if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    const Disc& disc = shape.discs[random.chance(0.5) ? 0 : 1];
    p = Vec3(n.x(), n.y(), 0.0).normalized() * disc.radius + Vec3(0, 0, disc.height);
  } else {
    const auto last = static_cast<int>(model.shape.anchors.size()) - 1;
    p = model.shape.anchors[static_cast<std::size_t>(random.integer(0, last))];
  }
  return transform(model.frame_from_shape, p + model.shape.radius * n);
}

TEST(EnclosingModels, HoldEveryVertex) {
  for (int seed = 0; seed < 6; ++seed) {
    const ConvexBody body = some_body(seed);
    for (const EnclosingModel& model : enclosing_models(body)) {
      for (const Vec3& vertex : body.anchors) {
        EXPECT_TRUE(holds(model, vertex)) << seed << " " << name(model.kind);
      }
    }
  }
}

TEST(EnclosingModels, ReachNoFartherThanTheirErrorsSay) {
  for (int seed = 0; seed < 6; ++seed) {
    const ConvexBody body = some_body(seed);
    const ConvexBody at_origin = made(point(Vec3::Zero(), 0.0));
    Random random(static_cast<std::uint64_t>(seed));
    for (const EnclosingModel& model : enclosing_models(body)) {
      double farthest = 0.0;
      for (int k = 0; k < 2000; ++k) {
        Pose at;
        at.position = sample(model, random);
        farthest = std::max(farthest, test::cold(body, at_origin, at).lower);
      }
      EXPECT_LE(farthest, model.error) << seed << " " << name(model.kind);
      // The error is not much too large either: samples come close to the farthest point.
      EXPECT_GE(farthest, 0.8 * model.error) << seed << " " << name(model.kind);
    }
  }
}

TEST(EnclosingModels, ScaleWithTheBody) {
  for (int seed = 0; seed < 4; ++seed) {
    const auto models = enclosing_models(some_body(seed));
    const auto large = enclosing_models(some_body(seed, 8.0));
    ASSERT_EQ(models.size(), large.size());
    for (std::size_t i = 0; i < models.size(); ++i) {
      EXPECT_NEAR(large[i].error, 8.0 * models[i].error, 1e-6)
          << seed << " " << name(models[i].kind);
    }
  }
}

// The search minimises the volume. It may end in another of several volumes that are nearly as
// small, whose errors differ more than their volumes.
TEST(EnclosingModels, AreAboutAsGoodWhereverTheBodyIs) {
  for (int seed = 0; seed < 4; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const auto models = enclosing_models(some_body(seed));
    const auto moved = enclosing_models(some_body(seed, 1.0, random.pose(0.5)));
    for (std::size_t i = 0; i < std::min(models.size(), moved.size()); ++i) {
      // chosen greedily: ties depend on the rotation
      if (models[i].kind == ModelKind::kPolyhedron) continue;
      EXPECT_NEAR(moved[i].error, models[i].error, 0.2 * models[i].error + 1e-9)
          << seed << " " << name(models[i].kind);
    }
  }
}

TEST(EnclosingModels, OfABoxAreTheKnownOnes) {
  const ConvexBody body = made(box({0.5, 0.3, 0.2}));
  const EnclosingModel same = enclosing_box(body);
  EXPECT_LE(same.error, 1e-10);
  // The Löwner ellipsoid of a box has the box's proportions: its semi-axes are sqrt 3 times the
  // half extents.
  std::multiset<double> axes;
  const EnclosingModel ellipsoid = enclosing_ellipsoid(body);
  for (int k = 0; k < 3; ++k) axes.insert(ellipsoid.shape.curved.semi_axes[k]);
  const double expected[] = {0.2, 0.3, 0.5};
  std::size_t i = 0;
  for (double axis : axes) EXPECT_NEAR(axis, std::sqrt(3.0) * expected[i++], 1e-4);
  const double diagonal = std::sqrt(0.25 + 0.09 + 0.04);
  EXPECT_NEAR(enclosing_sphere(body).shape.radius, diagonal, 1e-3);
}

TEST(EnclosingModels, OfACubeNeedNoMoreFacetsThanItHas) {
  const ConvexBody body = test::cube();
  EXPECT_LE(enclosing_facets(body, 6).error, 1e-10);
  EXPECT_EQ(enclosing_models(body).size(), 6u);
}

}  // namespace
}  // namespace clearance
