// The rule that accepts or refuses a sample, for all samples and inputs; and which bytes of a state
// it refuses.
#include "monitor/inputs/input_record.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>

#include "core/convex_body.hpp"
#include "monitor/inputs/refused_value.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMs = 1'000'000, kNow = 10'000 * kMs, kAgeLimit = 20 * kMs;
constexpr std::uint32_t kFirst = 1, kSecond = 2;

// All that the rule asks of a sample and of its input, as bits.
struct Case {
  bool is_malformed, is_rival, is_stated, is_namesake, has_value, disputes, is_future, is_older,
      is_long_ago, is_implausible;
  static constexpr unsigned kCount = 1U << 10U;

  explicit Case(unsigned bits) {
    bool* const flags[] = {&is_malformed, &is_rival,  &is_stated, &is_namesake, &has_value,
                           &disputes,     &is_future, &is_older,  &is_long_ago, &is_implausible};
    for (bool* const flag : flags) {
      *flag = (bits & 1U) != 0;
      bits >>= 1U;
    }
  }
  // The value in use is 50 ms old. A sample is 5 ms, 60 ms or 150 ms old, or of the future.
  [[nodiscard]] std::int64_t stamp_ns() const {
    if (is_future) return kNow + 3 * kMs;
    return kNow - (!is_older ? 5 : is_long_ago ? 150 : 60) * kMs;
  }
};

// Stands in for a pose or a position; its answers are those of the case.
struct HeardPose {
  const Case& of;
  bool is_used = false;
  [[nodiscard]] std::optional<Reject> malformed() const {
    return of.is_malformed ? std::optional(Reject::kNonFinite) : std::nullopt;
  }
  [[nodiscard]] bool disputes() const { return of.disputes; }
  [[nodiscard]] std::optional<Reject> implausible() const {
    return of.is_implausible ? std::optional(Reject::kTooFast) : std::nullopt;
  }
  void use() { is_used = true; }
  [[nodiscard]] std::int64_t agree_for_ns() const { return 51 * kAgeLimit; }
};

// What the pages say (FAULTS.md, "Refused" and "Two of them"): the cause, and how long the input is
// unknown after it, ns; -1: it stays known.
struct Expected {
  std::optional<Reject> cause;
  std::int64_t unknown_ns = -1;
};
Expected expected(const Case& of) {
  if (of.is_malformed) return {Reject::kNonFinite};
  if (of.is_rival) {
    const bool cell_decides = of.is_stated && !of.is_namesake;
    if (cell_decides || !of.has_value || !of.disputes) return {Reject::kOtherSource};
    return {Reject::kDisputed, kSourceSilentNs};
  }
  if (of.is_future) return {Reject::kFuture, 51 * kAgeLimit};
  if (of.is_older && of.has_value)
    return {Reject::kBackwards, of.is_long_ago ? 51 * kAgeLimit : -1};
  if (of.is_implausible) return {Reject::kTooFast, 51 * kAgeLimit};
  return {};
}

TEST(InputRecord, IsTakenOrRefusedByTheFirstCauseThatHolds) {
  for (unsigned bits = 0; bits < Case::kCount; ++bits) {
    const Case of(bits);
    InputRecord input;
    if (of.is_stated) input.owner = InputOwner(kFirst);
    input.owner.take(kFirst, kNow - 50 * kMs);
    input.has_value = of.has_value;
    input.stamp_ns = kNow - 50 * kMs;
    HeardPose sample{of};
    const SampleOrigin origin{.source = of.is_rival ? kSecond : kFirst,
                              .namesake = of.is_namesake ? kFirst : kNoSource,
                              .stamp_ns = of.stamp_ns()};
    const SampleLimits limits{.now_ns = kNow, .future_ns = 2 * kMs};
    const Expected is = expected(of);
    SCOPED_TRACE(bits);
    EXPECT_EQ(take(sample, origin, limits, kAgeLimit, input), is.cause);
    EXPECT_EQ(sample.is_used, !is.cause);
    EXPECT_EQ(input.has_value, of.has_value || !is.cause);
    EXPECT_EQ(input.stamp_ns, is.cause ? kNow - 50 * kMs : of.stamp_ns());
    EXPECT_EQ(input.owner.other_source(kNow), of.is_rival ? kSecond : kNoSource);
    EXPECT_EQ(input.contradiction.holds(kNow), is.unknown_ns >= 0);
    input.contradiction.agree();
    EXPECT_EQ(input.contradiction.holds(kNow + is.unknown_ns), is.unknown_ns >= 0);
    EXPECT_FALSE(input.contradiction.holds(kNow + is.unknown_ns + 1));
  }
}

