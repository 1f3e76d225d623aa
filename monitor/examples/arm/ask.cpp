#include "monitor/examples/arm/ask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "monitor/examples/arm/motion.hpp"

namespace clearance::jog {
namespace {

using pick::HandPoint;

constexpr std::int64_t kEndNs = 5'000'000'000;  // without a report
constexpr int kRows = 9;                        // waypoints of a jog
constexpr double kSeconds = 0.6, kSlower = 3.0;
constexpr double kRest = 0.01;                                  // s
constexpr double kBin = 50.0 * 3.14159265358979323846 / 180.0;  // azimuth of a bin, rad

const std::vector<std::string> kJointNames{"joint1", "joint2", "joint3", "joint4",
                                           "joint5", "joint6", "joint7", "finger"};

// A key that the operator holds for a moment: the hand moves by so much.
struct Key {
  const char* name;
  double azimuth = 0.0, height = 0.0;  // rad, m
};
// The hand goes towards the wall, is refused, goes up, and passes above it.
constexpr Key kKeys[] = {{"right", 0.25}, {"right", 0.25},      {"right", 0.25},    {"right", 0.25},
                         {"up", 0, 0.12}, {"right", 0.25},      {"right", 0.25},    {"right", 0.25},
                         {"right", 0.25}, {"down", 0.0, -0.12}, {"down", 0.0, -0.3}};

HandPoint moved(HandPoint point, const Key& key, double share) {
  point.azimuth += share * key.azimuth;
  point.height += share * key.height;
  return point;
}

// The jog as a motion: linear between waypoints, as the arm then moves.
JointTrajectory motion_of(const HandPoint& from, const Key& key, double seconds) {
  JointTrajectory motion{.joints = kJointNames, .times = {}, .positions = {}, .velocities = {}};
  for (int row = 0; row < kRows; ++row) {
    const double share = static_cast<double>(row) / (kRows - 1);
    motion.times.push_back(share * seconds);
    const pick::Positions positions = pick::positions_at(moved(from, key, share));
    motion.positions.insert(motion.positions.end(), positions.begin(), positions.end());
  }
  return motion;
}

class Arm {
 public:
  Arm(client::Connection& connection, RunResult& result, const std::function<bool()>& go_on)
      : joints_(connection, kClient, kJointNames),
        reports_(connection, {.old_after = std::chrono::milliseconds(500), .depth = 8}),
        questions_(connection, kClient),
        result_(result),
        go_on_(go_on) {}

  // Each returns false when the run has to end. Waits until the daemon knows where the arm is.
  bool begin(const HandPoint& at) {
    const pick::Positions positions = pick::positions_at(at);
    do {
      if (!send({positions.begin(), positions.end()})) return false;
    } while (!questions_.is_heard() || reports_->unknown > 0);
    return true;
  }

  bool follow(const JointTrajectory& motion) {
    const std::int64_t began_ns = client::now_ns();
    for (double time_s = 0.0; time_s < motion.times.back();) {
      time_s =
          std::min(1e-9 * static_cast<double>(client::now_ns() - began_ns), motion.times.back());
      if (!send(positions_at(motion, time_s))) return false;
    }
    return true;
  }

  // Asks while the arm rests where it is. Its joint states go on, or they would be late. The motion
  // ends at rest: its last waypoint is stated again, later.
  std::optional<QuestionResult> ask(const JointTrajectory& motion) {
    Question question;
    question.motion = motion;
    question.motion.times.push_back(motion.times.back() + kRest);
    const std::vector<double> goal = positions_at(motion, motion.times.back());
    question.motion.positions.insert(question.motion.positions.end(), goal.begin(), goal.end());
    question.margins = {kNear, kSlow};
    question.stoppable = true;
    const std::vector<double> here = positions_at(motion, 0.0);
    const std::uint64_t request = questions_.post(question);
    const std::int64_t began_ns = client::now_ns();
    while (client::now_ns() - began_ns < kEndNs) {
      if (auto answer = questions_.result(request, std::chrono::milliseconds(1))) return answer;
      if (!send(here)) break;
    }
    return std::nullopt;
  }

 private:
  static std::vector<double> positions_at(const JointTrajectory& motion, double time) {
    const auto later = std::ranges::upper_bound(motion.times, time);
    const auto last = static_cast<std::ptrdiff_t>(motion.times.size()) - 1;
    const std::ptrdiff_t row = std::clamp<std::ptrdiff_t>(later - motion.times.begin(), 1, last);
    const double share =
        (time - motion.times[row - 1]) / (motion.times[row] - motion.times[row - 1]);
    std::vector<double> positions;
    for (std::ptrdiff_t i = 0; i < pick::kJoints; ++i) {
      const double before = motion.positions[(row - 1) * pick::kJoints + i];
      positions.push_back(before + share * (motion.positions[row * pick::kJoints + i] - before));
    }
    return positions;
  }

  // Sends joint states until a report has used them.
  bool send(const std::vector<double>& positions) {
    const std::int64_t began_ns = client::now_ns();
    while (go_on_() && client::now_ns() - began_ns < kEndNs) {
      const std::int64_t stamp_ns = client::now_ns();
      joints_.write(positions, {}, stamp_ns);
      while (reports_.next(std::chrono::milliseconds(20))) {
        // A late pair is bounded by where the arm may have gone since it was heard.
        if (reports_->minimum_certified)
          result_.least_lower_m = std::min(result_.least_lower_m, reports_->lower_all);
        if (reports_->now_ns >= stamp_ns) return true;
      }
    }
    return false;
  }

  client::JointWriter joints_;
  client::Reports reports_;
  client::Questions questions_;
  RunResult& result_;
  const std::function<bool()>& go_on_;
};

std::string reason_of(const QuestionResult& answer, double margin) {
  if (!answer.done()) return answer.reason;
  for (const MarginResult& each : answer.margins) {
    if (each.margin != margin) continue;
    return fmt::format("{} - {} below {} m from {:.2f} s on", each.first, each.second, margin,
                       each.above_until);
  }
  return "";
}

}  // namespace

RunResult run(client::Connection& connection, double speed,
              const std::function<void(const Jog&)>& show, const std::function<bool()>& go_on) {
  RunResult result;
  Arm arm(connection, result, go_on);
  HandPoint at{-kBin, 0.6, 0.42, 0.03};
  if (!arm.begin(at)) return result;
  for (const Key& key : kKeys) {
    const JointTrajectory motion = motion_of(at, key, kSeconds / speed);
    const std::int64_t began_ns = client::now_ns();
    const auto answer = arm.ask(motion);
    if (!answer) return result;
    Jog jog{.name = key.name, .reason = {}, .lower_m = answer->lower};
    jog.asked_ms = 1e-6 * static_cast<double>(client::now_ns() - began_ns);
    if (!answer->is_free(kNear)) {
      jog.reason = reason_of(*answer, kNear);
      ++result.refused;
    } else if (!answer->is_free(kSlow)) {
      jog.decision = Decision::kSlowed;
      jog.reason = reason_of(*answer, kSlow);
      ++result.slowed;
    } else {
      jog.decision = Decision::kMade;
      ++result.made;
    }
    show(jog);
    if (jog.decision == Decision::kRefused) continue;
    const double slower = jog.decision == Decision::kSlowed ? kSlower : 1.0;
    if (!arm.follow(motion_of(at, key, slower * kSeconds / speed))) return result;
    at = moved(at, key, 1.0);
  }
  result.heard = true;
  return result;
}

}  // namespace clearance::jog
