#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/curved/depth_cap.hpp"
#include "core/curved/thorough.hpp"

namespace clearance {
namespace {

// A cover, its tolerance as a part of the pair's size, and the limit on its support points. Nearly
// symmetric pairs would need far more than the fine cover has: the coarse one then says what is
// known of the depth, in a tenth of a millisecond.
struct Cover {
  double tolerance;
  int supports;
};
constexpr Cover kFine{0x1p-49, 3000}, kCoarse{1e-3, 1000};
constexpr double kNearAxisSquare = 0x1p-32;   // of the sine
constexpr double kNearlySymmetric = 0x1p-20;  // of the pair's size
constexpr double kPointsOff = 0x1p-40;  // of the pair's size, along the direction of the depth
constexpr int kTurns = 8;               // of points of two faces towards each other
constexpr std::size_t kDeepest = 400;
// The ring of directions on the cap, and a cap from which the rest is one fan of triangles, rad.
constexpr double kRingAngle = 1.4, kLargeCap = 2.0;
constexpr double kLarger = 1.0 + 0x1p-20;  // the cap than the ring on it

// A vertex of a triangle: a direction, the support value of A - B along it, and the support point.
// The rolling balls are subtracted from both, since bodies that are less round need fewer
// triangles.
struct Corner {
  Vec3 normal;
  double value;
  Vec3 point;
};

struct Triangle {
  std::array<Corner, 3> corners;
};

// A lower bound of the support value of A - B over all directions of a triangle. For any mean p of
// the support points at its vertices, the support value along n is at least n.p. If n.p is positive
// at all vertices, its minimum over the triangle is at a vertex. The best p is the first player's
// strategy in the matrix game n_i.p_k (von Neumann 1928), found by trying all subsets of the
// points.
class TriangleBound {
 public:
  explicit TriangleBound(const Triangle& t) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) m_[i][k] = t.corners[i].normal.dot(t.corners[k].point);
    }
  }
  // Is the bound at least this? `target` > 0, m.
  [[nodiscard]] bool reaches(double target) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::min({m_[0][k], m_[1][k], m_[2][k]}) >= target) return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      // No mean is greater than the greatest one at a vertex.
      if (std::max({m_[i][0], m_[i][1], m_[i][2]}) < target) return false;
    }
    three();
    for (std::size_t k = 0; k < 3 && best_ < target; ++k) two(k, (k + 1) % 3);
    return best_ >= target;
  }

 private:
  void play(const Vec3& weights) noexcept {
    double least = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) least = std::min(least, row(i).dot(weights));
    best_ = std::max(best_, least);
  }
  [[nodiscard]] Vec3 row(std::size_t i) const noexcept { return {m_[i][0], m_[i][1], m_[i][2]}; }

  // Means of two points for which n.p is equal at two vertices.
  void two(std::size_t k, std::size_t l) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double at_k = m_[i][k] - m_[j][k], at_l = m_[i][l] - m_[j][l];
      const double part = at_k / (at_k - at_l);
      if (!(part > 0.0 && part < 1.0)) continue;
      Vec3 weights = Vec3::Zero();
      weights[static_cast<int>(k)] = 1.0 - part;
      weights[static_cast<int>(l)] = part;
      play(weights);
    }
  }
  // The mean for which n.p is equal at all vertices.
  void three() noexcept {
    const Vec3 w = (row(0) - row(1)).cross(row(1) - row(2));
    const Vec3 weights = w / w.sum();
    if (weights.minCoeff() > 0.0) play(weights);
  }

  std::array<std::array<double, 3>, 3> m_{};
  double best_ = -kInfinity;
};

double rolling_ball(const BodyView& view) noexcept {
  return visit(view, [](const auto& body) { return body.rolling_ball(); });
}

class DepthSearch {
 public:
  DepthSearch(CurvedPair& pair, const ActiveParts& active) noexcept
      : pair_(pair), active_(active), ball_(rolling_ball(pair.a) + rolling_ball(pair.b)) {
    const Ball a = inscribed_ball(pair.a), b = inscribed_ball(pair.b);
    inscribed_ = {a.centre - pair.point_to_a(b.centre), a.radius + b.radius};
  }

