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
constexpr double kStrictly = 1.0 + 0x1p-10;  // curvature above d, so that rounding does not matter
constexpr double kSteepest = 2.0;            // the largest tau that is tried
constexpr int kHalvings = 16;

struct LocalPair {
  Vec2 across;  // of the support point of A - B, along the tangents, m
  PlaneMatrix hessian_a, hessian_b;
  double slope_a = 0.0, slope_b = 0.0;
  double weight = 0.0;
};

double cross(const Vec2& u, const Vec2& v) noexcept { return u.x() * v.y() - u.y() * v.x(); }

class Cap {
 public:
  Cap(CurvedPair& pair, const Vec3& n, double depth, double tolerance) noexcept
      : pair_(pair), n_(n), depth_(depth), tolerance_(tolerance) {
    tangents_.x = n.unitOrthogonal();
    tangents_.y = n.cross(tangents_.x);
    in_b_ = {pair.direction_to_b(tangents_.x), pair.direction_to_b(tangents_.y)};
  }

  DepthCap run(const ActiveParts& active) noexcept {
    for (std::size_t i = 0; i < active.count; ++i) add(active.pairs[i]);
    found_.supports += static_cast<int>(active.count);
    if (set_weights()) found_.angle = by_curvature();
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
    const double mean = 0.5 * (k.xx + k.yy);
    const double least = mean - std::hypot(0.5 * (k.xx - k.yy), k.xy);
    if (count_ != 2) return least;
    const Vec2 &p = local_[0].across, &q = local_[1].across;
    const double s = depth_ * tau / std::min(p.norm(), q.norm());
    if (!(s < 1.0 && rest_.norm() <= 0.25 * depth_ * tau)) return least;
    const Vec2 u = (p - q).normalized(), v(-u.y(), u.x());
    const Vec2 kv = k * v;
    return std::max(least, (1.0 - s * s) * v.dot(kv) - 2.0 * s * std::abs(u.dot(kv)));
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

  // The ring's points have d - tolerance along n. If the origin is inside their polygon, farther
  // than r from its sides, then one of them gives tau r for any tangent.
  double by_ring() noexcept {
    std::array<Vec2, kRing> across;
    for (std::size_t i = 0; i < kRing; ++i) {
      const Vec3 t = i % 2 == 0 ? tangents_.x : tangents_.y;
      const SupportPair at = pair_.support(n_ + (i < 2 ? kTilt : -kTilt) * t);
      found_.ring[i] = -at.points.gap();
      across[i] = {found_.ring[i].dot(tangents_.x), found_.ring[i].dot(tangents_.y)};
      if (!(n_.dot(found_.ring[i]) >= depth_ - 0.5 * tolerance_)) across[i].setZero();
    }
    found_.supports += static_cast<int>(kRing);
    double least = kInfinity;
    for (std::size_t i = 0; i < kRing; ++i) {
      const Vec2 &p = across[i], &q = across[(i + 1) % kRing];
      if (p != q) least = std::min(least, cross(p, q) / (q - p).norm());
    }
    return least > 0.0 && least < kInfinity ? 2.0 * std::atan(least / depth_) : 0.0;
  }

  CurvedPair& pair_;
  Vec3 n_;
  double depth_, tolerance_;
  Tangents tangents_{}, in_b_{};
  std::array<LocalPair, 3> local_{};
  std::size_t count_ = 0;
  Vec2 rest_ = Vec2::Zero();
  DepthCap found_;
};

}  // namespace

DepthCap depth_cap(CurvedPair& pair, const Vec3& n, double depth, double tolerance,
                   const ActiveParts& active) noexcept {
  return Cap(pair, n, depth, tolerance).run(active);
}

}  // namespace clearance
