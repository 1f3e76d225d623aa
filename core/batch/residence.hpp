// The number of rounds for which a tracked pair keeps its features, which says whether a lane is
// worth it.
//
// A pair in a lane costs a third of a single query. A pair that has to leave its lane costs one and
// a half queries more. So a pair that changes its features in more than about a quarter of the
// rounds is better off outside.
#pragma once

#include <algorithm>
#include <cstdint>

namespace clearance {

class Residence {
 public:
  // If vector code could not decide features, they are tried there again after this many rounds.
  static constexpr std::uint16_t kRetry = 64;
  // For features that vector code does not judge: nearly unlimited.
  static constexpr std::uint16_t kNotAtAll = 0xffff;

  // After the query of round `now`, a counter that wraps around. `changed`: it ended at other
  // features.
  void add(std::uint32_t now, bool changed) noexcept {
    const auto stay =
        static_cast<std::int32_t>(std::min<std::uint32_t>(now - since_, kLongest)) * kFraction;
    const std::int32_t mean = mean_ + (stay - mean_) / kMemory;
    mean_ = static_cast<std::uint16_t>(changed ? mean : mean_);
    since_ = changed ? now : since_;
    wait_ = changed ? (mean < kTooShort ? kSettlingRounds : std::uint16_t{0}) : wait_;
  }
  // After add(): may it enter a lane? One that changed too often has to keep its features for a
  // while.
  [[nodiscard]] bool settled(std::uint32_t now) const noexcept { return now - since_ >= wait_; }
  // The pair waits for this many rounds, unless it comes to other features.
  void wait(std::uint16_t rounds) noexcept { wait_ = rounds; }

 private:
  // Rounds at the same features: the mean of the last sixteen times or so, none counted as more
  // than kLongest, in 64ths. Below three and a half a pair changes too often for a lane; after
  // twelve rounds at the same features it has settled.
  static constexpr std::int32_t kFraction = 64, kMemory = 16, kLongest = 31;
  static constexpr std::int32_t kTooShort = 7 * kFraction / 2;
  static constexpr std::uint16_t kSettlingRounds = 12;

  std::uint32_t since_ = 0;
  std::uint16_t mean_ = kLongest * kFraction;
  std::uint16_t wait_ = 0;
};

}  // namespace clearance
