// distance(), from top to bottom.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/query/distance.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include "core/curved/curved-inl.hpp"
#include "core/distance.hpp"
#include "core/feature_tracking/penetrating_transitions-inl.hpp"
#include "core/model/bad_pose.hpp"
#include "core/model/finish.hpp"
#include "core/query/search.hpp"

// Everything in HWY_NAMESPACE is compiled once per vector width.
HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The method that goes first.
enum class Method {
  kPoints,    // two points: a closed form
  kTracked,   // the features of the last query, or their neighbours
  kTouching,  // the same, of bodies that touched or penetrated each other
  kCurved,
  kCold,  // features that have to be chosen first
};

HWY_INLINE Method method_of(const Query4& q) {
  if (HWY_UNLIKELY(is_point(q.a) && is_point(q.b))) return Method::kPoints;
  const bool touched = q.state.a.penetrating && q.depth;
  if (HWY_LIKELY(has_features(q) && (q.a.bounded() || q.b.bounded()))) {
    return touched ? Method::kTouching : Method::kTracked;
  }
  if (q.a.is_curved() || q.b.is_curved()) return Method::kCurved;
  return touched ? Method::kTouching : Method::kCold;
}

inline HWY_NOINLINE bool track(const Query4& q, TransitionsMade made, Answer& answer) {
  TrackedPair pair(q, made);
  const TrackingEnd end = move_to_closest(pair);
  if (end != TrackingEnd::kCertified) return may_touch(pair, end) && track_contact(q, answer);
  write(pair, answer);
  return true;
}

inline HWY_NOINLINE bool touch(const Query4& q, Answer& answer) {
  return track_contact(q, answer) || restart_contact(q, answer);
}

inline HWY_NOINLINE Start choose_features(const Query4& q) { return begin(q); }

// Bodies whose features say nothing certain.
inline HWY_NOINLINE void search(const Query4& q, Answer& answer) {
  const RelativePose a_from_b = pose_of(q.a_from_b);
  answer = is_good(a_from_b) ? clearance::search({q.a, q.b, a_from_b, q.state, q.depth})
                             : of_bad_pose(q.state);
}

HWY_INLINE void answer_query(const Query4& q, Answer& answer) {
  TransitionsMade made;
  bool found = false;
  switch (method_of(q)) {
    case Method::kCurved:
      return curved_distance(q, answer);
    case Method::kPoints:
      found = between_points(q, answer);
      break;
    case Method::kTouching:
      found = touch(q, answer);
      break;
    case Method::kCold:
      if (const Start start = choose_features(q); start != Start::kDisjoint) {
        found = start == Start::kInContact && touch(q, answer);
        break;
      }
      [[fallthrough]];
    case Method::kTracked:
      found = still_closest(q, made, answer) || track(q, made, answer);
  }
  if (HWY_UNLIKELY(!found)) search(q, answer);
  finish(q.a, q.b, answer.normal, answer);
}

DistanceResult by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) {
  DistanceResult result;
  answer_query({a, b, relative_pose4(world_from_a, world_from_b), state}, result);
  return result;
}
DistanceResult by_relative_pose(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose& a_from_b, TrackingState& state, bool depth) {
  DistanceResult result;
  answer_query({a, b, good_pose4_of(a_from_b), state, depth}, result);
  return result;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(by_poses);
HWY_EXPORT(by_relative_pose);

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  return HWY_DYNAMIC_DISPATCH(by_poses)(a, b, world_from_a, world_from_b, state);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  return HWY_DYNAMIC_DISPATCH(by_relative_pose)(a, b, a_from_b, state, options.depth);
}

}  // namespace clearance
#endif  // HWY_ONCE
