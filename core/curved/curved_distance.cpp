#include "core/curved/curved_distance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/curved/thorough.hpp"
#include "core/curved/tracking.hpp"
#include "core/gjk/simplex.hpp"
#include "core/model/bad_pose.hpp"

namespace clearance {

namespace {

// ---- the first direction of the search ----
constexpr int kStartRounds = 24;

// A point of the Minkowski difference B - A.
struct StartPoint {
  SupportPair at;
  Vector<double> difference;

  [[nodiscard]] bool operator==(const StartPoint& other) const noexcept {
    return at.points == other.at.points;
  }
};
using StartSimplex = Simplex<StartPoint, double>;

// Each pair of parts once.
ActiveParts active_parts(const StartSimplex& simplex) noexcept {
  ActiveParts found;
  for (std::size_t i = 0; i < simplex.size() && found.count < found.pairs.size(); ++i) {
    const auto end = found.pairs.begin() + static_cast<std::ptrdiff_t>(found.count);
    const PartPair& parts = simplex.point(i).at.parts;
    if (std::find(found.pairs.begin(), end, parts) == end) found.pairs[found.count++] = parts;
  }
  return found;
}

// ---- half-spaces: one support point decides ----
// Counts as in kUlpsOfA, for the body, the plane's offset and the offset of the origins. The
// facet's normal is rounded, too, which adds 1 to each.
constexpr double kUlpsOfBody = 27, kUlpsOfPlane = 5, kUlpsOfOrigins = 13;

double half_space_error(double bounding_radius, double plane, const RelativePose& pose) noexcept {
  const double offset = pose.translation.norm();
  return kUlp * (kUlpsOfBody * bounding_radius + kUlpsOfPlane * plane + kUlpsOfOrigins * offset) +
         pose.translation_error + pose.rotation_error * kRoundedUp * (bounding_radius + offset) +
         kUnderflow;
}

// A or B is a half-space, and the other body is bounded.
DistanceResult half_space_distance(const ConvexBody& a, const ConvexBody& b,
                                   const RelativePose& a_from_b,
                                   CurvedTrackingState& state) noexcept {
  const bool plane_is_a = a.is_half_space();
  const ConvexBody &plane = plane_is_a ? a : b, &body = plane_is_a ? b : a;
  const Facet& facet = plane.facets.front();
  const Mat3& r = a_from_b.rotation;
  const BodyView view{&body, body.bounding_radius};
  const auto nearest = [&](const Vec3& m) { return support_point(view, support_part(view, m), m); };
  CurvedConclusion found;
  Vec3 to_body = facet.normal, point;  // frame A
  if (plane_is_a) {
    point = r * nearest(-(r.transpose() * facet.normal)) + a_from_b.translation;
    found.lower = facet.normal.dot(point) - facet.offset;
  } else {
    to_body = r * facet.normal;
    point = nearest(-to_body);
    found.lower = to_body.dot(point - a_from_b.translation) - facet.offset;
  }
  const Vec3 on_plane = point - found.lower * to_body;
  found.upper = found.lower;
  found.normal = plane_is_a ? to_body : Vec3(-to_body);
  found.point_on_a = plane_is_a ? on_plane : point;
  found.point_on_b = plane_is_a ? point : on_plane;
  found.error = half_space_error(body.bounding_radius, std::abs(facet.offset), a_from_b);
  found.size = body.bounding_radius + std::abs(facet.offset) + a_from_b.translation.norm();
  state.point_on_b_B = r.transpose() * (found.point_on_b - a_from_b.translation);
  return conclude(a, b, found);
}

// ---- the search and the depth ----
constexpr double kClearOverlap = 0x1p-30;  // of the pair's size

// `depth`: a lower bound of the depth of the bodies without radii, m; -infinity: none is known.
CurvedConclusion conclusion_of(const CurvedPair& pair, double depth) noexcept {
  const CurvedBounds& bounds = pair.bounds;
  CurvedConclusion found;
  found.lower = bounds.lower;
  found.upper = std::min(bounds.upper, -depth);
  found.error = pair.error();
  found.size = pair.size;
  found.normal = bounds.normal;
  const PointPair& points = depth > 0.0 ? bounds.deepest : bounds.points;
  found.point_on_a = points.a;
  found.point_on_b = points.b;
  return found;
}

// A search and its end.
class Search {
 public:
  Search(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
         CurvedTrackingState& state) noexcept
      : pair_(a, b, a_from_b), state_(state) {
    // The search does not handle planar faces.
    const PartPair& first = state.active.pairs[0];
    if (first.a >= parts_of(a) || first.b >= parts_of(b)) state.active.count = 0;
    if (!state.normal.isZero()) {
      supports_ += search_direction(pair_, state.normal.normalized(), state.active);
    }
  }

