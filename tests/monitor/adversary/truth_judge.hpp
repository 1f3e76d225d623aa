// Compares reports with the true motion: bounds of pairs, the minimum, zones, and what separation
// says. It knows the faults only to allow the time and the error that no program can notice.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/interface/question.hpp"
#include "monitor/interface/report.hpp"
#include "tests/monitor/adversary/detection.hpp"
#include "tests/monitor/adversary/lies.hpp"
#include "tests/monitor/adversary/true_motion.hpp"

namespace clearance::test::lies {

// The kinds of false statements of a report.
enum class Claim : std::uint8_t {
  kLower,       // a pair's lower bound is above the truth
  kUpper,       // its upper bound is below the truth
  kSwept,       // its bound since the last tick is above the truth at some instant
  kMinimum,     // the certified minimum, or the bound of all pairs
  kZone,        // a zone is not active
  kSeparation,  // the clearance of a separation
  kSpeed,       // a speed that is said to be measured
  kAnswer,      // the lower bound of a question's answer, or its 'free'
  kCommand,     // a command is not in force in time
  kPartner,     // a partner that goes on from the saved state tells other bits
  kCount
};
inline constexpr auto kClaims = static_cast<std::size_t>(Claim::kCount);
[[nodiscard]] const char* name(Claim claim);

struct Verdict {
  struct False {
    std::uint64_t times = 0;
    double worst = 0.0;  // m, or m/s of kSpeed: beyond what is admissible
    std::string first;   // tick, pair, bounds, truth
  };
  std::array<False, kClaims> claims;
  // The share of ticks in which pairs are certified, from the time when they have to be known
  // again: of all pairs, and of the worst one.
  double certified = 1.0, least_certified = 1.0;
  std::string least_pair;
  // The longest time from the last fault's end until a pair is certified for kSettled, ns.
  std::int64_t recovered = 0;
  std::int64_t recovers = 0;                        // the longest that it may be
  std::uint64_t asked = 0, answered = 0, free = 0;  // questions
  std::string refusal;                              // of the last one that has no answer
  Detected detected;                                // a single fault

  [[nodiscard]] bool is_true() const;
  [[nodiscard]] std::string text() const;
};

class TruthJudge {
 public:
  static constexpr std::int64_t kSettled = 100 * kMs;
  // The time from the start after which a cell without faults has heard everything.
  static constexpr std::int64_t kStarts = kSecond / 2;

  // All must outlive this.
  TruthJudge(const Scene& scene, const TrueMotion& truth, const std::vector<Fault>& faults);

  // The reports that follow are of this scene, which must outlive this.
  void change(const Scene& scene);
  // Something of this body is changed in truth, by a command that is not in force yet; kBodies: no
  // such command.
  void await_command(std::size_t body, std::int64_t since);
  // The reports of two partners differ.
  void note_partner(std::uint64_t cycle) {
    note_false(Claim::kPartner, 1.0, "cycle " + std::to_string(cycle));
  }
  // `t` is the time of the tick, ns since the start.
  void judge(const Report& report, std::int64_t t);
  // Judges the answer about the true motion of both robots, which begins at the last tick. If there
  // is a refusal, there is no answer.
  void judge(const Answer& answer, const std::optional<std::string>& refusal,
             const std::vector<double>& times);
  [[nodiscard]] Verdict verdict() const;

 private:
  // The errors of a body that the judge allows in this tick.
  struct Allowed {
    bool is_excused = false;
    double error = 0.0;  // m
    bool is_speed_excused = false;
  };
  using Centres = TrueMotion::Centres;

  void find_allowed(std::int64_t t);
  [[nodiscard]] double allowed(std::uint32_t pair, std::int64_t age_a, std::int64_t age_b) const;
  [[nodiscard]] bool is_excused(std::uint32_t pair) const;
  [[nodiscard]] long double distance(std::uint32_t pair, const Centres& centres) const;
  // The least distance since the last tick, or now, if the pair does not go on from there.
  [[nodiscard]] long double least_since(std::uint32_t pair) const;
  [[nodiscard]] std::int64_t age_of_frame(const PairReport& pair) const;
  void judge_pair(const PairReport& pair);
  void judge_minimum(const Report& report);
  void judge_zone(const Report& report, std::size_t zone);
  void judge_separation(const PairSeparation& pair);
  void note_false(Claim claim, double by, const std::string& what);

  [[nodiscard]] bool moves_with(std::size_t body, Channel robot) const;
  [[nodiscard]] double enter_below(const Zone& zone, std::uint32_t pair) const;
  void note_known(const PairReport& pair);

  const Scene* scene_ = nullptr;
  const TrueMotion& truth_;
  const std::vector<Fault>& faults_;
  std::vector<std::size_t> body_;  // by object
  std::int64_t tick_ = kMs;        // since the last tick
  std::int64_t t_ = 0, ended_ = 0, available_from_ = kStarts;
  std::size_t awaited_body_ = kBodies;  // await_command()
  // The bodies in this tick, in the middle of the time since the last one, and in the last one.
  std::array<Centres, 3> centres_{};
  std::array<Allowed, kBodies> allowed_{};
  // By pair: it was known in the last tick; and no frame has come since, which replaces what was
  // known. Only then does a swept bound begin at the last tick (monitor/schedule/SWEPT.md).
  std::vector<std::uint8_t> was_known_, goes_on_;
  std::vector<std::int64_t> frame_age_;  // by pair, ns; 0: of no sensor
  // By pair: what is allowed at its ages, m, in this tick; and in the last one, if that is more.
  std::vector<double> used_, used_since_;
  std::vector<std::uint64_t> certified_, judged_;  // ticks by pair
  // By pair: it is certified since then; kSettledOnce: it has been so for kSettled.
  static constexpr std::int64_t kSettledOnce = -1;
  std::vector<std::int64_t> known_since_;
  Verdict verdict_;
};

}  // namespace clearance::test::lies
