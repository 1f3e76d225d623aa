#include "tools/distance/answerer.hpp"

#include <algorithm>
#include <cmath>

#include "core/active_set/active_feature.hpp"
#include "core/active_set/dqp3.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/radii.hpp"
#include "monitor/app/print.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

OrderedJson entry(const Vec3& v) { return OrderedJson::array({v.x(), v.y(), v.z()}); }

// A point of two penetrating bodies, in frame A, where a search for the closest points ends.
Vec3 shared_point(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b) {
  ActiveFeature side_a(a, nullptr), side_b(b, &a_from_b);
  side_a.place_cold(side_b.point_to_a(b.interior));
  side_b.place_cold(a.interior);
  (void)dqp3(side_a, side_b, precision(a, b, a_from_b, 0.0).gap_tolerance);
  const double radii = a.radius + b.radius;
  const double part_of_a = radii > 0.0 ? a.radius / radii : 0.5;
  return side_a.point_A() + part_of_a * (side_b.point_A() - side_a.point_A());
}

OrderedJson figures(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                    const Pose& world_from_b, const DistanceAnswer& answer) {
  const DistanceResult& r = answer.result;
  const bool overlapping = r.upper < 0.0;
  const Vec3 shared =
      overlapping
          ? transform(world_from_a, shared_point(a, b, relative_pose(world_from_a, world_from_b)))
          : Vec3::Zero();
  const auto positive = [](double value) { return std::max(0.0, value); };
  const Vec3 normal = transform({Vec3::Zero(), world_from_a.orientation}, r.normal);
  const Vec3 on_a = transform(world_from_a, r.point_on_a);
  // The rounding error of a point computed through A's frame would grow with the distance.
  const Vec3 on_b = on_rounded_b(transform(world_from_b, answer.own_point_on_b), normal, b);
  OrderedJson out;
  out["distance"] = overlapping ? 0.0 : positive(r.distance);
  out["lower"] = positive(r.lower);
  out["upper"] = positive(r.upper);
  out["witness_a"] = entry(overlapping ? shared : on_a);
  out["witness_b"] = entry(overlapping ? shared : on_b);
  out["penetration"] = r.lower > 0.0 ? 0.0 : positive(-r.distance);
  out["penetration_lower"] = positive(-r.upper);
  out["penetration_upper"] = positive(-r.lower);
  out["normal"] = entry(normal);
  out["deepest_a"] = entry(on_a);
  out["deepest_b"] = entry(on_b);
  out["status"] = name(r.status);
  out["iterations"] = r.iterations;
  return out;
}

}  // namespace

OrderedJson Answerer::answer(const DistanceCase& question) {
  OrderedJson out;
  out["id"] = question.id;
  const std::vector<DistanceAnswer> results = run(question);
  if (!question.motion) {
    const auto& [pose_a, pose_b] = question.poses.front();
    out.update(figures(question.a, question.b, pose_a, pose_b, results.front()));
    return out;
  }
  for (const char* key :
       {"distance", "lower", "upper", "witness_a", "witness_b", "penetration", "penetration_lower",
        "penetration_upper", "normal", "deepest_a", "deepest_b", "status", "iterations"}) {
    out[key] = OrderedJson::array();
  }
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto& [pose_a, pose_b] = question.poses[k];
    const OrderedJson step = figures(question.a, question.b, pose_a, pose_b, results[k]);
    for (const auto& [key, value] : step.items()) out[key].push_back(value);
  }
  return out;
}

void Answerer::print_summary(std::size_t lines, std::size_t bad_lines) const {
  print(stderr, "clearance-distance: {} lines, {} with errors, {} queries{}", lines, bad_lines,
        queries_, cold_ ? " (cold)" : "");
  if (queries_ > 0) {
    const double ns = std::chrono::duration<double, std::nano>(time_).count();
    print(stderr, ", {} ns a query, {} stopped at the iteration limit",
          std::llround(ns / static_cast<double>(queries_)), not_converged_);
  }
  print(stderr, "\n");
  if (queries_ > 0) print_paths();
}

void Answerer::print_paths() const {
  const std::size_t robust = paths_[DistancePath::kGjk];
  print(stderr,
        "clearance-distance: by feature tracking {}, by the active set {} ({} touch or overlap, {} "
        "by "
        "GJK), by features that overlap {}\n",
        paths_[DistancePath::kFeatureTracking], paths_[DistancePath::kActiveSet] + robust,
        paths_.met, robust, paths_[DistancePath::kPenetration]);
}

void PathCount::add(const DistanceResult& result) {
  ++by_path[static_cast<std::size_t>(result.path)];
  const bool meets =
      result.status == DistanceStatus::kTouching || result.status == DistanceStatus::kOverlapping;
  const bool searched =
      result.path == DistancePath::kActiveSet || result.path == DistancePath::kGjk;
  met += meets && searched ? 1 : 0;
}

// One pass over the motion gives the answers; further passes only measure time.
std::vector<DistanceAnswer> Answerer::run(const DistanceCase& question) {
  const std::vector<std::pair<Pose, Pose>>& poses = question.poses;
  std::vector<DistanceAnswer> results(poses.size());
  for (int pass = 0; pass < repeat_; ++pass) {
    TrackingState state;
    const Clock::time_point start = Clock::now();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (cold_) state = {};
      results[k].result = distance(question.a, question.b, poses[k].first, poses[k].second, state);
      results[k].own_point_on_b = state.b.point;
    }
    time_ += Clock::now() - start;
    queries_ += poses.size();
  }
  for (const DistanceAnswer& answer : results) {
    paths_.add(answer.result);
    not_converged_ += answer.result.status == DistanceStatus::kIterationLimit ? 1 : 0;
  }
  return results;
}

}  // namespace clearance
