#include "core/curved/depth_cap.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Let h be the support function of A - B, and t a unit tangent at n. Then h(cos n + sin t) is
// cos h(n + tau t) with tau = tan of the angle. It is at least the depth d if
// h(n + tau t) >= d + d tau^2 / 2, since sqrt(1 + tau^2) <= 1 + tau^2 / 2. Two bounds of
// h(n + tau t) are used:
// - A point d n + q of A - B gives d + tau q.t.
// - For a part with h = n.c + |D n|, the rest of |D (n + tau t)| above its tangent is
//   tau^2 K(t, t) |D n| / (|D (n + tau t)| + the tangent's value), with K its support Hessian. The
//   denominator is at most 2 (|D n| + tau max |D t|). So h grows at least by
//   tau^2 K(t, t) / 2 / (1 + tau s) above the tangent, with s = max |D t| / |D n|.
// A mean of pairs of parts by their weights has the mean of these bounds.
constexpr double kStrictly = 1.0 + 0x1p-20;  // curvature above d, so that rounding does not matter
constexpr double kSteeper =
    1.0 + 0x1p-7;                  // slope, so that a mean point that is off does not matter
constexpr double kSteepest = 4.0;  // the largest tau that is tried
constexpr int kHalvings = 16;
constexpr int kSides = 12;      // are replaced at most
constexpr double kWide = 1.55;  // inradius over depth of a cap of 2 rad

struct LocalPair {
  Vec2 across;  // of the support point of A - B, along the tangents, m
  PlaneMatrix hessian_a, hessian_b;
  double slope_a = 0.0, slope_b = 0.0;
  double value = 0.0;  // along n, m
  double weight = 0.0;
};

double cross(const Vec2& u, const Vec2& v) noexcept { return u.x() * v.y() - u.y() * v.x(); }

class Cap {
 public:
  Cap(const CurvedPair& pair, const Vec3& n, double depth, double tolerance) noexcept
      : pair_(pair), n_(n), depth_(depth), tolerance_(tolerance) {
    tangents_.x = n.unitOrthogonal();
    tangents_.y = n.cross(tangents_.x);
    in_b_ = {pair.direction_to_b(tangents_.x), pair.direction_to_b(tangents_.y)};
  }

  DepthCap run(double ball, const ActiveParts& active) noexcept {
    for (std::size_t i = 0; i < active.count; ++i) add(active.pairs[i]);
    found_.supports += static_cast<int>(active.count);
    if (set_weights()) {
      // The rolling ball touches the mean point. The largest ball around the origin inside it.
      found_.lower = ball - std::hypot(ball - value_, rest_.norm());
      if (depth_ - found_.lower <= tolerance_) return found_;
      found_.angle = by_curvature();
    }
    if (count_ < 2 && found_.angle > 0.5) {
      found_.ring.fill(n_ * depth_);
      return found_;
    }
    found_.angle = std::max(found_.angle, by_ring());
    return found_;
  }

 private:
  void add(const PartPair& parts) noexcept {
    const SupportPair at = pair_.support_of(parts, n_);
    if (!(-at.value >= depth_ - 0.25 * tolerance_)) return;
    const Vec3 p = -at.points.gap(), m = -pair_.direction_to_b(n_);
    LocalPair& f = local_[count_++];
    f.value = -at.value;
    f.across = {p.dot(tangents_.x), p.dot(tangents_.y)};
    f.hessian_a = support_hessian(pair_.a, parts.a, n_, tangents_);
    f.hessian_b = support_hessian(pair_.b, parts.b, m, in_b_);
    f.slope_a = relative_slope(pair_.a, n_);
    f.slope_b = relative_slope(pair_.b, m);
  }

  // The weights whose mean point is nearest to d n. False: it is not near enough.
  bool set_weights() noexcept {
    if (count_ == 0) return false;
    local_[0].weight = 1.0;
    if (count_ == 2) {
      const Vec2 u = local_[0].across - local_[1].across;
      const double part = local_[0].across.dot(u) / u.squaredNorm();
      if (!(part > 0.0 && part < 1.0)) return false;
      local_[0].weight = 1.0 - part;
      local_[1].weight = part;
    } else if (count_ == 3) {
      const Vec2 &p = local_[0].across, &q = local_[1].across, &r = local_[2].across;
      const double of_p = cross(q, r), of_q = cross(r, p), of_r = cross(p, q);
      const double sum = of_p + of_q + of_r;
      local_[0].weight = of_p / sum;
      local_[1].weight = of_q / sum;
      local_[2].weight = of_r / sum;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      if (!(local_[i].weight >= 0.0)) return false;
      rest_ += local_[i].weight * local_[i].across;
      value_ += local_[i].weight * local_[i].value;
    }
    return true;
  }

  [[nodiscard]] PlaneMatrix mean_hessian(double tau) const noexcept {
    PlaneMatrix k;
    for (std::size_t i = 0; i < count_; ++i) {
      const LocalPair& f = local_[i];
      k.add(f.weight / (1.0 + tau * f.slope_a), f.hessian_a);
      k.add(f.weight / (1.0 + tau * f.slope_b), f.hessian_b);
    }
    return k;
  }

