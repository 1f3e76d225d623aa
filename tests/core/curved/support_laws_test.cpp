// Laws of every body's support function, along and close to fifteen axes. Oracle: central
// differences of the support value and of the support point.
//
// The axes are those of two boxes: three of the body's frame, three of a rotated frame, and the
// nine cross products.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/curved/body_view.hpp"
#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::made;

std::vector<ConvexBody> every_body() {
  return {made(ellipsoid({1, 2, 5})),
          made(ellipsoid({1, 1, 0.05})),
          made(ellipsoid({0.7, 0.7, 0.7})),
          made(cylinder(0.5, 2.0)),
          made(cone(1.0, 0.5)),
          made(truncated_cone(0.2, 1.0, 0.7)),
          made(box({1, 0.5, 0.25}))};
}

std::vector<Vec3> fifteen_axes() {
  Random random(7);
  const Mat3 r = rotation_matrix(random.rotation());
  std::vector<Vec3> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(Vec3::Unit(i));
    axes.push_back(r.col(i));
    for (int k = 0; k < 3; ++k) axes.push_back(Vec3::Unit(i).cross(r.col(k)).normalized());
  }
  return axes;
}

// Visits each axis and its opposite, tilted by epsilon to either side along two tangents.
template <class Claim>
void along_all_axes(double epsilon, const Claim& claim) {
  for (const Vec3& axis : fifteen_axes()) {
    const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
    for (const double sign : {1.0, -1.0}) {
      for (const double tilt : {epsilon, -epsilon}) {
        claim(Vec3((sign * axis + tilt * x).normalized()));
        claim(Vec3((sign * axis + tilt * y).normalized()));
      }
    }
  }
}

double support_value(const BodyView& view, std::int32_t part, const Vec3& m) {
  return m.dot(support_point(view, part, m));
}

Tangents tangents_of(const Vec3& m) {
  const Vec3 x = m.unitOrthogonal();
  return {x, m.cross(x)};
}

constexpr double kEpsilons[] = {1e-1, 1e-3};

TEST(SupportLaws, TheSupportPointIsTheGradientOfTheSupportValue) {
  for (const ConvexBody& body : every_body()) {
    const BodyView view{&body, body.bounding_radius};
    for (const double epsilon : kEpsilons) {
      along_all_axes(epsilon, [&](const Vec3& m) {
        const double step = 1e-4 * epsilon;
        for (std::int32_t part = 0; part < parts_of(body); ++part) {
          const Vec3 point = support_point(view, part, m);
          for (int i = 0; i < 3; ++i) {
            const Vec3 by = step * Vec3::Unit(i);
            const double slope =
                (support_value(view, part, m + by) - support_value(view, part, m - by)) /
                (2.0 * step);
            EXPECT_NEAR(slope, point[i], 1e-7 * body.bounding_radius);
          }
        }
      });
    }
  }
}

TEST(SupportLaws, TheSupportHessianIsTheDerivativeOfTheSupportPoint) {
  for (const ConvexBody& body : every_body()) {
    const BodyView view{&body, body.bounding_radius};
    for (const double epsilon : kEpsilons) {
      along_all_axes(epsilon, [&](const Vec3& m) {
        const double step = 1e-4 * epsilon;
        const Tangents t = tangents_of(m);
        for (std::int32_t part = 0; part < parts_of(body); ++part) {
          const PlaneMatrix hessian = support_hessian(view, part, m, t);
          const auto slope = [&](const Vec3& of, const Vec3& along) {
            const Vec3 by = step * along;
            return of.dot(support_point(view, part, m + by) - support_point(view, part, m - by)) /
                   (2.0 * step);
          };
          const double tolerance = 1e-6 * (hessian.xx + hessian.yy + body.bounding_radius);
          EXPECT_NEAR(slope(t.x, t.x), hessian.xx, tolerance);
          EXPECT_NEAR(slope(t.x, t.y), hessian.xy, tolerance);
          EXPECT_NEAR(slope(t.y, t.x), hessian.xy, tolerance);
          EXPECT_NEAR(slope(t.y, t.y), hessian.yy, tolerance);
        }
      });
    }
  }
}

