#include "monitor/sensors/mount_track.hpp"

#include <algorithm>
#include <utility>

#include "config/scene/plausible_joints.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/pose_series.hpp"

namespace clearance {
namespace {

// A path that stands still seems to move by less, m and rad.
constexpr double kRounding = 1e-9;
// Two publishers whose places differ by no more agree, m and rad.
constexpr double kSame = 1e-6;

// A mount without stated speeds leaps if it is faster than this. It bounds nothing else.
constexpr MountSpeed kUnstated{.shift = kFastestBase, .turn = kFastestBaseTurn};

const MountSpeed& speed_of(const MountTrack::Limits& limits) noexcept {
  return limits.speed.is_stated() ? limits.speed : kUnstated;
}

// True if a path with these values may have had the pose at that time. After the last value, it
// goes on at the speed of the last two.
bool may_have_been(const PoseSeries& values, const Pose& pose, std::int64_t stamp_ns) noexcept {
  const auto& last = values.last();
  if (stamp_ns < values.at(0).stamp_ns) return false;
  Pose at = last.value;
  PoseSpread error;
  if (stamp_ns <= last.stamp_ns) {
    at = pose_at(values, stamp_ns);
    error = spread(values, at, stamp_ns, stamp_ns);
  } else if (values.size() > 1) {
    const auto& earlier = values.at(values.size() - 2);
    const double ratio = static_cast<double>(elapsed(last.stamp_ns, stamp_ns)) /
                         static_cast<double>(elapsed(earlier.stamp_ns, last.stamp_ns));
    error.shift = ratio * distance_between(earlier.value, last.value);
    error.turn = ratio * angle_between(earlier.value, last.value);
  }
  return distance_between(at, pose) <= error.shift + kSame &&
         angle_between(at, pose) <= error.turn + kSame;
}

}  // namespace

bool PathMetric::stay_within(double limit, const CarriedPose& from,
                             const CarriedPose& to) const noexcept {
  return from.carrier == to.carrier &&
         distance_between(from.pose, to.pose) <= speed.shift * limit + kRounding &&
         angle_between(from.pose, to.pose) <= speed.turn * limit + kRounding;
}

// A pose of a path, as a candidate for clearance::take. It is nothing if a rival's claim leads
// nowhere.
struct MountTrack::Candidate {
  const std::optional<CarriedPose>& pose;
  std::int64_t stamp_ns;
  TrackedPath& state;
  const PoseSeries& values;
  PathMetric metric;
  MotionLimits limits;

  [[nodiscard]] static std::optional<Reject> malformed() noexcept { return std::nullopt; }
  [[nodiscard]] bool disputes() const noexcept {
    return !pose || pose->carrier != state.value.carrier || values.empty() ||
           !may_have_been(values, pose->pose, stamp_ns);
  }
  [[nodiscard]] std::optional<Reject> implausible() const noexcept {
    if (!pose) return Reject::kDisputed;
    const bool has_value = state.input.has_value;
    const bool same = has_value && pose->carrier == state.value.carrier &&
                      same_pose(pose->pose, state.value.pose);
    return state.plausibility.refuses({.value = *pose, .stamp_ns = stamp_ns},
                                      has_value ? &state.value : nullptr, state.input.stamp_ns,
                                      same, state.repetition, limits, metric);
  }
  void use() const noexcept {
    state.plausibility.use(*pose, stamp_ns, !state.input.has_value, limits);
    state.value = *pose;
  }
  [[nodiscard]] std::int64_t agree_for_ns() const noexcept {
    return state.plausibility.agree_for_ns(limits);
  }
};

MountTrack::Source& MountTrack::source_of(const std::string& name) {
  const auto known = std::ranges::find(sources_, name, &Source::name);
  if (known != sources_.end()) return *known;
  sources_.push_back({.name = name});
  return sources_.back();
}

void MountTrack::take(const Source& source, const std::optional<CarriedPose>& value,
                      std::int64_t stamp_ns, std::int64_t now_ns) {
  const auto number = static_cast<std::uint32_t>(&source - sources_.data());
  const SampleOrigin origin{.source = number < kNoSource ? number : number + 1,
                            .stamp_ns = stamp_ns};
  const SampleLimits limits{now_ns, limits_.future_ns};
  track_.add(value ? value->pose : Pose{}, origin, limits, limits_.age_ns, [&](TrackedPath& now) {
    return clearance::take(Candidate{value,
                                     stamp_ns,
                                     now,
                                     track_.past.values(),
                                     PathMetric{speed_of(limits_)},
                                     // One second a second: PathMetric counts in times.
                                     {.fastest = 1.0, .age_limit_ns = limits_.age_ns}},
                           origin, limits, limits_.age_ns, now.input);
  });
}

void MountTrack::add(const std::string& source, const CarriedPose& value, std::int64_t stamp_ns,
                     std::int64_t now_ns) {
  if (elapsed(stamp_ns, judged_until_ns_) > kSetBackNs) forget();
  judged_until_ns_ = stamp_ns;
  take(source_of(source), value, stamp_ns, now_ns);
}

void MountTrack::add_rival(const std::string& source, const std::optional<CarriedPose>& value,
                           std::int64_t stamp_ns, std::int64_t now_ns) {
  Source& rival = source_of(source);
  if (std::exchange(rival.rival_ns, stamp_ns) != stamp_ns) take(rival, value, stamp_ns, now_ns);
}

MountTrack::Excess MountTrack::excess(std::int64_t last_ns) const {
  const PoseSeries& values = track_.past.values();
  const MountSpeed& speed = speed_of(limits_);
  Excess found;
  std::size_t i = values.first_from(less(last_ns, kSourceSilentNs));
  for (i = std::max<std::size_t>(i, 1); i < values.size(); ++i) {
    const auto &a = values.at(i - 1), &b = values.at(i);
    const double time_s = seconds(elapsed(a.stamp_ns, b.stamp_ns));
    const double path = distance_between(a.value, b.value), angle = angle_between(a.value, b.value);
    const double shift = path - speed.shift * time_s, turn = angle - speed.turn * time_s;
    if (limits_.speed.is_stated()) {
      found.shift = std::max(found.shift, shift);
      found.turn = std::max(found.turn, turn);
    } else {
      // The frame may have moved back meanwhile.
      if (shift > kRounding) found.shift = rounded_up(found.shift + path + speed.shift * time_s);
      if (turn > kRounding) found.turn = rounded_up(found.turn + angle + speed.turn * time_s);
    }
    if (b.stamp_ns >= last_ns) break;
  }
  return found;
}

}  // namespace clearance
