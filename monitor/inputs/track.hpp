// One input over time: the position of a joint, the pose of an object, or the path of a camera's
// frame in tf. Every sample is judged once, by the one rule of input_record.hpp.
//
// The tick needs the value in use now only. Code that needs a place at the stamp of a picture keeps
// a Track, which has the values that were taken before as well.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/past_values.hpp"

namespace clearance {

// `Tracked` is the state of an input in the tick: TrackedVariable, TrackedObject, TrackedPath.
template <class Tracked, class Value>
struct Track {
  Track(const Tracked& initial, std::size_t most_values) : now(initial), past(most_values) {}

  // Takes a sample by take(now), which judges it by the rules of its kind and returns the reason of
  // a refusal. Keeps the value if it is taken.
  template <class Take>
  std::optional<Reject> add(const Value& value, const SampleOrigin& origin,
                            const SampleLimits& limits, std::int64_t age_limit_ns, Take&& take) {
    const bool has_value = now.input.has_value;
    const std::int64_t in_use_ns = now.input.stamp_ns;
    const std::optional<Reject> cause = take(now);
    if (!cause) {
      past.use(origin.stamp_ns, value);
    } else if (is_contradiction(*cause, origin.stamp_ns, in_use_ns, age_limit_ns)) {
      // A stamp of the future or from long ago contradicts what is in use now.
      std::int64_t at_ns = std::min(origin.stamp_ns, limits.now_ns);
      if (has_value) at_ns = std::max(at_ns, in_use_ns);
      past.contradict(at_ns, *cause == Reject::kDisputed
                                 ? dispute_ns(age_limit_ns)
                                 : now.plausibility.agree_for_ns({.age_limit_ns = age_limit_ns}));
    }
    return cause;
  }

  // True if a sample of the source in use has a stamp of before its clock was set back.
  [[nodiscard]] bool is_set_back(const SampleOrigin& origin) const noexcept {
    return now.input.has_value && origin.source == now.input.owner.source() &&
           elapsed(origin.stamp_ns, now.input.stamp_ns) > kSetBackNs;
  }
  void begin_anew(const Tracked& initial) {
    now = initial;
    past.clear();
  }

  Tracked now;
  PastValues<Value> past;
};

}  // namespace clearance
