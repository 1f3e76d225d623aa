#include "tools/distance/answerer.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "core/active_side.hpp"
#include "core/dqp3.hpp"
#include "core/precision.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

OrderedJson world_point(const Pose& world_from_a, const Vec3& point_in_a) {
  const Vec3 p = transform(world_from_a, point_in_a);
  return OrderedJson::array({p.x(), p.y(), p.z()});
}

// Of two bodies that overlap, in frame A: where a search for the closest points ends.
Vec3 shared_point(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                  const RelativePose& a_from_b) {
  ActiveSide side_a(a, nullptr), side_b(b, &a_from_b);
  side_a.place_cold(side_b.point_to_common(b.interior));
  side_b.place_cold(a.interior);
  (void)dqp3(side_a, side_b, precision(a, b, a_from_b, 0.0).tight);
  const double radii = a.radius + b.radius;
  const double part_of_a = radii > 0.0 ? a.radius / radii : 0.5;
  return side_a.common() + part_of_a * (side_b.common() - side_a.common());
}

OrderedJson figures(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const Pose& world_from_a,
                    const Pose& world_from_b, const DistanceResult& r) {
  const bool overlapping = r.upper < 0.0;
  const Vec3 shared =
      overlapping ? shared_point(a, b, relative_pose(world_from_a, world_from_b)) : Vec3::Zero();
  const auto positive = [](double value) { return std::max(0.0, value); };
  OrderedJson out;
  out["distance"] = overlapping ? 0.0 : positive(r.distance);
  out["lower"] = positive(r.lower);
  out["upper"] = positive(r.upper);
  out["witness_a"] = world_point(world_from_a, overlapping ? shared : r.point_on_a);
  out["witness_b"] = world_point(world_from_a, overlapping ? shared : r.point_on_b);
  out["penetration"] = r.lower > 0.0            ? 0.0
                       : std::isnan(r.distance) ? r.distance
                                                : positive(-r.distance);
  out["penetration_lower"] = positive(-r.upper);
  out["penetration_upper"] = positive(-r.lower);
  const Vec3 normal = transform({Vec3::Zero(), world_from_a.orientation}, r.normal);
  out["normal"] = OrderedJson::array({normal.x(), normal.y(), normal.z()});
  out["deepest_a"] = world_point(world_from_a, r.point_on_a);
  out["deepest_b"] = world_point(world_from_a, r.point_on_b);
  out["status"] = name(r.status);
  out["iterations"] = r.iterations;
  return out;
}

}  // namespace

OrderedJson Answerer::answer(const DistanceCase& question) {
  OrderedJson out;
  out["id"] = question.id;
  const std::vector<DistanceResult> results = run(question);
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
  std::cerr << "clearance-distance: " << lines << " lines, " << bad_lines << " with errors, "
            << queries_ << " queries" << (cold_ ? " (cold)" : "");
  if (queries_ > 0) {
    const double ns = std::chrono::duration<double, std::nano>(time_).count();
    std::cerr << ", " << std::llround(ns / static_cast<double>(queries_)) << " ns a query, "
              << not_converged_ << " stopped at the iteration limit";
  }
  std::cerr << '\n';
}

// One pass over the motion gives the answers; further ones are only for the clock.
std::vector<DistanceResult> Answerer::run(const DistanceCase& question) {
  const std::vector<std::pair<Pose, Pose>>& poses = question.poses;
  std::vector<DistanceResult> results(poses.size());
  for (int pass = 0; pass < repeat_; ++pass) {
    TrackingState state;
    const Clock::time_point start = Clock::now();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (cold_) state = {};
      results[k] = distance(question.a, question.b, poses[k].first, poses[k].second, state);
    }
    time_ += Clock::now() - start;
    queries_ += poses.size();
  }
  for (const DistanceResult& r : results) {
    not_converged_ += r.status == DistanceStatus::kIterationLimit ? 1 : 0;
  }
  return results;
}

}  // namespace clearance