  DepthBounds run() noexcept {
    if (active_.count == 0) descend(pair_.bounds.normal);
    found_.lower = least_symmetric_depth(pair_, kNearlySymmetric * pair_.size);
    if (pass(kFine)) return found_;
    found_.lower = std::max(found_.lower, least_symmetric_depth(pair_, kInfinity));
    (void)pass(kCoarse);
    return found_;
  }

 private:
  [[nodiscard]] double depth() const noexcept { return -pair_.bounds.lower; }

  void descend(const Vec3& n) noexcept {
    active_ = {};
    found_.supports += search_direction(pair_, n, active_);
  }

  Corner corner(const Vec3& n) noexcept {
    const SupportPair at = pair_.support(n);
    ++found_.supports;
    return {n, -at.value - ball_left_out_, -at.points.gap() - ball_left_out_ * n};
  }

  // True: the depth is certified to be at least the best known, less the tolerance.
  bool pass(const Cover& by) noexcept {
    const double tolerance = by.tolerance * pair_.size;
    const int limit = found_.supports + by.supports;
    for (int start = 0; start < 32; ++start) {
      if (!(depth() > 0.0)) return false;
      if (depth() - found_.lower <= tolerance) return true;
      const PassEnd end = cover(tolerance, limit);
      if (end == PassEnd::kCovered) {
        found_.lower = std::max(found_.lower, target_);
        return true;
      }
      if (end == PassEnd::kLimit) return false;
      descend(pair_.bounds.normal);
    }
    return false;
  }

  enum class PassEnd { kCovered, kLimit, kDeeper };

  PassEnd cover(double tolerance, int limit) noexcept {
    const DepthCap cap = best_cap(tolerance);
    axis_ = pair_.bounds.normal;
    const double best = depth();
    ball_left_out_ = std::min(ball_, 0.5 * best);
    target_ = best - tolerance;
    found_.lower = std::max(found_.lower, cap.lower);
    if (cap.lower >= target_) return PassEnd::kCovered;
    known_count_ = 0;
    for (const Vec3& p : cap.ring) known_[known_count_++] = p - ball_left_out_ * axis_;
    count_ = 0;
    begin(cap.angle);
    while (count_ > 0) {
      if (depth() < best - 0.5 * tolerance) return PassEnd::kDeeper;
      const Triangle t = stack_[--count_];
      if (is_covered(t)) continue;
      if (found_.supports >= limit || count_ + 2 > stack_.size()) return PassEnd::kLimit;
      halve(t);
    }
    return PassEnd::kCovered;
  }

  // Four directions around n at an angle.
  static void ring_around(const Vec3& n, double angle, Vec3* into) noexcept {
    const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
    const double c = std::cos(angle), s = std::sin(angle);
    into[0] = c * n + s * x;
    into[1] = c * n + s * y;
    into[2] = c * n - s * x;
    into[3] = c * n - s * y;
  }

  DepthCap cap_here(double tolerance) noexcept {
    DepthCap cap = depth_cap(pair_, pair_.bounds.normal, depth(), tolerance, ball_, active_);
    found_.supports += cap.supports;
    return cap;
  }

  // Where a whole cap of a truncated cone touches, the search ends within rounding of its axis.
  // Along the axis itself, all of the cap is the support set.
  DepthCap best_cap(double tolerance) noexcept {
    DepthCap cap = cap_here(tolerance);
    if (cap.angle > 0.0 || depth() - cap.lower <= tolerance) return cap;
    const CurvedBounds before = pair_.bounds;
    to_axes();
    if (pair_.bounds.normal == before.normal) return cap;
    DepthCap there = cap_here(tolerance);
    if (there.angle > 0.0) return there;
    pair_.bounds = before;
    return cap;
  }
  void to_axes() noexcept {
    const auto snap = [&](const BodyView& view, const Vec3& m, auto&& to_a) {
      if (!has_caps(*view.body) || !(m.head<2>().squaredNorm() < kNearAxisSquare)) return;
      pair_.prefer(to_a(Vec3(0.0, 0.0, std::copysign(1.0, m.z()))));
      ++found_.supports;
    };
    const Vec3 n = pair_.bounds.normal;
    snap(pair_.a, n, [](const Vec3& v) { return v; });
    snap(pair_.b, -pair_.direction_to_b(n),
         [&](const Vec3& v) { return Vec3(-pair_.direction_to_a(v).normalized()); });
  }

