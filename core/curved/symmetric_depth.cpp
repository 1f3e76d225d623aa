#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/curved/thorough.hpp"

namespace clearance {
namespace {

constexpr double kSectionTolerance = 0x1p-49;  // of the pair's size
constexpr int kMostArcs = 1000;

// ---- balls ----
double by_balls(const CurvedPair& pair) noexcept {
  const Ball a = inscribed_ball(pair.a), b = inscribed_ball(pair.b);
  return a.radius + b.radius - (pair.point_to_a(b.centre) - a.centre).norm();
}

// ---- ellipsoids with the same axes ----
// h_A + h_B is a sum of square roots of linear functions of the squares of n's coordinates. It is
// concave, so over the simplex of these squares it is least at a vertex.
double by_semi_axes(const CurvedPair& pair) noexcept {
  const auto semi_axes = [](const auto& body) { return body.semi_axes(); };
  const Vec3 *a = visit(pair.a, semi_axes), *b = visit(pair.b, semi_axes);
  if (a == nullptr || b == nullptr) return -kInfinity;
  double least = kInfinity, off = 0.0;
  for (int i = 0; i < 3; ++i) {
    int axis = 0;
    const double along = pair.rotation().row(i).cwiseAbs().maxCoeff(&axis);
    least = std::min(least, (*a)[i] + (*b)[axis]);
    for (int k = 0; k < 3; ++k) {
      const double entry = std::abs(pair.rotation()(i, k));
      off += k == axis ? 1.0 - along : entry;
    }
  }
  return least - pair.translation().norm() - off * pair.b.bounding_radius;
}

// ---- solids of revolution ----
constexpr int kAnyAxis = BodyDefaults::kAnyAxis, kNoAxis = BodyDefaults::kNoAxis;

// A body's section by a half-plane that the axis bounds.
struct Section {
  const BodyView& view;

  [[nodiscard]] int axis() const noexcept {
    return visit(view, [](const auto& body) { return body.axis_of_revolution(); });
  }
  [[nodiscard]] Vec2 support(const Vec2& n) const noexcept {
    return visit(view, [&](const auto& body) { return body.section_support(n); });
  }
};

// A direction (unit) and the support point of A - B along it.
struct SectionCorner {
  Vec2 normal, point;
};

// Arcs cover the directions from one end of the axis to the other. They are halved until the bound
// of each is within the tolerance of the best value. Let p be any mean of the support points at an
// arc's ends. The lesser of n.p at the ends is a bound, as for triangles of directions (depth.cpp).
class SectionSearch {
 public:
  SectionSearch(const Section& a, const Section& b, double apart, bool opposite) noexcept
      : a_(a), b_(b), apart_(apart), sign_(opposite ? -1.0 : 1.0) {}

  [[nodiscard]] double run(double tolerance) noexcept {
    std::array<SectionCorner, 3> start{corner({1.0, 0.0}), corner({0.0, 1.0}), corner({-1.0, 0.0})};
    stack_[0] = {start[0], start[1]};
    stack_[1] = {start[1], start[2]};
    std::size_t count = 2;
    double least = kInfinity;
    for (int arcs = 0; count > 0; ++arcs) {
      const Arc arc = stack_[--count];
      const double bound = value(arc);
      const bool tight = bound > 0.0 && bound >= best_ - tolerance;
      if (tight || arcs >= kMostArcs || count + 2 > stack_.size()) {
        least = std::min(least, bound);
        continue;
      }
      const SectionCorner middle = corner((arc.from.normal + arc.to.normal).normalized());
      stack_[count++] = {arc.from, middle};
      stack_[count++] = {middle, arc.to};
    }
    return least > 0.0 ? least : -kInfinity;
  }

 private:
  struct Arc {
    SectionCorner from, to;
  };

  SectionCorner corner(const Vec2& n) noexcept {
    const Vec2 on_a = a_.support(n), on_b = b_.support({-sign_ * n.x(), n.y()});
    const SectionCorner found{n, Vec2(on_a.x() - (apart_ + sign_ * on_b.x()), on_a.y() + on_b.y())};
    best_ = std::min(best_, n.dot(found.point));
    return found;
  }

  [[nodiscard]] static double value(const Arc& arc) noexcept {
    const auto& [from, to] = arc;
    const double a = from.normal.dot(from.point), b = from.normal.dot(to.point);
    const double c = to.normal.dot(from.point), d = to.normal.dot(to.point);
    double best = std::max(std::min(a, c), std::min(b, d));
    const double part = (a - c) / ((a - c) + (d - b));
    if (part > 0.0 && part < 1.0) {
      best = std::max(best, std::min(a + part * (b - a), c + part * (d - c)));
    }
    return best;
  }

  Section a_, b_;
  double apart_, sign_;
  double best_ = kInfinity;
  std::array<Arc, 64> stack_{};
};

double by_sections(const CurvedPair& pair, double move) noexcept {
  const Section section_a{pair.a}, section_b{pair.b};
  const int axis_of_a = section_a.axis(), axis_of_b = section_b.axis();
  if (axis_of_a == kNoAxis || axis_of_b == kNoAxis) return -kInfinity;
  // The axis in frame A. `tilt`: the sine of the angle to B's axis.
  Vec3 axis = pair.translation();
  if (axis_of_a != kAnyAxis) {
    axis = Vec3::Unit(axis_of_a);
  } else if (axis_of_b != kAnyAxis) {
    axis = pair.rotation().col(axis_of_b);
  } else if (axis.isZero(0.0)) {
    return -kInfinity;  // by_balls() answers spheres around one centre
  } else {
    axis = unit_along(axis);
  }
  double tilt = 0.0, cosine = 1.0;
  if (axis_of_b != kAnyAxis) {
    const Vec3 own = pair.rotation().col(axis_of_b);
    tilt = axis.cross(own).norm();
    cosine = axis.dot(own);
  }
  const double along = axis.dot(pair.translation());
  const double aside = (pair.translation() - along * axis).norm();
  // An angle is no more than 1.05 times its sine, up to 30 degrees.
  const double moved = aside + 1.05 * tilt * pair.b.bounding_radius;
  if (!(tilt < 0.5 && moved <= move)) return -kInfinity;
  SectionSearch search(section_a, section_b, along, cosine < 0.0);
  return search.run(kSectionTolerance * pair.size) - moved;
}

}  // namespace

Ball inscribed_ball(const BodyView& view) noexcept {
  return visit(view, [](const auto& body) { return body.inscribed_ball(); });
}

double least_symmetric_depth(const CurvedPair& pair, double move) noexcept {
  if (!pair.a.body->bounded() || !pair.b.body->bounded()) return -kInfinity;
  return std::max({by_balls(pair), by_semi_axes(pair), by_sections(pair, move)});
}

}  // namespace clearance
