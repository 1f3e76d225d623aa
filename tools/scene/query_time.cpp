#include "tools/scene/query_time.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "core/distance.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

constexpr int kRounds = 15, kSteps = 3142;

std::vector<Pose> poses_around(double size) {
  std::vector<Pose> poses(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    const double t = 2.0 * std::numbers::pi * k / kSteps;
    const Vec3 direction(std::cos(t), std::sin(t) * std::cos(2.0 * t),
                         std::sin(t) * std::sin(2.0 * t));
    poses[static_cast<std::size_t>(k)].position = 2.5 * size * direction;
    poses[static_cast<std::size_t>(k)].orientation =
        Eigen::Quaterniond(std::cos(t), 0.6 * std::sin(t), 0.0, 0.8 * std::sin(t));
  }
  return poses;
}

// Time per query of one round.
double round_ns(const ReducedModel& model, const ConvexBody& other, const std::vector<Pose>& poses,
                bool tracked) {
  std::vector<TrackingState> states(model.parts.size());
  const auto start = std::chrono::steady_clock::now();
  for (const Pose& pose : poses) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (!tracked) states[i] = TrackingState();
      const EnclosingModel& part = model.parts[i];
      static_cast<void>(distance(part.shape, other, part.frame_from_shape, pose, states[i]));
    }
  }
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
  return took.count() / static_cast<double>(poses.size());
}

}  // namespace

void measure_queries(std::vector<ReducedModel>& models) {
  double size = 0.0;
  for (const ReducedModel& model : models) {
    for (const EnclosingModel& part : model.parts) {
      const double extent = part.frame_from_shape.position.norm() + part.shape.bounding_radius;
      size = std::max(size, extent + part.shape.radius);
    }
  }
  const auto other = std::get<ConvexBody>(box(Vec3::Constant(0.25 * size)));
  const std::vector<Pose> poses = poses_around(size);
  for (ReducedModel& model : models) model.time = QueryTimes{kInfinity, kInfinity};
  for (int round = 0; round < kRounds; ++round) {
    for (ReducedModel& model : models) {
      QueryTimes& least = *model.time;
      least.tracked = std::min(least.tracked, round_ns(model, other, poses, true));
      least.cold = std::min(least.cold, round_ns(model, other, poses, false));
    }
  }
}

}  // namespace clearance
