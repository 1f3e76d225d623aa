// A run of the cell of inputs that lie: bytes go through the intake into the tick loop, at 1 kHz of
// simulated time and without DDS. Every report is judged by the true motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/monitor/adversary/lying_senders.hpp"
#include "tests/monitor/adversary/truth_judge.hpp"

namespace clearance::test::lies {

struct LyingRun {
  Sending sending;
  std::int64_t length = 6 * kSecond;
  bool joints_went_far = false;
};

[[nodiscard]] Verdict judged(const Cell& cell, const LyingRun& run);

// The verdict for a person: the seed, the faults, what was false, and which single faults suffice
// to make it false. Repeats the run with every single fault.
[[nodiscard]] std::string explained(const Cell& cell, const LyingRun& run, const Verdict& verdict);

}  // namespace clearance::test::lies
