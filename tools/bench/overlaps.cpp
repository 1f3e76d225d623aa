#include "tools/bench/overlaps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/distance.hpp"
#include "tools/bench/bodies.hpp"

namespace clearance::bench {
namespace {

constexpr int kMotions = 10;

Body body(const std::string& kind, Random& random) {
  if (kind == "boxes") return std::make_shared<const ConvexBody>(random_box(random));
  if (kind == "links") return std::make_shared<const ConvexBody>(random_link(random));
  return std::make_shared<const ConvexBody>(ball(kind[0], std::stoi(kind.substr(1))));
}

bool are_apart(const Trajectory& pair, const Pose& a, const Pose& b) {
  TrackingState state;
  return distance(*pair.a, *pair.b, relative_pose(a, b), state, {.depth = false}).lower > 0.0;
}

// The distance of the origins along a direction at which the bodies touch, m.
double apart_at_touch(const Trajectory& pair, const Pose& a, Pose b, const Vec3& along) {
  double least = 0.0, most = pair.a->bounding_radius + pair.b->bounding_radius;
  for (int round = 0; round < 40; ++round) {
    const double middle = 0.5 * (least + most);
    b.position = middle * along;
    (are_apart(pair, a, b) ? most : least) = middle;
  }
  return most;
}

Trajectory swing(const std::string& kind, const OverlapDepth& depth, Random& random) {
  Trajectory pair{body(kind, random), body(kind, random), {}};
  const Pose a{Vec3::Zero(), random.turn()}, b{Vec3::Zero(), random.turn()};
  const Vec3 along = random.direction(), across = random.direction(), axis = random.direction();
  const double apart = depth.apart * apart_at_touch(pair, a, b, along);
  for (int k = 0; k < kTrajectorySteps; ++k) {
    const double part = 0.01 * std::sin(2.0 * std::numbers::pi * k / kTrajectorySteps);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(part, axis));
    pair.poses.emplace_back(a, Pose{apart * (along + part * across), turn * b.orientation});
  }
  return pair;
}

}  // namespace

std::vector<Trajectory> overlapping(const std::string& kind, const OverlapDepth& depth) {
  Random random(4);
  std::vector<Trajectory> all;
  for (int i = 0; i < kMotions; ++i) all.push_back(swing(kind, depth, random));
  return all;
}

std::vector<std::string> overlap_names() {
  std::vector<std::string> names;
  for (const std::string kind : kOverlapKinds) {
    for (const OverlapDepth& depth : kOverlapDepths)
      names.push_back(fmt::format("{}/{}", kind, depth.name));
  }
  return names;
}

}  // namespace clearance::bench
