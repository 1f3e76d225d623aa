// The state of one input, whatever its value is: the pose of an object, or the position of a joint
// variable. This file also has the only rule by which a sample is taken into use or refused.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "monitor/inputs/contradiction.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/input_owner.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// The time of a tick, and how far stamps may be ahead of it.
struct SampleLimits {
  std::int64_t now_ns = 0;
  std::int64_t future_ns = 0;  // a stamp farther ahead of now is refused
};

// No response limit.
inline constexpr std::int64_t kAnyAge = std::numeric_limits<std::int64_t>::max();

struct InputRecord {
  bool has_value = false;     // a value is in use; always so for a fixed object
  bool late = false;          // the value is older than its limit, or contradicted
  bool contradicted = false;  // at the last advance()
  bool unanswered = false;    // likewise: too old for an answer within Scene::response_limit_ns
  bool ages = true;           // false for a fixed object
  std::int64_t stamp_ns = 0;  // stamp of the value in use, in the tick's time
  Contradiction contradiction;
  InputOwner owner;                                // the source whose samples are used
  std::array<std::uint64_t, kRejects> rejected{};  // refused samples, by cause

  // The age of the value is not known any more: it is late until the next one comes.
  void forget_age(std::int64_t now_ns) noexcept {
    stamp_ns = less(now_ns, kForgottenNs);
    owner.forget_age(now_ns);
    contradiction.forget_age();
  }

  // `own`: before anything was heard.
  [[nodiscard]] bool is_sound(const InputRecord& own) const noexcept {
    return are_flags(has_value, late, contradicted, unanswered, ages) && ages == own.ages &&
           (has_value || ages) && contradiction.is_sound() && owner.is_sound(own.owner);
  }

  // False if the stamp is farther ahead of now than a sample may be: the value would never be late.
  [[nodiscard]] bool is_of_no_future(std::int64_t now_ns, std::int64_t limit_ns) const noexcept {
    return !has_value || !ages || elapsed(now_ns, stamp_ns) <= limit_ns;
  }

  // now - stamp, never negative; 0 for a fixed object, -1: no value.
  [[nodiscard]] std::int64_t age_ns(std::int64_t now_ns) const noexcept {
    if (!has_value) return -1;
    return ages ? elapsed(stamp_ns, now_ns) : 0;
  }

  // Updates the lateness when all samples of the tick have been taken. `response_left_ns` is the
  // age from which on the response comes too late.
  void advance(std::int64_t now_ns, std::int64_t age_limit_ns,
               std::int64_t response_left_ns) noexcept {
    contradicted = contradiction.holds(now_ns);
    unanswered = age_ns(now_ns) > response_left_ns;
    late = contradicted || unanswered || age_ns(now_ns) > age_limit_ns;
  }
  // The response alone is late at this tick: the value is not too old by its own limit.
  [[nodiscard]] bool response_is_late(std::int64_t now_ns,
                                      std::int64_t age_limit_ns) const noexcept {
    return unanswered && !contradicted && age_ns(now_ns) <= age_limit_ns;
  }
};

// Tells who sent a sample, and when its value held in the tick's time.
struct SampleOrigin {
  std::uint32_t source = 0;
  std::uint32_t namesake = kNoSource;  // the source whose name it shares
  std::int64_t stamp_ns = 0;
};

// True if a sample that was refused for this cause contradicts its input. Nonsense and other
// sources do not, and samples may arrive in another order than they were made. `in_use_ns` is the
// stamp of the value in use.
[[nodiscard]] inline bool is_contradiction(Reject cause, std::int64_t stamp_ns,
                                           std::int64_t in_use_ns,
                                           std::int64_t age_limit_ns) noexcept {
  switch (cause) {
    case Reject::kBackwards:
      return elapsed(stamp_ns, in_use_ns) > age_limit_ns;
    case Reject::kUnknownObject:
    case Reject::kNonFinite:
    case Reject::kNotUnit:
    case Reject::kWrongRevision:
    case Reject::kOtherSource:
      return false;
    default:
      return true;
  }
}

// After a dispute of two sources, one of them must be silent for this long.
[[nodiscard]] constexpr std::int64_t dispute_ns(std::int64_t age_limit_ns) noexcept {
  return std::max(age_limit_ns, kSourceSilentNs);
}

// Takes a sample into use, or returns why it must not be used and updates the input's contradiction
// state. Two sources that claim one input with values that exclude each other are a contradiction
// too, whichever came first, unless the cell names the source. Several writers that share the name
// that the cell states are not told apart by it. A `Candidate` is one sample of one
// input, with these members:
//   std::optional<Reject> malformed()    it is not a value at all, whichever source sent it
//   bool disputes()                      it excludes the value in use, which another source sent
//   std::optional<Reject> implausible()  it contradicts the values before it or the cell
//   void use()                           makes it the value in use; the record is still the old one
//   std::int64_t agree_for_ns()          after a refusal: how long later samples must agree
template <class Candidate>
[[nodiscard]] std::optional<Reject> take(Candidate&& candidate, const SampleOrigin& origin,
                                         const SampleLimits& limits, std::int64_t age_limit_ns,
                                         InputRecord& input) noexcept {
  const bool is_rival = input.owner.refuses(origin.source, limits.now_ns, age_limit_ns);
  if (const std::optional<Reject> cause = candidate.malformed()) return cause;
  if (is_rival) {
    const bool is_settled = input.owner.is_stated() && origin.namesake != input.owner.source();
    if (is_settled || !input.has_value || !candidate.disputes()) return Reject::kOtherSource;
    input.contradiction.meet(limits.now_ns, dispute_ns(age_limit_ns));
    return Reject::kDisputed;
  }
  std::optional<Reject> cause;
  if (elapsed(limits.now_ns, origin.stamp_ns) > limits.future_ns) {
    cause = Reject::kFuture;
  } else if (input.has_value && origin.stamp_ns < input.stamp_ns) {
    cause = Reject::kBackwards;
  } else {
    cause = candidate.implausible();
  }
  if (!cause) {
    candidate.use();
    input.contradiction.agree();
    input.stamp_ns = origin.stamp_ns;
    input.owner.take(origin.source, limits.now_ns);
    input.has_value = true;
  } else if (is_contradiction(*cause, origin.stamp_ns, input.stamp_ns, age_limit_ns)) {
    input.contradiction.meet(limits.now_ns, candidate.agree_for_ns());
  }
  return cause;
}

}  // namespace clearance
