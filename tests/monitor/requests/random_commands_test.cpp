// Random commands to a loop that runs, while its bodies move. After each, the monitor is compared
// with one that is built anew from the text.
//
// Oracles: the ordinary reader; a monitor that was never changed; closed-form distances; models of
// left-out poses and of the ends of contacts.
//
// The long campaign: CLEARANCE_COMMANDS=100000 daemon_tests --gtest_filter='RandomCommands.*'
// Another seed: CLEARANCE_COMMANDS_SEED=7
#include "tests/monitor/requests/random_commands.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace clearance::test {
namespace {

// The growth of the memory, bytes: a byte for each command of a long campaign is more.
constexpr std::size_t kMostGrowth = 32'000;

std::uint64_t number_of(const char* variable, std::uint64_t usual) {
  const char* const asked = std::getenv(variable);
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : usual;
}

// Bytes in use; 0 under sanitizers.
std::size_t memory_in_use() { return ::mallinfo2().uordblks; }

TEST_F(RandomCommands, LeaveTheMonitorThatTheTextWouldGive) {
  constexpr std::uint64_t kParts = 16;
  const std::uint64_t steps = number_of("CLEARANCE_COMMANDS", 320);
  const std::uint64_t seed = number_of("CLEARANCE_COMMANDS_SEED", 1);
  start(seed);
  std::vector<std::size_t> memory;  // with the first cell again, after each part
  for (std::uint64_t i = 0; i < steps && !HasFailure(); ++i) {
    step(drawn());
    if (HasFailure() || (i + 1) % (steps / kParts) != 0) continue;
    step({ReplaceCell{kRandomCommandsCell}});
    EXPECT_EQ(commander_->cell().yaml, kRandomCommandsCell);
    memory.push_back(memory_in_use());
  }
  if (HasFailure()) {
    FAIL() << "seed " << seed << ", command " << count_ << ":\n"
           << text_of(list_) << "The cell before it:\n"
           << text_before_ << "The cell now:\n"
           << commander_->cell().yaml << refusals();
  }
  const auto least = [&](std::size_t from, std::size_t to) {
    return *std::min_element(memory.begin() + static_cast<std::ptrdiff_t>(from),
                             memory.begin() + static_cast<std::ptrdiff_t>(to));
  };
  const std::size_t first = least(kParts / 4, kParts / 2), last = least(kParts / 2, kParts);
  EXPECT_LE(last, first + kMostGrowth);
  EXPECT_GT(results_[0], steps / 10);
  EXPECT_GT(figures_.known, figures_.pairs / 2);
  EXPECT_GT(figures_.zones_decided, figures_.zones_open);
  std::cout << figures() << "memory " << first << " and " << last << " bytes\n";
}

}  // namespace
}  // namespace clearance::test
