// A question about a motion that a client asks a running daemon, and the answer that it gets.
//
// Questions arrive over DDS (idl/questions.idl). idl/QUESTIONS.md explains them to clients, and
// monitor/interface/question.hpp has the question itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

struct MotionQuestion {
  std::string client = {};
  std::uint64_t request = 0;         // from 1; counts up
  std::uint64_t scene_revision = 0;  // of the scene that the client knows; 0: not checked
  // `held` and `poses` are what the client states instead of what the daemon knows. `work_limit` 0:
  // that of the daemon.
  Question question = {};
};

// The values are on the wire: new ones are added at the end. Up to kBusy they are those of
// CommandStatus. Any value but the first says nothing of the motion.
enum class QuestionStatus : std::uint8_t {
  kDone = 0,           // answered
  kMalformed = 1,      // a field of the message has no valid value
  kNotNamed = 2,       // the daemon answers no questions of this client
  kTwoWriters = 3,     // several programs send under the name of this client
  kOutOfOrder = 4,     // a later request came first, and the answer to this one is not known
  kOtherContent = 5,   // a request with this number and another content came first
  kOtherRevision = 6,  // another scene than the client knows is in force
  kBusy = 7,           // too many questions wait; this one may be sent again
  kRefused = 8,        // the question does not fit the scene: `reason` says why
  kNoInput = 9,        // a position or pose is unknown, late, contradicted or changing
  kEnding = 10,        // the daemon ends
  kFailed = 11,        // the system refused something
};
inline constexpr std::size_t kQuestionStatuses = 12;

// A MarginAnswer with names.
struct MarginResult {
  double margin = 0.0;  // m
  Verdict verdict = Verdict::kUndecided;
  double above_until = 0.0;  // s
  double below_at = std::numeric_limits<double>::quiet_NaN();
  std::string first = {}, second = {};
  std::string a = {}, b = {};  // of the MarginBetween that it is of; empty: of all pairs
};

// A ProfilePoint with names.
struct ProfilePart {
  double from = 0.0, to = 0.0;      // s
  double lower = 0.0, upper = 0.0;  // m
  std::string first = {}, second = {};
};

// A TimeScaling with names.
struct TimeLimit {
  bool is_limited = false;
  double factor = 0.0, factor_above = 0.0;
  double time = 0.0;  // s
  std::string first = {}, second = {}, zone = {};
};

// An Answer with names. Unless it is done(), the bounds say that nothing is known.
struct QuestionResult {
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

  std::string client = {};
  std::uint64_t request = 0;
  QuestionStatus status = QuestionStatus::kDone;
  std::string path = {};                  // of a refusal: the offending field; empty: the question
  std::string reason = {};                // of a refusal: a sentence
  std::uint64_t scene_revision = 0;       // of the scene of the answer
  std::uint64_t cycle = 0;                // joints and objects are where this tick had them
  std::int64_t now_ns = 0;                // the time of that tick
  std::vector<std::string> without = {};  // sensors that the question leaves out; a daemon: none
  double lower = -kInfinite, upper = kInfinite;  // m
  double time = kNotKnown;                       // s
  std::string first = {}, second = {};
  Vec3 point_on_first = Vec3::Constant(kNotKnown), point_on_second = Vec3::Constant(kNotKnown);
  std::vector<MarginResult> margins = {};
  std::vector<ProfilePart> profile = {};
  std::optional<TimeLimit> time_limit = {};  // if it was asked for
  bool within_work_limit = true;
  std::uint64_t queries = 0;
  // The largest difference of a joint's first waypoint from its present position, rad or m.
  double start_deviation = kInfinite;
  std::string start_joint = {};

  [[nodiscard]] bool done() const noexcept { return status == QuestionStatus::kDone; }
  // True if the whole motion certainly keeps this margin, which the question had, m: of all pairs,
  // or of those that its MarginBetween names by `a` and `b`.
  [[nodiscard]] bool is_free(double margin, std::string_view a = {},
                             std::string_view b = {}) const noexcept {
    for (const MarginResult& each : margins) {
      if (each.margin == margin && each.a == a && each.b == b)
        return done() && each.verdict == Verdict::kFree;
    }
    return false;
  }
};

// Returns the name of a status for people and logs: "no-input".
[[nodiscard]] constexpr std::string_view name_of(QuestionStatus status) noexcept {
  constexpr std::string_view kNames[kQuestionStatuses] = {
      "answered",       "malformed", "not-named", "two-writers", "out-of-order", "other-content",
      "other-revision", "busy",      "refused",   "no-input",    "ending",       "failed"};
  const auto value = static_cast<std::size_t>(status);
  return value < kQuestionStatuses ? kNames[value] : "unknown";
}

}  // namespace clearance