  // Two points across n on both sides of it bound h in all directions but those within `s` (a
  // sine) of the normal of their line. There the curvature has to. One pair has only curvature.
  [[nodiscard]] double least_curvature(const PlaneMatrix& k, double tau) const noexcept {
    const double mean = 0.5 * (k.xx + k.yy), half = 0.5 * (k.xx - k.yy);
    const double least = mean - std::hypot(half, k.xy);
    if (count_ != 2) return least;
    const Vec2 &p = local_[0].across, &q = local_[1].across;
    const double s = 0.5 * kSteeper * depth_ * tau / std::min(p.norm(), q.norm());
    if (!(s < 0.7 && rest_.norm() <= 0x1p-9 * depth_ * tau)) return least;
    const Vec2 u = (p - q).normalized(), v(-u.y(), u.x());
    const double c = std::sqrt(1.0 - s * s);
    const auto along = [&](const Vec2& t) { return t.dot(k * t); };
    const double at_ends = std::min(along(c * v + s * u), along(c * v - s * u));
    // The form has its minimum within the arc if it descends into it at both ends.
    const double bend = 2.0 * s * c * (along(u) - along(v)),
                 slope = (c - s) * (c + s) * 2.0 * u.dot(k * v);
    return bend <= std::abs(slope) ? at_ends : least;
  }

  [[nodiscard]] double by_curvature() const noexcept {
    double tau = kSteepest;
    for (int i = 0; i < kHalvings; ++i, tau *= 0.5) {
      const double excess = least_curvature(mean_hessian(tau), tau) - kStrictly * depth_;
      // Across n, a mean point that is off by r costs at most r^2 / (2 excess).
      if (excess > 0.0 && rest_.squaredNorm() <= tolerance_ * excess) return std::atan(tau);
    }
    return 0.0;
  }

  // Points with d - tolerance along n. If the origin is inside their polygon, farther than r from
  // its sides, then one of them gives tau r for any tangent. The ring's points come first. Then the
  // side that is nearest to the origin is replaced by two, as long as there is a point beyond it.
  double by_ring() noexcept {
    // Along no edge of a box whose edges are along the tangents.
    const Vec2 x(0.8, 0.6), y(-0.6, 0.8);
    const std::array<Vec2, kRing> around{x, y, -x, -y};
    for (std::size_t i = 0; i < kRing; ++i) {
      const Vec2 q = evaluate(around[i], found_.ring[i]);
      if (is_new(q)) insert(corner_count_, q);
    }
    if (corner_count_ == 0) return 0.0;
    NearestSide side = nearest_side();
    for (int round = 0; round < kSides; ++round) {
      if (side.distance > kWide * depth_ || corner_count_ == corners_.size()) break;
      Vec3 point;
      const Vec2 q = evaluate(side.outwards, point);
      if (!is_new(q) || !(q.dot(side.outwards) > side.distance)) break;
      insert(side.index + 1, q);
      side = nearest_side();
    }
    // A single point and two points have the origin beyond a side.
    return side.distance > 0.0 ? 2.0 * std::atan(side.distance / depth_) : 0.0;
  }

  // The support point for n tilted towards t, across n. Not finite: it is too low.
  Vec2 evaluate(const Vec2& t, Vec3& point) noexcept {
    const Vec3 towards = t.x() * tangents_.x + t.y() * tangents_.y;
    point = -pair_.support_along(n_ + kTilt * towards).points.gap();
    ++found_.supports;
    if (!(n_.dot(point) >= depth_ - 0.5 * tolerance_)) return Vec2::Constant(kInfinity);
    return {point.dot(tangents_.x), point.dot(tangents_.y)};
  }
  // Tilted rims have several points next to each other, whose line has no direction. One of them is
  // enough.
  [[nodiscard]] bool is_new(const Vec2& q) const noexcept {
    if (!q.allFinite()) return false;
    for (std::size_t i = 0; i < corner_count_; ++i) {
      const Vec2& p = corners_[i];
      if (!((q - p).squaredNorm() > 0x1p-32 * (q.squaredNorm() + p.squaredNorm()))) return false;
    }
    return true;
  }
  void insert(std::size_t at, const Vec2& q) noexcept {
    for (std::size_t i = corner_count_++; i > at; --i) corners_[i] = corners_[i - 1];
    corners_[at] = q;
  }

  struct NearestSide {
    std::size_t index = 0;
    double distance = kInfinity;  // m; negative: the origin is beyond it
    Vec2 outwards = Vec2::Zero();
  };
  // If every side has the origin on its left, the polygon goes around it, whatever its order is.
  [[nodiscard]] NearestSide nearest_side() const noexcept {
    NearestSide nearest;
    if (corner_count_ == 1) return {0, -kInfinity, -corners_[0].normalized()};
    for (std::size_t i = 0; i < corner_count_; ++i) {
      const Vec2 &p = corners_[i], &q = corners_[(i + 1) % corner_count_];
      const Vec2 side = (q - p).normalized();
      const double distance = cross(p, side);
      if (distance < nearest.distance) nearest = {i, distance, Vec2(side.y(), -side.x())};
    }
    return nearest;
  }

  const CurvedPair& pair_;
  Vec3 n_;
  double depth_, tolerance_;
  Tangents tangents_{}, in_b_{};
  std::array<LocalPair, 3> local_{};
  std::size_t count_ = 0;
  // The mean point, across n and along it.
  Vec2 rest_ = Vec2::Zero();
  double value_ = 0.0;
  // The polygon of the contact, counterclockwise.
  std::array<Vec2, kRing + kSides> corners_;
  std::size_t corner_count_ = 0;
  DepthCap found_;
};

}  // namespace

DepthCap depth_cap(const CurvedPair& pair, const Vec3& n, double depth, double tolerance,
                   double ball, const ActiveParts& active) noexcept {
  return Cap(pair, n, depth, tolerance).run(ball, active);
}

}  // namespace clearance
