// An operator jogs the arm of config/cells/pick.yaml. Each jog is asked about before it is made: it
// is made at full speed, slowed down, or refused. The loop is closed over DDS.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "monitor/client/questions.hpp"

namespace clearance::jog {

inline constexpr std::string_view kClient = "example arm";
// m: a jog that may come nearer than `kNear` is refused, and one that may come nearer than `kSlow`
// is slowed down.
inline constexpr double kNear = 0.005, kSlow = 0.02;

enum class Decision { kMade, kSlowed, kRefused };

struct Jog {
  std::string name;
  Decision decision = Decision::kRefused;
  std::string reason;     // the pair, its distance and the instant; empty: made at full speed
  double lower_m = 0.0;   // the answer's bound of the least distance
  double asked_ms = 0.0;  // from the question to its answer
};

struct RunResult {
  bool heard = false;  // the daemon always answered
  int made = 0, slowed = 0, refused = 0;
  double least_lower_m = 1e9;  // of the lower bounds of all pairs, in certified reports
};

// Runs the jogs of the operator once. Calls `show` for each. `go_on` is called before each joint
// state; the run ends when it returns false.
[[nodiscard]] RunResult run(client::Connection& connection, double speed,
                            const std::function<void(const Jog&)>& show,
                            const std::function<bool()>& go_on);

}  // namespace clearance::jog