  // Covers all directions outside the cap. A large cap leaves four triangles around the opposite of
  // the best direction. Otherwise there is a ring of four directions on the cap, and another one.
  void begin(double cap) noexcept {
    std::array<Vec3, 9> n;
    n[8] = -axis_;
    const bool large = cap > kLargeCap;
    // The sides of the four triangles are nearest to -n in their middles.
    const double rest = std::numbers::pi - cap / kLarger;
    ring_around(n[8], large ? std::atan(std::sqrt(2.0) * std::tan(rest)) : 0.5 * std::numbers::pi,
                n.data());
    const double angle = std::min(cap / kLarger, kRingAngle);
    ring_around(-axis_, std::numbers::pi - angle, n.data() + 4);
    least_cosine_ = large || !(angle > 0.0) ? 2.0 : std::cos(kLarger * angle);
    std::array<Corner, 9> corners;
    std::array<bool, 9> evaluated{};
    const auto push = [&](const std::array<std::size_t, 3>& at) {
      if (is_covered({n[at[0]], n[at[1]], n[at[2]]})) return;
      for (const std::size_t i : at) {
        if (evaluated[i]) continue;
        evaluated[i] = true;
        corners[i] = corner(n[i]);
        known_[known_count_++] = corners[i].point;
      }
      stack_[count_++] = {{corners[at[0]], corners[at[1]], corners[at[2]]}};
    };
    corners[8] = corner(n[8]);
    evaluated[8] = true;
    known_[known_count_++] = corners[8].point;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = (i + 1) % 4;
      push({i, k, 8});
      if (large) continue;
      // Without a cap, the ring is the best direction itself.
      push({i, k, angle > 0.0 ? i + 4 : 4});
      if (angle > 0.0) push({k, i + 4, k + 4});
    }
  }

  [[nodiscard]] bool is_covered(const Triangle& t) const noexcept {
    const auto& [a, b, c] = t.corners;
    return is_covered({a.normal, b.normal, c.normal}) ||
           (target_ > ball_left_out_ && TriangleBound(t).reaches(target_ - ball_left_out_));
  }
  // Without the support points of the triangle.
  [[nodiscard]] bool is_covered(const std::array<Vec3, 3>& n) const noexcept {
    const auto least = [&](const Vec3& v) {
      return std::min({n[0].dot(v), n[1].dot(v), n[2].dot(v)});
    };
    if (least(axis_) >= least_cosine_) return true;
    for (std::size_t i = 0; i < known_count_; ++i) {
      if (least(known_[i]) >= target_ - ball_left_out_) return true;
    }
    // A ball inside the inscribed one, of at most the depth, moved towards the triangle's middle.
    const double radius = std::min(inscribed_.radius, target_);
    const Vec3 middle = Vec3(n[0] + n[1] + n[2]).normalized();
    return least(inscribed_.centre + (inscribed_.radius - radius) * middle) >= target_ - radius;
  }

  // Halves the longest side. The half whose vertex has the lesser value comes first.
  void halve(const Triangle& t) noexcept {
    std::size_t from = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (t.corners[(i + 1) % 3].normal - t.corners[i].normal).squaredNorm();
      if (side > longest) {
        longest = side;
        from = i;
      }
    }
    const Corner &a = t.corners[from], &b = t.corners[(from + 1) % 3],
                 &c = t.corners[(from + 2) % 3];
    const Corner middle = corner(Vec3(a.normal + b.normal).normalized());
    stack_[count_++] = {{a, middle, c}};
    stack_[count_++] = {{middle, b, c}};
    if (a.value < b.value) std::swap(stack_[count_ - 1], stack_[count_ - 2]);
  }

  CurvedPair& pair_;
  ActiveParts active_;
  double ball_, ball_left_out_ = 0.0;
  // One cover has these: the value that all directions have to have, the cap, and points of A - B
  // without the ball.
  Ball inscribed_;  // in A - B
  double target_ = 0.0, least_cosine_ = 2.0;
  Vec3 axis_ = Vec3::Zero();
  std::array<Vec3, kRing + 9> known_;
  std::size_t known_count_ = 0;
  DepthBounds found_;
  std::array<Triangle, kDeepest> stack_;
  std::size_t count_ = 0;
};

