#include "tests/shared/distance_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "core/numerics/error_constants.hpp"
#include "tests/shared/exact_depth.hpp"
#include "tests/shared/exact_features.hpp"
#include "tests/shared/exact_placement.hpp"

namespace clearance {
namespace {

using oracle::Body;
using oracle::ExactDistance;
using oracle::Rational;

// Tolerances relative to DistanceJudge::size: for the gap between the bounds of disjoint bodies,
// for that gap otherwise, and for the positions of witness points.
constexpr double kApartTolerance = 1e-14, kMetTolerance = 1.25e-14, kPointTolerance = 1.5e-14;

// The largest number of rows or points for which the depth is checked exactly. If the features are
// not plain, the exact depth takes the square of it.
constexpr std::size_t kDepthOf = 16;

template <class... Values>
std::string text(const char* format, Values... values) {
  char out[300];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

// The distance of the point p (frame A) from a body, computed exactly and rounded up.
double outside(oracle::ExactBody& body, const Pose& pose, double radius, const Vec3& p,
               const Pose& pose_a) {
  oracle::ExactBody point(Body{{}, {p}, 0.0});
  const ExactDistance d = oracle::exact_distance(body, pose, point, pose_a);
  return std::max(0.0, d.upper - radius);
}

// The body with every facet moved inwards by `by`. A point or a segment is returned unchanged,
// because it has no interior.
Body eroded(Body body, double by) {
  for (HalfSpace& row : body.rows) row.offset -= by * row.normal.norm() * (1.0 + 1e-15);
  return body;
}

struct Faults {
  std::vector<std::string> all;

  void unless(bool holds, const std::string& fault) {
    if (!holds) all.push_back(fault);
  }
};

bool are_numbers(const DistanceResult& r, Faults& faults) {
  const bool finite = std::isfinite(r.distance) && std::isfinite(r.lower) &&
                      std::isfinite(r.upper) && r.normal.allFinite() && r.point_on_a.allFinite() &&
                      r.point_on_b.allFinite();
  faults.unless(finite, text("a figure is not finite: distance %g in [%g, %g]", r.distance, r.lower,
                             r.upper));
  return finite;
}

// `depth_known`: `truth` contains the depth of an overlap, and not only the fact that the bodies
// overlap.
void look_at_bounds(const DistanceResult& r, const ExactDistance& truth, bool depth_known,
                    Faults& faults) {
  faults.unless(r.lower <= r.distance && r.distance <= r.upper,
                text("distance %.17g is not in [%.17g, %.17g]", r.distance, r.lower, r.upper));
  faults.unless(truth.compare(r.lower) >= 0, text("LOWER %.17g is above the truth %.17g by %.3g",
                                                  r.lower, truth.lower, r.lower - truth.lower));
  faults.unless(!depth_known || truth.compare(r.upper) <= 0,
                text("UPPER %.17g is below the truth %.17g by %.3g", r.upper, truth.upper,
                     truth.upper - r.upper));
}

void look_at_status(const DistanceResult& r, const ExactDistance& truth, double tolerance,
                    Faults& faults) {
  const char* status = name(r.status);
  const double gap = r.upper - r.lower;
  switch (r.status) {
    case DistanceStatus::kIterationLimit:
    case DistanceStatus::kDepthNotAsked:
    case DistanceStatus::kBadPose:
      faults.unless(false, text("status %s, truth %.17g in [%.17g, %.17g], tolerance %.3g", status,
                                truth.lower, r.lower, r.upper, tolerance));
      return;
    case DistanceStatus::kOverlapping:
      faults.unless(truth.compare(0.0) <= 0, text("overlapping, but %.17g apart", truth.lower));
      break;
    case DistanceStatus::kConverged:
      faults.unless(truth.compare(0.0) > 0, text("converged, but the truth is %.17g", truth.lower));
      break;
    case DistanceStatus::kTouching:
      faults.unless(
          truth.compare(tolerance) <= 0 && truth.compare(-tolerance) >= 0,
          text("touching, but the truth is %.17g, tolerance %.3g", truth.lower, tolerance));
      break;
  }
  faults.unless(gap <= tolerance,
                text("%s with a gap of %.3g, more than %.3g", status, gap, tolerance));
}

// Checks that the witness points agree with distance and normal. `placed` is the rounding error
// allowed for a point.
void look_at_witnesses(const DistanceResult& r, double placed, Faults& faults) {
  const Vec3 between = r.point_on_b - r.point_on_a;
  faults.unless(std::abs(r.normal.norm() - 1.0) <= 1e-14,
                text("normal of length %.17g", r.normal.norm()));
  if (r.status == DistanceStatus::kTouching) {
    faults.unless(between.norm() <= placed,
                  text("touching, but the witness points are %.3g apart", between.norm()));
    return;
  }
  const Vec3 off = between - r.distance * r.normal;
  faults.unless(off.norm() <= placed,
                text("%s, but from one witness point to the other it is not the distance along the "
                     "normal: off by %.3g, tolerance %.3g",
                     name(r.status), off.norm(), placed));
}

}  // namespace

ShapeResult model(const Body& body) {
  ShapeResult out;
  if (!body.rows.empty()) {
    out = polyhedron_from_halfspaces(body.rows);
  } else if (body.points.size() == 1) {
    out = point(body.points[0], body.radius);
  } else if (body.points.size() == 2) {
    out = segment(body.points[0], body.points[1], body.radius);
  } else {
    out = polyhedron_from_vertices(body.points);
  }
  if (auto* polyhedron = std::get_if<ConvexBody>(&out)) polyhedron->radius = body.radius;
  return out;
}

DistanceJudge::DistanceJudge(const Body& a, const Body& b)
    : body_a_(a), body_b_(b), exact_a_(a), exact_b_(b) {
  ConvexBody* models[] = {&a_, &b_};
  for (int k = 0; k < 2; ++k) {
    ShapeResult shape = model(k == 0 ? a : b);
    if (auto* polyhedron = std::get_if<ConvexBody>(&shape)) {
      *models[k] = std::move(*polyhedron);
    } else {
      refusal_ += std::string(k == 0 ? "a: " : "b: ") + std::get<ShapeError>(shape).reason + "; ";
    }
  }
}

DistanceResult DistanceJudge::ask(const Pose& pose_a, const Pose& pose_b,
                                  TrackingState& state) const {
  return distance(a_, b_, relative_pose(pose_a, pose_b), state);
}

ExactDistance DistanceJudge::truth(const Pose& pose_a, const Pose& pose_b) {
  ExactDistance out = oracle::exact_distance(exact_a_, pose_a, exact_b_, pose_b);
  out.add_radii(body_a_.radius, body_b_.radius);
  if (!out.cores_meet() || !depth_is_asked_for()) return out;
  if (const auto depth = oracle::exact_squared_depth(body_a_, pose_a, body_b_, pose_b)) {
    out.set_squared_depth(*depth);
  }
  return out;
}

bool DistanceJudge::depth_is_asked_for() const {
  const auto small = [](const Body& body) {
    return (body.rows.size() <= kDepthOf && body.points.size() <= kDepthOf) ||
           oracle::features_are_plain(body);
  };
  return small(body_a_) && small(body_b_);
}

bool DistanceJudge::depth_is_known(const ExactDistance& truth) const {
  return !truth.cores_meet() || depth_is_asked_for();
}

double DistanceJudge::size(double farthest, const Pose& pose_a, const Pose& pose_b) const {
  const double apart = (pose_b.position - pose_a.position).norm();
  const double radius_a = a_.bounding_radius + a_.radius, radius_b = b_.bounding_radius + b_.radius;
  const double reach_a = a_.bounded() ? radius_a : std::max(radius_a, radius_b + apart + farthest);
  const double reach_b = b_.bounded() ? radius_b : std::max(radius_b, radius_a + apart + farthest);
  return reach_a + reach_b + apart;
}

double DistanceJudge::size(const DistanceResult& r, const ExactDistance& truth, const Pose& pose_a,
                           const Pose& pose_b) const {
  return size(std::abs(depth_is_known(truth) ? truth.upper : r.lower), pose_a, pose_b);
}

std::vector<std::string> DistanceJudge::faults_along(const DistanceResult& r, double tolerance,
                                                     const Pose& pose_a, const Pose& pose_b) {
  if (!(std::abs(r.normal.norm() - 1.0) <= 1e-14)) return {"an overlap without a normal"};
  // rounding of B's position in the world
  const double placing = 4.0 * kUlp * pose_b.position.norm();
  const auto parted_by = [&](double depth) {
    Pose parted = pose_b;
    parted.position +=
        (depth - body_a_.radius - body_b_.radius) * (pose_a.orientation.normalized() * r.normal);
    return !oracle::exact_distance(exact_a_, pose_a, exact_b_, parted).cores_meet();
  };
  std::vector<std::string> out;
  if (!parted_by(-r.lower + tolerance + placing)) {
    out.push_back(text("LOWER %.17g, but B moved by that along the normal still meets A", r.lower));
  }
  if (-r.upper > tolerance + placing && parted_by(-r.upper - tolerance - placing)) {
    out.push_back(text("UPPER %.17g, but B moved by less along the normal misses A", r.upper));
  }
  return out;
}

bool DistanceJudge::overlap_by(double depth, const Pose& pose_a, const Pose& pose_b) const {
  if (body_a_.points.size() > 2 || body_b_.points.size() > 2) return false;
  if (body_a_.rows.empty() && body_b_.rows.empty()) return false;
  try {
    return oracle::exact_distance(eroded(body_a_, depth), pose_a, eroded(body_b_, depth), pose_b)
        .cores_meet();
  } catch (const std::invalid_argument&) {
    return false;  // the erosion leaves nothing of one body
  }
}

std::vector<std::string> DistanceJudge::faults_of_unbounded(const DistanceResult& r,
                                                            const ExactDistance& truth) const {
  Faults faults;
  look_at_bounds(r, truth, depth_is_known(truth) && truth.squared_depth != 0, faults);
  const bool numbers = r.normal.allFinite() && r.point_on_a.allFinite() &&
                       r.point_on_b.allFinite() && !std::isnan(r.distance);
  faults.unless(numbers, "a figure is no number");
  faults.unless(r.status != DistanceStatus::kConverged || r.lower > 0.0, "converged, but to what?");
  faults.unless(r.status != DistanceStatus::kOverlapping || truth.cores_meet(),
                "overlapping, but apart");
  return faults.all;
}

std::vector<std::string> DistanceJudge::faults(const DistanceResult& r, const ExactDistance& truth,
                                               const Pose& pose_a, const Pose& pose_b) {
  if (!a_.bounded() && !b_.bounded()) return faults_of_unbounded(r, truth);
  Faults faults;
  if (!are_numbers(r, faults)) return faults.all;
  look_at_bounds(r, truth, depth_is_known(truth), faults);

  const double reach = size(r, truth, pose_a, pose_b);
  const bool apart = r.status == DistanceStatus::kConverged;
  const double tolerance = (apart ? kApartTolerance : kMetTolerance) * reach + 4.0 * kUnderflow;
  if (!depth_is_known(truth)) {
    for (const auto& fault : faults_along(r, tolerance, pose_a, pose_b))
      faults.all.push_back(fault);
  }
  // With a floor that passes through both origins, no length exists that a rounding error could be
  // relative to.
  if (reach == 0.0 && r.status == DistanceStatus::kIterationLimit) return faults.all;
  look_at_status(r, truth, tolerance, faults);
  if (r.status == DistanceStatus::kTouching && tolerance > 0.0 && truth.cores_meet()) {
    faults.unless(!overlap_by(tolerance, pose_a, pose_b),
                  text("touching, but a ball of %.3g fits into both", tolerance));
  }

  const double placed = kPointTolerance * reach + 4.0 * kUnderflow;
  const double off_a = outside(exact_a_, pose_a, body_a_.radius, r.point_on_a, pose_a);
  const double off_b = outside(exact_b_, pose_b, body_b_.radius, r.point_on_b, pose_a);
  faults.unless(off_a <= placed,
                text("witness on A is %.3g outside, tolerance %.3g", off_a, placed));
  faults.unless(off_b <= placed,
                text("witness on B is %.3g outside, tolerance %.3g", off_b, placed));
  look_at_witnesses(r, placed, faults);
  return faults.all;
}

}  // namespace clearance
