#include "core/batch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <vector>

#include "core/distance.hpp"

namespace clearance {

// The constructor takes all memory: a round allocates nothing.
class DistanceBatch::Rounds {
 public:
  Rounds(std::span<const ConvexBody* const> bodies, std::span<const BodyPair> pairs)
      : states_(pairs.size()), results_(pairs.size()) {
    pairs_.reserve(pairs.size());
    for (const BodyPair& pair : pairs) {
      pairs_.push_back({bodies[pair.a], bodies[pair.b], pair.a, pair.b});
    }
  }

  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const auto& [a, b, pose_a, pose_b] = pairs_[i];
      assert(std::max(pose_a, pose_b) < world_from_body.size());
      const Pose &at_a = world_from_body[pose_a], &at_b = world_from_body[pose_b];
      if (is_still_nowhere(results_[i], at_a, at_b)) continue;
      // The result is made in its place, not copied there.
      new (&results_[i]) DistanceResult(distance(*a, *b, at_a, at_b, states_[i]));
    }
    return results_;
  }

  void forget() noexcept { std::fill(states_.begin(), states_.end(), TrackingState{}); }

  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept { return states_[pair].b.point; }

 private:
  // A query reads this first.
  struct Pair {
    const ConvexBody *a, *b;
    std::uint32_t pose_a, pose_b;
  };

  // A body without a pose would cost more than a tracked one in every round. The last result still
  // holds.
  static bool is_still_nowhere(const DistanceResult& last, const Pose& a, const Pose& b) noexcept {
    return last.status == DistanceStatus::kBadPose &&
           (std::isnan(a.position.x()) || std::isnan(b.position.x()));
  }

  std::vector<Pair> pairs_;
  std::vector<TrackingState> states_;
  std::vector<DistanceResult> results_;
};

DistanceBatch::DistanceBatch(std::span<const ConvexBody* const> bodies,
                             std::span<const BodyPair> pairs)
    : rounds_(std::make_unique<Rounds>(bodies, pairs)) {}
DistanceBatch::~DistanceBatch() = default;
DistanceBatch::DistanceBatch(DistanceBatch&&) noexcept = default;
DistanceBatch& DistanceBatch::operator=(DistanceBatch&&) noexcept = default;

std::span<const DistanceResult> DistanceBatch::evaluate(
    std::span<const Pose> world_from_body) noexcept {
  return rounds_->evaluate(world_from_body);
}

Vec3 DistanceBatch::point_on_b(std::size_t pair) const noexcept {
  return rounds_->point_on_b(pair);
}

void DistanceBatch::forget() noexcept { rounds_->forget(); }

}  // namespace clearance
