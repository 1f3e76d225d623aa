// distance(), from top to bottom.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/query/distance.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include <iterator>

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
  kCold,  // no features: they are chosen first, and without a choice the search follows
};

HWY_INLINE bool are_points(const ConvexBody& a, const ConvexBody& b) {
  return HWY_UNLIKELY(is_point(a) && is_point(b));
}

HWY_INLINE Method method_of(const Query4& q) {
  if (are_points(q.a, q.b)) return Method::kPoints;
  const bool touched = q.state.a.penetrating && q.depth;
  if (HWY_LIKELY(has_features(q) && (q.a.bounded() || q.b.bounded()))) {
    return touched ? Method::kTouching : Method::kTracked;
  }
  if (q.a.is_curved() || q.b.is_curved()) return Method::kCurved;
  return touched ? Method::kTouching : Method::kCold;
}

// The method for the features that it chooses.
inline HWY_NOINLINE Method choose_features(const Query4& q) {
  const Start start = begin(q);
  if (start == Start::kNone) return Method::kCold;
  return start == Start::kInContact ? Method::kTouching : Method::kTracked;
}

HWY_INLINE bool track(const Query4& q, TransitionsMade made, Answer& answer) {
  TrackedPair pair(q, made);
  const TrackingEnd end = move_to_closest(pair);
  if (end != TrackingEnd::kCertified) return may_touch(pair, end) && track_contact(q, answer);
  write(pair, answer);
  return true;
}

HWY_INLINE bool touch(const Query4& q, Answer& answer) {
  return track_contact(q, answer) || restart_contact(q, answer);
}

// Bodies whose features say nothing certain.
inline HWY_NOINLINE void search(const Query4& q, Answer& answer) {
  const RelativePose a_from_b = pose_of(q.a_from_b);
  answer = is_good(a_from_b) ? clearance::search({q.a, q.b, a_from_b, q.state, q.depth})
                             : of_bad_pose(q.state);
}

HWY_NOINLINE void answer_by(Method method, const Query4& q, TransitionsMade made, Answer& answer) {
  bool found = false;
  switch (method) {
    case Method::kCurved:
      return curved_distance(q, answer);
    case Method::kPoints:
      found = between_points(q, answer);
      break;
    case Method::kTouching:
      found = touch(q, answer);
      break;
    case Method::kTracked:
      found = track(q, made, answer);
      break;
    case Method::kCold:
      break;
  }
  if (HWY_UNLIKELY(!found)) search(q, answer);
  finish(q.a, q.b, answer.normal, answer);
}

// Most queries of a moving scene end with the features of the last one. Their pose stays in
// registers: only its copy gets an address.
HWY_INLINE void answer_query(const Query4& q, Answer& answer) {
  Method method = method_of(q);
  if (method == Method::kCold) {
    method = choose_features({q.a, q.b, in_memory(q.a_from_b), q.state, q.depth});
  }
  TransitionsMade made;
  if (HWY_LIKELY(method == Method::kTracked && still_closest(q, made, answer))) {
    return finish(q.a, q.b, answer.normal, answer);
  }
  answer_by(method, {q.a, q.b, in_memory(q.a_from_b), q.state, q.depth}, made, answer);
}

// A sphere is mostly around the origin of its frame. Then its orientation does not matter.
HWY_NOINLINE bool between_origins(const ConvexBody& a, const ConvexBody& b,
                                  const Pose& world_from_a, const Pose& world_from_b,
                                  TrackingState& state, Answer& answer) {
  RelativePose4 place;
  if (b.bounding_radius != 0.0 || !set_place(world_from_a, world_from_b, place) ||
      !between_points({a, b, place, state}, answer)) {
    return false;
  }
  finish(a, b, answer.normal, answer);
  return true;
}

DistanceResult by_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) {
  DistanceResult result;
  if (!are_points(a, b) || !between_origins(a, b, world_from_a, world_from_b, state, result)) {
    answer_query({a, b, relative_pose4(world_from_a, world_from_b), state}, result);
  }
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

namespace {

// The chosen vector width. Highway is asked only once where it keeps it, because each call leads
// into a shared library.
std::size_t width() noexcept {
  static const hwy::ChosenTarget& chosen = hwy::GetChosenTarget();
  return std::size(HWY_DISPATCH_TABLE(by_poses)) == 1 ? 0 : chosen.GetIndex();
}

}  // namespace

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  return HWY_DISPATCH_TABLE(by_poses)[width()](a, b, world_from_a, world_from_b, state);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  return HWY_DISPATCH_TABLE(by_relative_pose)[width()](a, b, a_from_b, state, options.depth);
}

}  // namespace clearance
#endif  // HWY_ONCE