  [[nodiscard]] bool ended() const noexcept { return pair_.is_converged() || deep_ > 0.0; }
  [[nodiscard]] bool overlaps_clearly() const noexcept {
    return pair_.bounds.lower < -kClearOverlap * pair_.size;
  }

  [[nodiscard]] bool overlaps() const noexcept { return pair_.bounds.lower < 0.0; }

  void from_start_direction() noexcept {
    CurvedStart start = start_direction(pair_);
    state_.active = start.active;
    if (!start.overlap) supports_ += search_direction(pair_, start.normal, state_.active);
  }
  void measure_depth(const ActiveParts& active) noexcept {
    const DepthBounds found = bound_depth(pair_, active);
    deep_ = found.lower;
    supports_ += found.supports;
  }

  [[nodiscard]] DistanceResult result() noexcept {
    state_.normal = pair_.bounds.normal;
    state_.overlap = deep_ > 0.0 ? Overlap::kLastQuery : Overlap::kNo;
    state_.point_on_b_B = (deep_ > 0.0 ? pair_.bounds.deepest : pair_.bounds.points).b_B;
    DistanceResult r = conclude(*pair_.a.body, *pair_.b.body, conclusion_of(pair_, deep_));
    r.iterations = static_cast<std::uint16_t>(supports_);
    return r;
  }

 private:
  CurvedPair pair_;
  CurvedTrackingState& state_;
  double deep_ = -kInfinity;  // m: a lower bound of the depth
  int supports_ = 0;
};

// Bodies that clearly overlap along the last direction probably overlap. False: they do not, or
// the direction is useless.
bool overlapping(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                 CurvedTrackingState& state, DistanceResult& r) noexcept {
  Search search(a, b, a_from_b, state);
  if (!search.ended() && search.overlaps_clearly()) search.measure_depth(state.active);
  if (search.ended()) r = search.result();
  return search.ended() && r.status != DistanceStatus::kIterationLimit;
}

DistanceResult found_by_search(const Query& q, CurvedTrackingState& state) noexcept {
  if (state.overlap != Overlap::kNo) {
    DistanceResult r;
    CurvedTrackingState hint = state;
    if (q.depth && overlapping(q.a, q.b, q.a_from_b, hint, r)) {
      state = hint;
      return r;
    }
    if (state.overlap == Overlap::kStationary) state.normal.setZero();
    state.overlap = Overlap::kNoDepth;
    if (newton_distance(q.a, q.b, q.a_from_b, state, r)) return r;
  }
  Search search(q.a, q.b, q.a_from_b, state);
  if (!search.ended()) {
    search.from_start_direction();
    if (q.depth && !search.ended() && search.overlaps()) search.measure_depth({});
  }
  return search.result();
}

}  // namespace

CurvedStart start_direction(CurvedPair& pair) noexcept {
  CurvedStart start;
  start.normal = unit_along(pair.translation());
  if (!(start.normal.norm() > 0.5)) start.normal = Vec3::UnitX();
  StartSimplex simplex;
  for (int round = 0; round < kStartRounds; ++round) {
    const SupportPair found = pair.support(start.normal);
    if (!simplex.add({found, vector_of<double>(found.points.gap())})) break;
    const Vec3 closest = rounded(simplex.reduce().point);
    (void)pair.add_points(simplex.mean([](const StartPoint& p) { return p.at.points.a; }),
                          simplex.mean([](const StartPoint& p) { return p.at.points.b_B; }));
    start.overlap = simplex.holds_origin();
    if (start.overlap || pair.bounds.lower > 0.5 * pair.bounds.upper) break;
    const Vec3 next = unit_along(closest);
    if (!(next.norm() > 0.5)) break;
    start.normal = next;
  }
  start.normal = pair.bounds.normal;
  start.active = active_parts(simplex);
  return start;
}

DistanceResult thorough_distance(const Query& q, CurvedTrackingState& state) noexcept {
  assert(is_good(q.a_from_b));
  return q.a.is_half_space() || q.b.is_half_space()
             ? half_space_distance(q.a, q.b, q.a_from_b, state)
             : found_by_search(q, state);
}

}  // namespace clearance
