#include "tools/distance/curved_answerer.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/curved_distance.hpp"
#include "core/curved/thorough.hpp"
#include "monitor/app/print.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

OrderedJson json_of(const Vec3& v) { return OrderedJson::array({v.x(), v.y(), v.z()}); }

// The answer for one pose over all pairs of parts.
struct UnionAnswer {
  DistanceResult nearest;
  double lower = kInfinity, upper = kInfinity;
  Vec3 normal, on_a, on_b;  // of the nearest parts; where they overlap, both points are the same
};

// A common point of two overlapping bodies, in frame A. GJK finds one, unless the bodies without
// their radii are separate or hardly overlap. In that case it is the midpoint of the deepest
// points.
Vec3 common_point(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                  const DistanceResult& r) {
  if (a.is_half_space()) return r.point_on_b;
  if (b.is_half_space()) return r.point_on_a;
  CurvedPair pair(a, b, a_from_b);
  (void)start_direction(pair);
  if (pair.bounds.upper <= 4.0 * pair.gap_tolerance()) return pair.bounds.points.a;
  return 0.5 * (r.point_on_a + r.point_on_b);
}

// B's pose places the point of B, because through A's frame its rounding error would grow with the
// distance.
void add(UnionAnswer& answer, const DistanceResult& r, const CurvedPart& a, const CurvedPart& b,
         const Pose& world_from_a, const Pose& world_from_b, const RelativePose& a_from_b,
         const TrackingState& state) {
  answer.lower = std::min(answer.lower, r.lower);
  answer.upper = std::min(answer.upper, r.upper);
  if (r.distance >= answer.nearest.distance) return;
  answer.nearest = r;
  answer.normal = rotation_matrix(world_from_a.orientation) * r.normal;
  if (r.distance < 0.0) {
    answer.on_a = answer.on_b =
        transform(world_from_a, common_point(a.shape, b.shape, a_from_b, r));
    return;
  }
  answer.on_a = transform(world_from_a, r.point_on_a);
  const Vec3 on_core = transform(world_from_b, state.b.point);
  const Vec3 to_a = unit_along(Vec3(answer.on_a - on_core));
  answer.on_b = on_core + b.shape.radius * (to_a.isZero(0.0) ? Vec3(-answer.normal) : to_a);
}

UnionAnswer nearest_of_parts(const CurvedCase& question, const Pose& pose_a, const Pose& pose_b,
                             std::vector<TrackingState>& states) {
  UnionAnswer answer;
  answer.nearest.distance = kInfinity;
  std::size_t pair = 0;
  for (const CurvedPart& a : question.a) {
    const bool whole_a = question.a.size() == 1 && a.body_from_part.position.isZero(0.0);
    const Pose world_from_a = whole_a ? pose_a : compose(pose_a, a.body_from_part);
    for (const CurvedPart& b : question.b) {
      const bool whole_b = question.b.size() == 1 && b.body_from_part.position.isZero(0.0);
      const Pose world_from_b = whole_b ? pose_b : compose(pose_b, b.body_from_part);
      const RelativePose a_from_b = relative_pose(world_from_a, world_from_b);
      TrackingState& state = states[pair++];
      const DistanceResult r = curved_distance(a.shape, b.shape, a_from_b, state);
      add(answer, r, a, b, world_from_a, world_from_b, a_from_b, state);
    }
  }
  return answer;
}

OrderedJson figures(const UnionAnswer& answer, bool parts) {
  const DistanceResult& r = answer.nearest;
  const auto positive = [](double value) { return std::max(0.0, value); };
  OrderedJson out;
  out["distance"] = positive(r.distance);
  out["lower"] = positive(answer.lower);
  out["upper"] = positive(answer.upper);
  out["witness_a"] = json_of(answer.on_a);
  out["witness_b"] = json_of(answer.on_b);
  if (!parts) {
    out["penetration"] = positive(-r.distance);
    out["penetration_lower"] = positive(-r.upper);
    out["penetration_upper"] = positive(-r.lower);
  }
  out["normal"] = json_of(answer.normal);
  out["status"] = name(r.status);
  out["iterations"] = r.iterations;
  return out;
}

}  // namespace

OrderedJson CurvedAnswerer::answer(const CurvedCase& question) {
  const std::size_t pairs = question.a.size() * question.b.size();
  std::vector<UnionAnswer> answers(question.poses.size());
  for (int pass = 0; pass < repeat_; ++pass) {
    std::vector<TrackingState> states(pairs);
    const Clock::time_point start = Clock::now();
    for (std::size_t k = 0; k < answers.size(); ++k) {
      if (cold_) std::fill(states.begin(), states.end(), TrackingState{});
      const auto& [pose_a, pose_b] = question.poses[k];
      answers[k] = nearest_of_parts(question, pose_a, pose_b, states);
    }
    time_ += Clock::now() - start;
    queries_ += answers.size() * pairs;
  }
  OrderedJson out;
  out["id"] = question.id;
  for (const UnionAnswer& answer : answers) {
    not_converged_ += answer.nearest.status == DistanceStatus::kIterationLimit ? 1 : 0;
    const OrderedJson step = figures(answer, pairs > 1);
    for (const auto& [key, value] : step.items()) {
      if (question.motion) {
        out[key].push_back(value);
      } else {
        out[key] = value;
      }
    }
  }
  return out;
}

void CurvedAnswerer::print_summary() const {
  if (queries_ == 0) return;
  const double ns = std::chrono::duration<double, std::nano>(time_).count();
  print(stderr,
        "clearance-distance: curved bodies and parts: {} queries, {} ns a query, {} stopped at the "
        "iteration limit\n",
        queries_, std::llround(ns / static_cast<double>(queries_)), not_converged_);
}

}  // namespace clearance
