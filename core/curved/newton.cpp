#include "core/curved/newton.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/direction_programme.hpp"
#include "core/curved/piece-inl.hpp"

namespace clearance {
namespace {

constexpr int kSteps = 6;
// The witness points are along the direction to this, or to rounding.
constexpr double kAlong = 0x1p-34;

class Newton {
 public:
  Newton(CurvedPair& pair, const ActivePieces& active, Vec3& n) noexcept
      : pair_(pair), active_(active), n_(n), tolerance_(pair.gap_tolerance()) {
    weights_.fill(1.0 / static_cast<double>(active.count));
  }

  NewtonEnd run() noexcept {
    double before = -kInfinity;
    for (end_.supports = 1; end_.supports <= kSteps; ++end_.supports) {
      if (!look()) return end_;
      if (active_.count > 1 && !solve()) return end_;
      if (is_close()) {
        end_.tight = certify();
        return end_;
      }
      // Steps that lead nowhere are left to the search, which shortens them.
      if (!(least_ > before - tolerance_)) return end_;
      before = least_;
      if (active_.count == 1) step_of_one();
      n_ = (n_ + step_.x() * tangents_.x + step_.y() * tangents_.y).normalized();
    }
    return end_;
  }

 private:
  [[nodiscard]] static bool is_cone(const PieceSource& source) noexcept {
    return source.body->curved.kind == CurvedShape::Kind::kTruncatedCone;
  }
  [[nodiscard]] static double turn_of_rim(const FacedBody& faced) noexcept {
    if (!is_cone(faced.source)) return 0.0;
    const auto& [low, high] = faced.source.body->curved.discs;
    return std::max(low.radius, high.radius) / faced.azimuth.across;
  }

  // Tangents along the rim that turns fastest, so that its radius stays out of what lies across.
  void set_tangents(const FacedBody& a, const FacedBody& b) noexcept {
    const double turn_a = turn_of_rim(a), turn_b = turn_of_rim(b);
    if (turn_a > 0.0 || turn_b > 0.0) {
      const Vec2& to = turn_a >= turn_b ? a.azimuth.to : b.azimuth.to;
      const Vec3 along(-to.y(), to.x(), 0.0);
      tangents_.x = turn_a >= turn_b ? along : pair_.direction_to_a(along);
    } else {
      // The axis that n is farthest from is far enough off.
      const bool x = std::abs(n_.x()) < 0.6;
      const Vec3 along = x ? Vec3(0.0, n_.z(), -n_.y()) : Vec3(-n_.z(), 0.0, n_.x());
      tangents_.x = along / along.norm();
    }
    tangents_.y = n_.cross(tangents_.x);
    tangents_in_b_ = {pair_.direction_to_b(tangents_.x), pair_.direction_to_b(tangents_.y)};
  }

  // What there is to know at n_. False: it is an axis, or the bodies are not apart along it.
  bool look() noexcept {
    const FacedBody a = faced(pair_.a, n_), b = faced(pair_.b, -pair_.direction_to_b(n_));
    constexpr double kNearAxis = 0x1p-40;
    if ((is_cone(pair_.a) && a.azimuth.across < kNearAxis) ||
        (is_cone(pair_.b) && b.azimuth.across < kNearAxis)) {
      return false;
    }
    least_ = kInfinity;
    for (std::size_t i = 0; i < active_.count; ++i) {
      const PiecePair& pieces = active_.pieces[i];
      At& at = at_[i];
      at.points.a = support_point(a, pieces.a);
      at.points.own_b = support_point(b, pieces.b);
      at.points.b = pair_.point_to_a(at.points.own_b);
      at.difference = at.points.difference();
      at.apart = n_.dot(at.difference);
      least_ = std::min(least_, at.apart);
    }
    if (!(least_ > 0.0)) return false;
    if (active_.count == 1) {
      mean_ = at_[0].points;
      difference_ = at_[0].difference;
      if (is_close()) return true;
    }
    set_tangents(a, b);
    hessian_ = {least_, 0.0, least_};
    for (std::size_t i = 0; i < active_.count; ++i) {
      const PiecePair& pieces = active_.pieces[i];
      at_[i].slope = {at_[i].difference.dot(tangents_.x), at_[i].difference.dot(tangents_.y)};
      hessian_.add(weights_[i], radii_of_curvature(a, pieces.a, tangents_));
      hessian_.add(weights_[i], radii_of_curvature(b, pieces.b, tangents_in_b_));
    }
    return true;
  }

  void step_of_one() noexcept {
    const double determinant = hessian_.xx * hessian_.yy - hessian_.xy * hessian_.xy;
    const Vec2& slope = at_[0].slope;
    step_ = Vec2(hessian_.yy * slope.x() - hessian_.xy * slope.y(),
                 hessian_.xx * slope.y() - hessian_.xy * slope.x()) /
            determinant;
  }

  // The direction in which all functions are equal, and their weights there. False: one of them has
  // no weight, which means that fewer count.
  bool solve() noexcept {
    std::array<PlaneFunction, 3> functions{};
    for (std::size_t i = 0; i < active_.count; ++i) {
      functions[i] = {at_[i].apart - least_, at_[i].slope};
    }
    const MeetingPoint met = meeting_point(functions, active_.count, hessian_);
    step_ = met.step;
    weights_ = met.weights;
    mean_ = {};
    for (std::size_t i = 0; i < active_.count; ++i) {
      if (!(weights_[i] >= 0.0)) return false;
      mean_.a += weights_[i] * at_[i].points.a;
      mean_.own_b += weights_[i] * at_[i].points.own_b;
    }
    mean_.b = pair_.point_to_a(mean_.own_b);
    difference_ = mean_.difference();
    return true;
  }

  // Means of support points are points of the bodies: no pulling inside.
  [[nodiscard]] bool is_close() const noexcept {
    const double upper = difference_.norm(), along = n_.dot(difference_);
    if (!(upper - least_ <= tolerance_)) return false;
    const Vec3 across = difference_ - along * n_;
    const double limit = std::max(kAlong * upper, 4.0 * tolerance_);
    return across.squaredNorm() <= limit * limit;
  }

  // No other piece is nearer along n_.
  bool certify() noexcept {
    (void)pair_.support(n_);
    const double upper = difference_.norm();
    if (upper < pair_.bounds.upper) {
      pair_.bounds.upper = upper;
      pair_.bounds.points = mean_;
    }
    return pair_.is_tight();
  }

  struct At {
    PointPair points;
    Vec3 difference;
    double apart;
    Vec2 slope;
  };

  CurvedPair& pair_;
  const ActivePieces& active_;
  Vec3& n_;
  double tolerance_;
  std::array<At, 3> at_;
  std::array<double, 3> weights_{};
  double least_ = 0.0;  // how far the active pieces are apart along n_, m
  PointPair mean_;
  Vec3 difference_;
  Tangents tangents_, tangents_in_b_;
  PlaneMatrix hessian_;
  Vec2 step_;
  NewtonEnd end_;
};

}  // namespace

NewtonEnd refine_direction(CurvedPair& pair, const ActivePieces& active, Vec3& n) noexcept {
  if (active.count == 0) return {};
  return Newton(pair, active, n).run();
}

}  // namespace clearance