TEST(InputRecord, OfASourceThatWasSilentForASecondIsTakenFromAnother) {
  for (const std::int64_t silent : {kSourceSilentNs, kSourceSilentNs + 1}) {
    InputOwner owner, stated(kFirst);
    owner.take(kFirst, kNow);
    stated.take(kFirst, kNow);
    EXPECT_EQ(owner.refuses(kSecond, kNow + silent, kAgeLimit), silent == kSourceSilentNs);
    EXPECT_TRUE(owner.refuses(kSecond, kNow + silent, 2 * kSourceSilentNs)) << "a longer age limit";
    EXPECT_TRUE(stated.refuses(kSecond, kNow + silent, kAgeLimit));
  }
  InputOwner owner;
  EXPECT_FALSE(owner.refuses(kFirst, kNow, kAgeLimit)) << "nothing was heard";
  owner.take(kFirst, kNow);
  owner.leave();
  EXPECT_FALSE(owner.refuses(kSecond, kNow, kAgeLimit));
  owner.take(kSecond, kNow);
  EXPECT_EQ(owner.takeovers(), 0u) << "the first had left";
}

TEST(InputRecord, IsLateByItsAgeByItsResponseOrByAContradictionAlone) {
  for (const bool is_old : {false, true}) {
    for (const bool is_unanswered : {false, true}) {
      for (const bool is_contradicted : {false, true}) {
        InputRecord input;
        input.has_value = true;
        input.stamp_ns = kNow - 10 * kMs;
        if (is_contradicted) input.contradiction.meet(kNow, kMs);
        const std::int64_t limit = (is_old ? 9 : 10) * kMs;
        input.advance(kNow, limit, (is_unanswered ? 9 : 10) * kMs);
        EXPECT_EQ(input.late, is_old || is_unanswered || is_contradicted);
        EXPECT_EQ(input.contradicted, is_contradicted);
        EXPECT_EQ(input.response_is_late(kNow, limit),
                  is_unanswered && !is_old && !is_contradicted);
      }
    }
  }
  InputRecord unheard, fixed;
  unheard.advance(kNow, kAgeLimit, kAnyAge);
  EXPECT_EQ(unheard.age_ns(kNow), -1);
  fixed.ages = false;
  fixed.has_value = true;
  fixed.advance(kNow, kAgeLimit, kAnyAge);
  EXPECT_EQ(fixed.age_ns(kNow), 0);
  EXPECT_FALSE(fixed.late);
}

TEST(InputRecord, IsNotSoundWithABitThatNoMonitorOfTheSceneCanHave) {
  const InputRecord own;
  InputRecord good = own;
  EXPECT_TRUE(good.is_sound(own));
  for (bool InputRecord::*flag :
       {&InputRecord::has_value, &InputRecord::late, &InputRecord::contradicted,
        &InputRecord::unanswered, &InputRecord::ages}) {
    InputRecord forged = own;
    std::memset(&(forged.*flag), 2, 1);
    EXPECT_FALSE(forged.is_sound(own));
  }
  InputRecord fixed = own, of_fixed = own;
  fixed.ages = of_fixed.ages = false;
  EXPECT_FALSE(fixed.is_sound(of_fixed)) << "a fixed object has a pose";
  fixed.has_value = of_fixed.has_value = true;
  EXPECT_TRUE(fixed.is_sound(of_fixed));
  EXPECT_FALSE(fixed.is_sound(own)) << "it is not fixed in this scene";
  InputRecord stated = own, other = own;
  stated.owner = InputOwner(kFirst);
  EXPECT_FALSE(stated.is_sound(own)) << "the cell names no source";
  other.owner = InputOwner(kSecond);
  EXPECT_FALSE(other.is_sound(stated)) << "the cell names another one";
  EXPECT_TRUE(stated.is_sound(stated));
}

TEST(Contradiction, IsAnyCauseButNonsenseOtherSourcesAndSamplesThatAreLittleOlder) {
  const std::set<Reject> no_contradiction = {Reject::kUnknownObject, Reject::kNonFinite,
                                             Reject::kNotUnit, Reject::kWrongRevision,
                                             Reject::kOtherSource};
  for (std::size_t i = 0; i < kRejects; ++i) {
    const auto cause = static_cast<Reject>(i);
    const bool is_old = cause == Reject::kBackwards;
    const bool expected = !no_contradiction.contains(cause);
    EXPECT_EQ(is_contradiction(cause, kNow - kAgeLimit, kNow, kAgeLimit), expected && !is_old)
        << name(cause);
    EXPECT_EQ(is_contradiction(cause, kNow - kAgeLimit - 1, kNow, kAgeLimit), expected)
        << name(cause);
  }
}

// People see floats: a number beyond them is infinite.
TEST(RefusedValue, OfANumberBeyondFloatsIsInfinite) {
  for (const double position : {1e300, -1e300, 0.5, kInfinity, -kInfinity}) {
    const JointSample sample{.position = position};
    const RefusedValue refused(Reject::kOutsideLimits, sample, kNow);
    EXPECT_EQ(refused.value[0], position > 1.0 ? kInfinity : position < -1.0 ? -kInfinity : 0.5);
  }
}

}  // namespace
}  // namespace clearance