TEST(SupportLaws, TheSupportPartHasTheSupportValueOfTheWholeBody) {
  for (const ConvexBody& body : every_body()) {
    const BodyView view{&body, body.bounding_radius};
    for (const double epsilon : {0.0, 1e-1, 1e-3, 1e-9, 1e-15}) {
      along_all_axes(epsilon, [&](const Vec3& m) {
        const double value = support_value(view, support_part(view, m), m);
        for (std::int32_t part = 0; part < parts_of(body); ++part) {
          EXPECT_LE(support_value(view, part, m), value + 1e-15 * body.bounding_radius);
        }
        if (!body.is_curved()) return;
        const double whole = visit(view, [&](const auto& shape) {
          if constexpr (requires { shape.support_value(m); }) return shape.support_value(m);
          return 0.0;
        });
        EXPECT_NEAR(value, whole, 1e-15 * body.bounding_radius);
      });
    }
  }
}

TEST(SupportLaws, PointsPulledInsideAreInsideAndPointsInsideStay) {
  Random random(8);
  for (const ConvexBody& body : every_body()) {
    if (!body.is_curved()) continue;
    const BodyView view{&body, body.bounding_radius};
    along_all_axes(1e-3, [&](const Vec3& m) {
      const Vec3 on_surface = support_point(view, support_part(view, m), m);
      const Vec3 pulled = pulled_inside(view, on_surface + 1e-9 * random.direction());
      EXPECT_LE((pulled - on_surface).norm(), 1e-8);
      along_all_axes(0.0, [&](const Vec3& n) {
        EXPECT_LE(n.dot(pulled),
                  support_value(view, support_part(view, n), n) + 1e-15 * body.bounding_radius);
      });
      const Vec3 inside = 0.5 * on_surface;
      EXPECT_LE((pulled_inside(view, inside) - inside).norm(), 1e-16);
    });
  }
}

TEST(SupportLaws, ThePointOfTheSupportSetIsASupportPointAndNoneIsFartherInThatDirection) {
  for (const ConvexBody& body : every_body()) {
    const BodyView view{&body, body.bounding_radius};
    for (const Vec3& m : fifteen_axes()) {
      for (const Vec3& towards : fifteen_axes()) {
        const PointOfPart found = visit(
            view, [&](const auto& shape) { return shape.support_set_point(m, towards, 1e-15); });
        const Vec3 any = support_point(view, support_part(view, m), m);
        EXPECT_NEAR(m.dot(found.point), m.dot(any), 1e-14);
        if (towards.cross(m).norm() > 1e-6) {
          EXPECT_GE(towards.dot(found.point), towards.dot(any) - 1e-14);
        }
      }
    }
  }
}

// h(m) = c.m + |D m|.
TEST(SupportLaws, TheRelativeSlopeBoundsTheGrowthOfTheRoundTerm) {
  Random random(83);
  for (const ConvexBody& body : every_body()) {
    if (!body.is_curved()) continue;
    const BodyView view{&body, body.bounding_radius};
    const bool is_ellipsoid = !has_caps(body);
    const Vec3 d = is_ellipsoid ? body.curved.semi_axes : Vec3(1.0, 1.0, 0.0);
    double greatest = 0.0;
    for (int i = 0; i < 200; ++i) {
      const Vec3 m = random.direction(), t = m.cross(random.direction()).normalized();
      const double slope = d.cwiseProduct(t).norm() / d.cwiseProduct(m).norm();
      EXPECT_LE(slope, relative_slope(view, m) * (1.0 + 1e-14));
      greatest = std::max(greatest, slope / relative_slope(view, m));
    }
    EXPECT_GT(greatest, 0.95);
  }
}

}  // namespace
}  // namespace clearance