// The deepest points are those of a search that ended at the best direction. If another direction
// turned out to be better meanwhile, they belong to a former one: then a search from there finds
// them, or the support points are taken, which are as far from each other along it.
int find_deepest_points(CurvedPair& pair) noexcept {
  const auto fit = [&] {
    const double along = pair.bounds.normal.dot(pair.bounds.deepest.gap());
    return pair.bounds.has_deepest && std::abs(along - pair.bounds.lower) <= kPointsOff * pair.size;
  };
  if (fit()) return 0;
  ActiveParts active;
  const int supports = search_direction(pair, pair.bounds.normal, active);
  if (!fit()) pair.bounds.deepest = pair.support_along(pair.bounds.normal).points;
  return supports + 1;
}

// A point of the body that is near another one, in its frame. A body without facets has `present`.
Vec3 moved_inside(const BodyView& view, Vec3 point, const Vec3& present) noexcept {
  const ConvexBody& body = *view.body;
  if (body.is_curved()) return pulled_inside(view, point);
  if (!body.bounded() || body.facets.empty()) return present;
  for (const Facet& facet : body.facets)
    point -= std::max(0.0, facet.normal.dot(point) - facet.offset) * facet.normal;
  const double rounding = kPointsOff * view.bounding_radius;
  const bool is_inside = std::ranges::all_of(body.facets, [&](const Facet& facet) {
    return facet.normal.dot(point) <= facet.offset + rounding;
  });
  return is_inside ? point : present;
}

// Both points are anywhere in their faces. They meet when B is moved if each can be taken to where
// the other one is, in turn. Points of the bodies that are apart by the depth along the direction
// are support points. A round body leaves its face if it is the first to be moved.
void bring_together(CurvedPair& pair) noexcept {
  const Vec3 apart = pair.bounds.lower * pair.bounds.normal;
  const auto meet = [&](const PointPair& points) {
    const Vec3 off = points.gap() - apart;
    return std::abs(pair.bounds.normal.dot(off)) <= pair.error() &&
           off.norm() <= kPointsOff * pair.size;
  };
  for (const bool b_is_first : {true, false}) {
    PointPair points = pair.bounds.deepest;
    bool moves_b = b_is_first;
    for (int turn = 0; turn < kTurns; ++turn, moves_b = !moves_b) {
      if (meet(points)) {
        pair.bounds.deepest = points;
        return;
      }
      if (moves_b) {
        points.b_B = moved_inside(pair.b, pair.point_to_b(points.a + apart), points.b_B);
        points.b = pair.point_to_a(points.b_B);
      } else {
        points.a = moved_inside(pair.a, points.b - apart, points.a);
      }
    }
  }
}

}  // namespace

DepthBounds bound_depth(CurvedPair& pair, const ActiveParts& active) noexcept {
  assert(is_unit_or_unknown(pair.bounds.normal));
  DepthBounds found = DepthSearch(pair, active).run();
  if (found.lower > 0.0) {
    found.supports += find_deepest_points(pair);
    bring_together(pair);
  }
  assert(is_unit_or_unknown(pair.bounds.normal) &&
         !(found.lower > -pair.bounds.lower + 2.0 * pair.error()));
  return found;
}

}  // namespace clearance
